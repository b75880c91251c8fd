//! `Workspace`: the fields of a simulation, and the scratch of the stages.

use super::factored::FactoredMatrix;
use super::metric::Metric;
use super::sleep;
use super::stages::{Damping, Flow, RungeKutta};
use crate::forces::{self, derivative};
use crate::model::stopwatch::Stopwatch;
use crate::model::tree_algorithm::TreeAlgorithms;
use crate::model::{Fields, Model};
use crate::{collision, constraint, dynamics, sensor};

/// State, inputs and results of a simulation of one model.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Workspace {
    /// The state, the inputs and the results of the stages.
    pub fields: Fields,
    /// The memory of the stages, reused so that steps do not allocate.
    pub scratch: StepScratch,
}

/// The scratch of the stages, by module.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct StepScratch {
    /// That of poses, inertias and the algorithms of trees.
    pub dynamics: dynamics::DynamicsScratch,
    /// That of tendons, transmissions and actuators.
    pub forces: forces::ForceScratch,
    /// That of pairs of geoms and their contacts.
    pub collision: collision::CollisionScratch,
    /// That of constraint rows and solvers.
    pub constraint: constraint::ConstraintScratch,
    /// That of sensors.
    pub sensor: sensor::SensorScratch,
    pub(crate) sleep: sleep::SleepScratch,
    /// Derivatives of forces with respect to velocities.
    pub(crate) derivative: derivative::Work,
    pub(crate) damping: Damping,
    /// The matrix of the fast implicit integrator.
    pub(crate) factored: FactoredMatrix,
    /// The metric of the discrete integrator.
    pub(crate) metric: Metric,
    pub(crate) rk: RungeKutta,
    pub(crate) flow: Flow,
    /// Whether the current state is an intermediate state within a step, which users do not see.
    pub(crate) unseen: bool,
    /// The measurement of stage times, if it was requested.
    pub watch: Option<Box<Stopwatch>>,
}

impl StepScratch {
    /// Allocates the parts that depend on the sizes of the model.
    pub(super) fn resize(&mut self, m: &Model, algorithms: TreeAlgorithms) {
        self.dynamics = dynamics::DynamicsScratch::new(m, algorithms);
        self.forces = forces::ForceScratch::new(m);
        self.constraint = constraint::ConstraintScratch::new(m);
        self.sleep = sleep::SleepScratch::new(m);
        self.damping = Damping::new(m);
        self.rk = RungeKutta::new(m);
    }
}
