//! The options and the results of a comparison.

use super::beside::{Beside, OtherRecording};
use super::case::OmittedNumber;
use super::events::{Event, NearbyStarts};
use super::judge::{Compared, Errors};
use super::run_cost::RunCost;
use super::run_record::RunStatus;
use super::setting::{Setting, VariedSetting};
use labspec::run::Integrator;
use labspec_expr::Value;
use schemars::JsonSchema;
use serde::Serialize;

/// The settings to compare, and the interactions during the runs.
#[derive(Clone, Debug, Default)]
pub struct PrecisionOptions {
    /// The length in s; the lab's `stopAt`, or 2, if `None`.
    pub until: Option<f64>,
    /// Controls by label, with the values that they get before the first step.
    pub set: Vec<(String, Value)>,
    /// Buttons by label, with the times at which they are pressed, s.
    pub press: Vec<(String, f64)>,
    /// The integrators; those of MuJoCo if empty.
    pub integrators: Vec<Integrator>,
    /// Solver settings that are varied, at the lab's own integrator and timestep.
    pub axes: Vec<VariedSetting>,
    /// Another program's runs of the same lab.
    pub beside: Option<OtherRecording>,
}

/// The results of one setting.
#[derive(Clone, Debug, PartialEq)]
pub struct PrecisionRow {
    /// The setting.
    pub setting: Setting,
    /// Whether it is the lab's own.
    pub is_own: bool,
    /// The errors of each number.
    pub errors: Vec<Errors>,
    /// The timing error of each event, s: never smaller than the uncertainty of the event; NaN if it is unknown.
    pub events: Vec<f64>,
    /// The largest change of energy, J, if the scene conserves it.
    pub energy: Option<f64>,
    /// The largest change of momentum, if the scene conserves it: linear, kg m/s, and angular, kg m²/s.
    pub momentum: [Option<f64>; 2],
    /// The largest penetration depth, m; NaN if the truth is not known to the end.
    pub penetration: f64,
    /// The cost.
    pub cost: RunCost,
    /// The outcome of the run.
    pub status: RunStatus,
    /// The messages about the run.
    pub reported: Vec<String>,
    /// The largest possible error, including the uncertainty of the reference, in multiples of the smallest
    /// visible error; NaN if unknown.
    pub score: f64,
}

/// All runs of a lab.
#[derive(Clone, Debug, PartialEq)]
pub struct PrecisionResults {
    /// The compared numbers.
    pub targets: Vec<Compared>,
    /// The numbers that are not compared, with the reasons.
    pub omitted: Vec<OmittedNumber>,
    /// The reference in words; `None` if no method can simulate the lab.
    pub reference: Option<String>,
    /// The length of the runs, s.
    pub length: f64,
    /// The number of samples of the reference, without the start. A run is compared at those samples that its steps meet: after
    /// each of its steps, unless the steps are shorter than the sample interval.
    pub samples: usize,
    /// The runs: by integrator, from large to small timesteps; then the solver settings.
    pub rows: Vec<PrecisionRow>,
    /// The events of the reference, in the order of the rows' `events`.
    pub events: Vec<Event>,
    /// The energy that the scene conserves: the size of the moving part, J.
    pub energy: Option<f64>,
    /// The momentum that it conserves, with its size: linear and angular.
    pub momentum: [Option<f64>; 2],
    /// The largest penetration depth in the reference, m; NaN if it is not known to the end.
    pub penetration: f64,
    /// The uncertainty of the penetration depth, m.
    pub penetration_doubt: f64,
    /// How long runs with nearby starts agree, if the reference is lost before the end.
    pub nearby: Option<NearbyStarts>,
    /// The rows for which no other is better in both error and cost, from the cheapest to the most accurate.
    pub front: Vec<usize>,
    /// The recommendations.
    pub advice: Vec<Advice>,
    /// Runs of another program, if given.
    pub beside: Option<Beside>,
}

/// A recommendation in one sentence.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct Advice {
    /// The kind of recommendation.
    #[serde(skip)]
    pub kind: AdviceKind,
    /// The row that it is about.
    pub row: usize,
    /// The sentence.
    pub text: String,
}

/// The kind of a recommendation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AdviceKind {
    /// The error of the lab's own setting.
    LabSetting,
    /// The row is more accurate than the lab's own setting for the same work.
    Closer,
    /// The row is the cheapest one that displays every number correctly.
    Right,
    /// The row is the most accurate one; none displays every number correctly, or that is unknown.
    Closest,
}
