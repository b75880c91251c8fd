//! The plan of a lab as a report: what runs in a step and what is left out, each with its reason, what it costs, and what more
//! it would cost.

mod measure;
mod parts;
mod plan;
mod reader;
mod start;

pub use measure::{Cost, REPEATS, Step};
pub use parts::{Code, Pairs, Seen, Sensor, Way};
pub use plan::{Options, Report, Row, name, plan};
pub use reader::Reader;
