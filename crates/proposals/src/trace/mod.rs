//! The origins of the numbers of a lesson: `labspec trace`.
//!
//! | stage | module |
//! |---|---|
//! | the numbers that a reader sees | `verify::stated` |
//! | the existing claims of the lesson | `verify::claimed`, `verify::answered` |
//! | runs that the text names: settings of controls, presses, timesteps | `trials` |
//! | the same runs without the changes that the lab's setup makes to the model | `restored` |
//! | possible measures of each run: readouts, traces, contacts, constants of the model | `candidates` |
//! | formulas before the number itself | `formula` |
//! | the simplest of these, and whether chance explains it | `rank` |
//! | columns of tables whose rows have values of a control | `tables` |
//! | the proposal for the author | `propose` |
//!
//! A number is traced if a simple measure of a run that the text names has the printed digits, and if so few candidates are
//! simpler that chance does not explain the match.

mod candidates;
mod formula;
mod lab;
mod lesson;
mod names;
mod neighbours;
mod origin;
mod propose;
mod rank;
mod restored;
mod tables;
mod trials;
mod units;
mod words;

pub(crate) use candidates::Candidate;
pub(crate) use lab::TracedLab;
pub use lesson::{Traced, Traces, trace};
pub(crate) use names::named_value;
pub use origin::{MeasureMatch, Origin};
pub use propose::{ProposedVerify, blocks, comments_of, format_verify};
pub(crate) use rank::factor;
pub(crate) use trials::{TraceRun, trials};
pub(crate) use units::si;
pub(crate) use words::split_words;
