//! What is compared, and the results.

use super::beside::{Beside, Recording};
use super::case::LeftOut;
use super::events::{Event, Nearby};
use super::judge::{Compared, Errors};
use super::run_cost::RunCost;
use super::run_record::RunStatus;
use super::setting::{Axis, Setting};
use labspec::run::Integrator;
use labspec_expr::Value;
use serde::Serialize;

/// What is compared, and how the lab is handled meanwhile.
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// Length in s; the lab's `stopAt`, or 2, without it.
    pub until: Option<f64>,
    /// Controls by label, and what they are set to before the first step.
    pub set: Vec<(String, Value)>,
    /// Buttons by label, and the times of their presses, s.
    pub press: Vec<(String, f64)>,
    /// The integrators; MuJoCo's, where none is named.
    pub integrators: Vec<Integrator>,
    /// Settings of the solver that are varied, at the lab's own integrator and timestep.
    pub axes: Vec<Axis>,
    /// Another program's runs of the same lab.
    pub beside: Option<Recording>,
}

/// One setting.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// What was run.
    pub setting: Setting,
    /// Whether it is the lab's own.
    pub is_own: bool,
    /// How far each number is from the truth.
    pub errors: Vec<Errors>,
    /// How far each event is from its time, s: never below what that may be off; NaN where it is not known.
    pub events: Vec<f64>,
    /// The largest change of energy, J, where the scene keeps it.
    pub energy: Option<f64>,
    /// The largest change of momentum, where the scene keeps it: of motion, kg m/s, and of turning, kg m²/s.
    pub momentum: [Option<f64>; 2],
    /// How deep bodies were in each other at most, m; NaN where the truth is not known to the end.
    pub penetration: f64,
    /// What it costs.
    pub cost: RunCost,
    /// What became of the run.
    pub status: RunStatus,
    /// What was reported about it.
    pub reported: Vec<String>,
    /// The largest error that is possible, as the reference is in doubt, too; in times of what nobody sees. NaN where nothing is
    /// known.
    pub score: f64,
}

/// All runs of a lab.
#[derive(Clone, Debug, PartialEq)]
pub struct Report {
    /// What is compared.
    pub targets: Vec<Compared>,
    /// What is not, and why.
    pub left_out: Vec<LeftOut>,
    /// The reference, in words; `None` where no method comes through the lab.
    pub reference: Option<String>,
    /// Length of the runs, s.
    pub length: f64,
    /// Number of samples of the reference, without that of the start. A run is compared at those that its steps meet: after each of
    /// its steps, unless these are shorter.
    pub samples: usize,
    /// The runs: by integrator, from large to small timesteps; then the solver's.
    pub rows: Vec<Row>,
    /// What happens in the reference, in the order of the rows' `events`.
    pub events: Vec<Event>,
    /// Energy that the scene keeps, with the size of what moves, J.
    pub energy: Option<f64>,
    /// Momentum that it keeps, with its size: of motion, and of turning.
    pub momentum: [Option<f64>; 2],
    /// How deep bodies are in each other in the reference, m, and how far that may be off; NaN where it is not known to the end.
    pub penetration: f64,
    /// How far that may be off, m.
    pub penetration_doubt: f64,
    /// How long nearby starts stay together, where the reference is lost before the end.
    pub nearby: Option<Nearby>,
    /// Rows that no other beats in both, from the cheapest to the closest.
    pub front: Vec<usize>,
    /// What to take.
    pub advice: Vec<Advice>,
    /// Another program's runs, where they were given.
    pub beside: Option<Beside>,
}

/// A sentence about what to take, with the row that it is about.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Advice {
    /// What it says.
    #[serde(skip)]
    pub kind: Kind,
    /// The row.
    pub row: usize,
    /// The sentence.
    pub text: String,
}

/// What an advice says of its row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// What the lab's own setting is off by.
    LabSetting,
    /// It is closer than the lab's own for the same work.
    Closer,
    /// It is the cheapest that shows every number rightly.
    Right,
    /// It is the closest; none shows every number rightly, or nobody knows.
    Closest,
}
