//! The complete check of a lesson: structure, names, runs of every lab, verdicts of every question.

mod allowed;
pub(crate) mod assignments;
pub(crate) mod choices;
mod claim_id;
mod claims;
mod consequences;
mod curves;
mod entries;
mod expect;
mod joined;
mod judge;
pub(crate) mod lab_runs;
pub(crate) mod observations;
mod partners;
mod prepared_lab;
mod printed_numbers;
#[cfg(test)]
mod program_lints_tests;
pub(crate) mod programs;
mod reproduce;
mod resolved_labs;
pub(crate) mod setconst;
mod snapshot;
mod stored;
mod units;

pub use allowed::SuppressedFinding;
pub use claim_id::is_about;
pub use claims::Claim;
pub use curves::{VerifyCurves, curves};
pub(crate) use entries::is_unfinished;
pub use entries::{ledger, measure_lines, option_lines};
pub use judge::{CrossCheck, ReferenceRecording, Request, cross_check, file_name};
pub use lab_runs::Coverage;
pub use printed_numbers::{PrintedNumber, claim_printed_numbers};
pub use reproduce::{Basis, ClaimBasis, LabBasis, RunSettings, basis};
pub use snapshot::{Divergence, SnapshotResult, SnapshotUpdate, UpdatedLab, update_snapshot};
pub use units::labels as labels_of;

pub(crate) use prepared_lab::PreparedLab;

use crate::bind::Programs;
use crate::bind::scene::Models;
use crate::finding::{self, Finding, InFile, Severity};
use crate::listings::ListingResult;
use crate::rules;
use crate::source::{SourceMap, Text};
use crate::spec::{BreakExpectation, Lab, LabAddress, Lesson, ModelSource};
use labspec_core::Model;
use serde::{Deserialize, Serialize};
use std::sync::{Arc, LazyLock};

/// A lab that was run, for the report.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct RanLab {
    /// Its address in the lesson.
    pub address: LabAddress,
    /// Its title, possibly empty.
    pub title: String,
    /// Number of runs: as loaded, and with each control at its ends.
    pub runs: usize,
    /// `false` when it could not be run.
    pub ran: bool,
    /// The coverage of its runs; `None` when it could not be run.
    pub tried: Option<Coverage>,
    /// Number of errors in its code; texts with errors are not executed.
    pub mistakes: usize,
    /// Whether the lesson declares that it breaks.
    pub expect: BreakExpectation,
}

/// A lesson with all results of its check.
#[derive(Debug)]
pub struct Checked {
    /// The lesson.
    pub lesson: Lesson,
    /// All findings, in order.
    pub findings: Vec<Finding>,
    /// The labs.
    pub labs: Vec<RanLab>,
    /// The questions and the labs with claims.
    pub claims: Vec<Claim>,
    /// For each lab with a snapshot, whether it reproduces the stored values.
    pub snapshots: Vec<SnapshotResult>,
    /// The listings that were run, or should have been.
    pub listings: Vec<ListingResult>,
    /// The numbers of the text that the outputs of listings have.
    pub printed: Vec<PrintedNumber>,
    /// Findings that the author has suppressed with a reason.
    pub allowed: Vec<SuppressedFinding>,
    /// The level of the check.
    pub level: CheckLevel,
}

/// Which parts of a check are made besides structure, models and the names in every text.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CheckLevel {
    /// Test program behaviour that a page accepts silently.
    pub programs: bool,
    /// Run every lab.
    pub labs: bool,
    /// Verify every claim.
    pub claims: bool,
}

impl CheckLevel {
    /// Everything.
    pub const FULL: CheckLevel = CheckLevel { programs: true, labs: true, claims: true };
    /// The claims alone.
    pub const CLAIMS: CheckLevel = CheckLevel { labs: false, ..CheckLevel::FULL };
    /// Nothing is run: labs and claims are left out in the ledger.
    pub const STATIC: CheckLevel = CheckLevel { programs: false, labs: false, claims: false };
}

/// The results of a check besides the structure of the lesson, without file paths in the findings.
#[derive(Debug, Default, Serialize, Deserialize)]
pub struct LabOutcome {
    /// The findings.
    #[serde(with = "stored")]
    pub findings: Vec<Finding>,
    /// The labs that ran.
    pub labs: Vec<RanLab>,
    /// The claims with their results.
    pub claims: Vec<Claim>,
    pub(crate) snapshots: Vec<SnapshotResult>,
}

impl LabOutcome {
    /// Only these findings.
    pub fn from_findings(findings: Vec<Finding>) -> LabOutcome {
        LabOutcome { findings, ..LabOutcome::default() }
    }

    /// Only one finding.
    pub fn from_finding(finding: Finding) -> LabOutcome {
        LabOutcome { findings: vec![finding], ..LabOutcome::default() }
    }
}

/// Checks a lesson that has been read. Findings in model files are stored in `models`.
pub fn check_lesson(lesson: Lesson, models: &Models, level: CheckLevel) -> Checked {
    let found = run_checks(&lesson, models, level);
    join(lesson, found, level)
}

/// Binds, runs and verifies a lesson.
pub fn run_checks(lesson: &Lesson, models: &Models, level: CheckLevel) -> LabOutcome {
    let mut outcome = check_as_written(lesson, models, level);
    if level == CheckLevel::FULL {
        let check = |fixed: &Lesson| check_as_written(fixed, models, level);
        consequences::remove_consequences(lesson, models, &mut outcome, check);
    }
    outcome
}

/// Binds, runs and verifies a lesson, without comparing its findings with each other.
fn check_as_written(lesson: &Lesson, models: &Models, level: CheckLevel) -> LabOutcome {
    let mut findings = Vec::new();
    let labs = lesson.all_labs();
    let mut ready: Vec<PreparedLab<'_>> =
        labs.into_iter().filter_map(|lab| prepare(lab, models, level, &mut findings)).collect();
    if level.programs {
        ready.iter().for_each(|r| rules::param_unread::check_params(lesson, r, &mut findings));
        ready.iter().for_each(|r| rules::contact_time_late::check_contact_times(r, &mut findings));
    }
    let labs = if level.labs { lab_runs::run_labs(lesson, &ready, &mut findings) } else { Vec::new() };
    deduplicate(lesson, &mut findings);
    let snapshots = snapshot::check_snapshots(lesson, &ready, level, &mut findings);
    ready.extend(beside(lesson, models));
    let claims = if level.claims {
        let claims = claims::check_claims(lesson, &mut ready, models, &mut findings);
        // An editor checks one block at a time, so it does not know the claims of the other blocks.
        let verified = claims::verified_answers(&claims);
        rules::numbers_unclaimed::check_unclaimed_numbers(lesson, &verified, &mut findings);
        claims
    } else {
        claims::bind(lesson, &ready, models, &mut findings);
        Vec::new()
    };
    LabOutcome { findings, labs, claims, snapshots }
}

/// All labs that claims of a lesson refer to. Their errors are already reported.
fn of_claims<'l>(lesson: &'l Lesson, models: &Models) -> Vec<PreparedLab<'l>> {
    let labs = lesson.all_labs().into_iter();
    let prepared = labs.filter_map(|lab| prepare(lab, models, CheckLevel::STATIC, &mut Vec::new()));
    prepared.chain(beside(lesson, models)).collect()
}

/// The labs of claims that are not labs of the lesson: those of other lessons, and an empty one for formulas.
fn beside<'l>(lesson: &'l Lesson, models: &Models) -> impl Iterator<Item = PreparedLab<'l>> {
    let labs = lesson.others.iter().filter_map(|other| other.lab.as_ref().ok());
    let others = labs.filter_map(|lab| {
        // Its errors are reported in its own lesson.
        let (model, programs, mistakes) = bind(lab, models, &mut Vec::new())?;
        (mistakes == 0).then_some(PreparedLab { lab, model, programs, mistakes })
    });
    others.chain(if claims::have_formulas(lesson) { empty() } else { None })
}

/// An empty lab.
static EMPTY_LAB: LazyLock<Lab> =
    LazyLock::new(|| Lab::of_model(Text { value: String::new(), map: SourceMap::point(0) }));

fn empty() -> Option<PreparedLab<'static>> {
    let model = Arc::new(Model::from_xml("<mujoco/>").ok()?);
    let programs = Programs::compile(&EMPTY_LAB, &model, &mut Vec::new());
    Some(PreparedLab { lab: &EMPTY_LAB, model, programs, mistakes: 0 })
}

/// Removes `idle-control` findings of controls for which a finding states that a reset undoes their effect.
fn deduplicate(lesson: &Lesson, findings: &mut Vec<Finding>) {
    let tested_code = |code: &str, f: &Finding| f.code == code;
    let lost = |span: &std::ops::Range<usize>, findings: &[Finding]| {
        let inside = |f: &Finding| span.start <= f.span.start && f.span.end <= span.end;
        findings.iter().any(|f| tested_code(rules::LOST_AT_RESET.code, f) && inside(f))
    };
    let labs = lesson.all_labs();
    let controls = labs.iter().flat_map(|lab| &lab.controls).map(|c| c.span.clone());
    let spans: Vec<_> = controls.filter(|span| lost(span, findings)).collect();
    findings.retain(|f| {
        !tested_code(rules::IDLE_CONTROL.code, f) || !spans.iter().any(|span| span.contains(&f.span.start))
    });
}

/// The first finding with a severity that its rule does not declare.
fn undeclared_severity(findings: &[Finding]) -> Option<&Finding> {
    let is_declared = |f: &Finding| rules::find(f.code).is_none_or(|rule| rule.may_be(f.severity));
    findings.iter().find(|f| !is_declared(f))
}

/// Joins a lesson with the results of its check.
pub fn join(lesson: Lesson, found: LabOutcome, level: CheckLevel) -> Checked {
    let LabOutcome { mut findings, labs, claims, snapshots } = found;
    let mut all = lesson.findings.clone();
    // An editor checks one block at a time: here, all uses of a name are known.
    joined::join_uses(&lesson, &mut findings);
    joined::join_repeated(&lesson, &mut findings);
    crate::lint::withhold_fixes(&lesson, &mut findings);
    all.extend(findings);
    rules::not_run_in_full::explain(&lesson, &labs, &mut all);
    let mut allowed = allowed::suppress_allowed(&lesson, &mut all, level);
    let mut all: Vec<Finding> = all.into_iter().map(|f| f.at(&lesson.file)).collect();
    for suppressed in &mut allowed {
        suppressed.finding = suppressed.finding.clone().at(&lesson.file);
    }
    finding::sort(&mut all);
    debug_assert_eq!(undeclared_severity(&all), None, "a severity that the rule does not declare");
    Checked {
        lesson,
        findings: all,
        labs,
        claims,
        snapshots,
        listings: Vec::new(),
        printed: Vec::new(),
        allowed,
        level,
    }
}

/// Loads the model of a lab, binds its programs, and checks their behaviour according to `level`.
fn prepare<'l>(
    lab: &'l Lab,
    models: &Models,
    level: CheckLevel,
    findings: &mut Vec<Finding>,
) -> Option<PreparedLab<'l>> {
    let (model, programs, mistakes) = bind(lab, models, findings)?;
    if level.programs {
        setconst::check_setconst(lab, &model, &programs, findings);
        let lost = findings.len();
        rules::lost_at_reset::check_resets(lab, &model, &programs, findings);
        // What a control sets and a reset discards is reported once.
        if mistakes == 0 && findings.len() == lost {
            rules::start_not_reset::check_start(lab, &model, &programs, findings);
        }
        units::check_units(lab, &model, &programs, findings);
        rules::label_names_another::check_names(lab, &model, &programs, findings);
        rules::label_axis::check_axes(lab, &model, &programs, findings);
        rules::label_energy::check_energies(lab, &programs, findings);
        rules::force_accumulates::check_controller(lab, &model, findings);
        rules::force_stays::check_buttons(lab, &programs, findings);
        rules::kept_over_reset::check_variables(lab, &programs, findings);
        rules::same_target::check_targets(lab, &model, &programs, findings);
        rules::world_element::check_elements(&model, &programs, findings);
        rules::local_position::check_displays(&model, &programs, findings);
        rules::degrees_without_unit::check_controls(lab, &model, findings);
    }
    Some(PreparedLab { lab, model, programs, mistakes })
}

/// Loads the model of a lab and binds its programs. Returns the number of errors in its code.
pub fn bind(
    lab: &Lab,
    models: &Models,
    findings: &mut Vec<Finding>,
) -> Option<(Arc<Model>, Programs, usize)> {
    let Some(model) = models.model_of_lab(lab, findings) else {
        // With a list of the model folder, a missing model is reported by the structure checks, which know the list.
        if let (Some(ModelSource::Model(name)), None) = (lab.scene(), models.folder().names()) {
            // What is not the name of a model is in no folder.
            if rules::model_name::check_model_name(name, models.folder()).is_none() {
                findings.extend(rules::no_model_folder::check_folder(name, models.folder()));
                findings.extend(rules::unknown_model::check_unlisted(name, models.folder()));
            }
        }
        return None;
    };
    rules::check_model(lab, &model, findings);
    let before = findings.len();
    let programs = Programs::compile_and_lint(lab, &model, models.functions(), findings);
    rules::integrator_control::check_controls(lab, &programs, findings);
    let mistakes = findings.iter().skip(before).filter(|f| f.severity == Severity::Error).count();
    Some((model, programs, mistakes))
}
