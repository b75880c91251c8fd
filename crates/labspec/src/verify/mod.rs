//! Verification of the claims of a lesson: runs, measures over them, and verdicts.
//!
//! | stage | module |
//! |---|---|
//! | labs of the runs, unchanged or with modified parameters | `run_cache` |
//! | runs and measures, bound to their labs | `bound` |
//! | one run with its measures | `runner`, `measure`, `reads` |
//! | values found by a search | `search` |
//! | numbers that conditions read | `outcome`, at the positions of `layout` |
//! | the names that an editor offers in such an expression | `claim_names` |
//! | an expression over measures, compiled once | `claim` |
//! | its value, and the evidence for it | `found` |
//! | whether a claim could have a different outcome | `evidence` |
//! | runs that are the same simulation | `same_simulation`, `identical_runs` |
//! | whether a condition holds, and by which margin | `condition` |
//! | the answer of a question | `answer` |
//! | numbers in the texts of options | `option_numbers`, `stated_numbers` |
//! | numbers and words in the text | `says`, `quote` |
//! | columns of tables | `column` |
//! | dimensions of the numbers | `units` |
//! | closed forms | `exact` |
//! | the same claims with numbers of MuJoCo | `judge` |
//! | curves of the labs in the runs, for a report | `curves` |

mod aggregate;
mod answer;
mod anything;
mod bound;
mod bound_run;
mod bracket;
mod check_verify;
mod claim;
mod claim_names;
mod column;
mod compiled_claim;
mod condition;
mod condition_units;
mod curve_trail;
mod curves;
mod direction;
mod draws;
mod event_at_start;
mod evidence;
mod exact;
pub(crate) mod float_bits;
mod format;
mod found;
mod given;
mod grounded;
mod identical_runs;
mod imagined;
mod interpolated;
pub mod judge;
mod judgement;
mod late_time;
mod layout;
mod list_measure;
mod loose_tolerance;
mod measure;
mod measure_units;
mod measures_another;
mod mixed_claims;
mod named_run;
mod nested_final;
mod no_value;
mod numeric_answer;
mod numerics;
mod one_sample;
mod one_sided;
mod option_numbers;
mod options;
mod outcome;
mod outcome_names;
mod outcomes;
mod over;
mod quote;
mod quote_checker;
mod ratio_of_change;
mod ratio_order;
mod reads;
mod run_cache;
mod run_result;
mod runner;
mod same_simulation;
mod sample;
mod says;
mod search;
mod slider_effect;
mod stated_numbers;
mod survival;
mod units;
mod unstopped;
mod value_kind;
mod value_of;
mod verdict;

pub use bound::BoundVerify;
pub use check_verify::check_verify;
pub(crate) use check_verify::{check_nominal, lint_verify};
pub use claim_names::ClaimNames;
pub use curves::Curves;
pub use exact::ClosedForm;
pub use format::significant;
pub use judgement::{Judgement, Measured, RunReport, not_executable};
pub use numerics::HALVED;
pub use numerics::PERTURBED_BACK;
pub use numerics::PERTURBED_START;
pub use options::UNDECIDED;
pub use outcomes::measure_only_run;
pub use quote::{
    Counted, NumberForm, OtherValue, OutputBlock, OutputMatch, QuoteOutcome, QuoteState, Quoted,
    RenderedText, Stated, Style, Unread, answered, claimed, counted, folded, numbers_in_outputs, plain,
    quoted, stated,
};
pub(crate) use quote::{asked_unit, differ_in_scale};
pub use quote_checker::Quote;
pub use reads::labels;
pub use run_cache::{BoundLab, RunCache};
pub use verdict::{Answer, Verdict, Weight};
