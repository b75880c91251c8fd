//! `Data`: the fields of a simulation, and the scratch of the stages.

use super::discrete::Metric;
use super::factored::Factored;
use super::stages::{Flow, RungeKutta};
use super::{damping, sleep};
use crate::forces::{self, derivative};
use crate::model::plan::PlanTable;
use crate::model::stopwatch::Stopwatch;
use crate::model::tree_algorithm::TreeAlgorithms;
use crate::model::{Fields, Model};
use crate::{collision, constraint, dynamics, sensor};
use std::ops::{Deref, DerefMut};

/// State, inputs and results of a simulation of one model.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Workspace {
    /// What everybody may look at.
    pub(crate) fields: Fields,
    /// What is nobody's business, kept so that steps do not allocate.
    pub(crate) work: Work,
}

/// Scratch of the stages, by rooms.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Work {
    pub(crate) dynamics: dynamics::Scratch,
    pub(crate) forces: forces::Scratch,
    pub(crate) collision: collision::Scratch,
    pub(crate) constraint: constraint::Scratch,
    pub(crate) sensor: sensor::Scratch,
    pub(crate) sleep: sleep::Scratch,
    /// Derivatives of forces with respect to velocities.
    pub(crate) derivative: derivative::Work,
    pub(crate) damping: damping::Scratch,
    /// The matrix of the fast implicit integrator.
    pub(crate) factored: Factored,
    /// The metric of the discrete integrator.
    pub(crate) metric: Metric,
    pub(crate) rk: RungeKutta,
    pub(crate) flow: Flow,
    /// Whether the state at hand is one that nobody sees, between two steps.
    pub(crate) unseen: bool,
    /// What measures the stages, where somebody asked for it.
    pub(crate) watch: Option<Box<Stopwatch>>,
}

impl Work {
    /// What depends on the sizes of the model.
    pub(super) fn make_room(&mut self, m: &Model, algorithms: TreeAlgorithms) {
        self.dynamics = dynamics::Scratch::new(m, algorithms);
        self.forces = forces::Scratch::new(m);
        self.constraint = constraint::Scratch::new(m);
        self.sleep = sleep::Scratch::new(m);
        self.damping = damping::Scratch::new(m);
        self.rk = RungeKutta::new(m);
    }
}

impl Deref for Workspace {
    type Target = Fields;

    #[cfg_attr(not(feature = "small"), inline(always))]
    fn deref(&self) -> &Fields {
        &self.fields
    }
}

impl DerefMut for Workspace {
    #[cfg_attr(not(feature = "small"), inline(always))]
    fn deref_mut(&mut self) -> &mut Fields {
        &mut self.fields
    }
}

impl Workspace {
    /// The plan that decides what is computed.
    pub(crate) fn plan(&self) -> &PlanTable {
        &self.fields.plan
    }
}
