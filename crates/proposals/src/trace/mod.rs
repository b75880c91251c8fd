//! Where the numbers of a lesson come from: `labspec trace`.
//!
//! | stage | module |
//! |---|---|
//! | the numbers that a reader sees | `verify::stated` |
//! | what the lesson claims already | `verify::claimed`, `verify::answered` |
//! | runs that the text names: settings of controls, presses, timesteps | `trials` |
//! | the same with what the lab's setup changed of the model put back | `restored` |
//! | what could be measured in each: readouts, traces, contacts, constants of the model | `candidates` |
//! | formulas that stand before the number itself | `formula` |
//! | which of all that is simplest, and whether chance explains it | `rank` |
//! | what an author takes over | `propose` |
//!
//! A number is traced when a simple measure of a run that the text speaks of has the digits that are printed, and when so few
//! things were tried before it that chance does not explain it.

mod candidates;
mod formula;
mod lab;
mod lesson;
mod propose;
mod rank;
mod restored;
mod trials;
mod units;
mod words;

pub(crate) use candidates::Candidate;
pub(crate) use lab::TracedLab;
pub use lesson::{Traced, Traces, trace};
pub use propose::{ProposedVerify, blocks, laid_out};
pub use rank::{Hit, Origin};
pub(crate) use trials::{Trial, trials};
pub(crate) use units::si;
pub(crate) use words::split_words;
