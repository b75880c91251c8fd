//! The plan of a lab as a report: what runs in a step and what is left out, each with its reason, what it costs, and what more
//! it would cost.

mod measure;
mod parts;
mod plan;
mod reader;
mod start;

pub use measure::{REPEATS, StageCost, StepCost};
pub use parts::{ConstraintCounts, EngineOption, PairSummary, SensorRow, TreeAlgorithmUse};
pub use plan::{Options, PlanReport, StageRow, name, plan};
pub use reader::ExtraReader;
