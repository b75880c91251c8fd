//! Tests of several crates together.

#![allow(clippy::too_many_lines, reason = "a test is a table of cases or one sequence of steps")]

mod allocation;
mod answer_forms;
mod answers;
mod authors;
mod authors_proposals;
mod breaking;
mod budget;
mod clauses;
mod cli;
mod cli_run;
mod conformance;
mod constrained;
mod course;
mod courses;
mod dimensions;
mod docs_site;
mod eight;
mod evidence;
mod examples;
mod false_claims;
mod file_lengths;
mod files;
mod files_of_others;
mod fixes;
mod format;
mod forms;
mod fresh;
mod fuzz;
mod grids;
mod helps;
mod html;
mod init;
mod integrators;
mod javascript;
mod judge;
mod labs;
mod ledger;
mod lessons;
mod levels;
mod links;
mod listing_environments;
mod listing_lessons;
mod listing_numbers;
mod listings;
mod lists;
mod loads;
#[cfg(feature = "lsp")]
mod lsp;
#[cfg(feature = "lsp")]
mod lsp_documents;
#[cfg(feature = "lsp")]
mod lsp_editor;
#[cfg(feature = "lsp")]
mod lsp_features;
#[cfg(feature = "lsp")]
mod lsp_findings;
#[cfg(feature = "lsp")]
mod lsp_requests;
mod mistakes;
mod mutants;
mod needs;
mod no_run;
mod numbers;
mod parity;
mod partners;
mod plan;
mod plan_stages;
mod planned;
mod playback;
mod player;
mod population;
mod precision;
mod precision_truth;
mod preview;
mod program;
mod quote_forms;
mod readme;
mod recorded;
mod recorded_forward;
mod refresh;
mod reports;
mod reproduction;
mod rules;
mod scaffold;
mod scenery;
mod scenes;
mod schema;
mod settings;
mod site;
mod sleep;
mod snapshots_of_labs;
mod sources;
mod stability;
mod standing;
mod steady;
mod stop_time;
mod structure;
mod students;
mod support;
mod terminal;
mod touching;
#[cfg(unix)]
mod trace;
mod tree_algorithms;
mod trust;
mod tutorial;
mod twenty;
mod under_hands;
mod verify;
mod verify_quotes;
mod verify_runs;
mod without_value;
mod zoo;
mod zz;
