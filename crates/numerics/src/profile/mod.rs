//! The plan of a lab as a report: which stages run in a step and which are left out, with the reasons, their cost, and
//! the cost of further stages.

mod measure;
mod parts;
mod plan;
mod reader;
mod start;

pub use measure::{REPEATS, StageCost, StepCost};
pub use parts::{ConstraintCounts, EngineOption, PairSummary, SensorRow, TreeAlgorithmUse};
pub use plan::{CONES, PlanOptions, PlanReport, StageRow, name, plan};
pub use reader::ExtraReader;
