//! All monitors of a run: each detects one way in which a run fails silently.

use super::growth::{self, Growth};
use super::limits::{self, ExceededLimit};
use super::sunk::{self, SunkContact};
use super::through::{self, Through};
use super::unsolved::{self, Unsolved};
use labspec_core::reflect::Stage;
use labspec_core::{Data, Model, Scope};

/// The first observation of each kind.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Observations {
    /// A gain of energy that no force supplied, or that negative damping supplies without limit.
    pub growth: Option<Growth>,
    /// A joint beyond its limit.
    pub past: Option<ExceededLimit>,
    /// A body that passed through another one.
    pub through: Option<Through>,
    /// A body that stays inside another one.
    pub sunk: Option<SunkContact>,
    /// Forces for which the solver did not converge.
    pub unsolved: Option<Unsolved>,
}

impl Observations {
    /// Time of the earliest observation, s; infinite when there is none.
    pub fn time(&self) -> f64 {
        let times = [
            self.growth.map(|x| x.time),
            self.past.map(|x| x.time),
            self.through.map(|x| x.time),
            self.sunk.map(|x| x.time),
            self.unsolved.map(|x| x.time),
        ];
        times.into_iter().flatten().fold(f64::INFINITY, f64::min)
    }
}

/// The monitors of a run.
#[derive(Clone, Debug)]
pub struct Monitors {
    /// `None` where programs may supply any energy.
    growth: Option<growth::GrowthMonitor>,
    limits: limits::LimitMonitor,
    through: through::TunnellingMonitor,
    sunk: sunk::SinkMonitor,
    unsolved: unsolved::SolverMonitor,
    /// The scene has no contacts, limits or equality constraints: only energy is monitored.
    bare: bool,
    noticed: Observations,
}

/// Starts monitoring a run in state `d`. Energy is monitored unless programs apply forces in every step (`pushed`). The
/// monitors cost almost nothing until something unusual happens.
pub fn watch<S: Scope>(m: &Model, d: &Data<S>, pushed: bool) -> Monitors {
    Monitors {
        growth: (!pushed).then(|| growth::watch(m, d)),
        limits: limits::watch(m, d),
        through: through::watch(m, d),
        sunk: sunk::watch(m),
        unsolved: unsolved::SolverMonitor::default(),
        bare: bare(d),
        noticed: Observations::default(),
    }
}

/// Restarts the monitors in state `d` after the state or the model was changed from outside. Observations are kept.
pub fn restart<S: Scope>(w: &mut Monitors, m: &Model, d: &Data<S>) {
    if let Some(growth) = &mut w.growth {
        growth::restart(growth, m, d);
    }
    w.limits = limits::watch(m, d);
    w.sunk = sunk::watch(m);
    through::restart(&mut w.through);
    unsolved::restart(&mut w.unsolved);
    w.bare = bare(d);
}

/// Whether the plan has neither collisions nor constraints.
fn bare<S: Scope>(d: &Data<S>) -> bool {
    let plan = d.plan();
    !plan.keeps(Stage::Collision) && !plan.keeps(Stage::Constraint)
}

/// Call after each step. It does not modify the run.
#[inline]
pub fn observe<S: Scope>(w: &mut Monitors, m: &Model, d: &Data<S>) {
    if let Some(growth) = &mut w.growth {
        w.noticed.growth = growth::observe(growth, m, d);
    }
    if !w.bare {
        constraints(w, m, d);
    }
}

// A separate function, so that the code that runs in every step stays small.
#[inline(never)]
fn constraints<S: Scope>(w: &mut Monitors, m: &Model, d: &Data<S>) {
    let found = &mut w.noticed;
    if found.past.is_none() {
        found.past = limits::observe(&mut w.limits, d);
    }
    if found.through.is_none() {
        found.through = through::observe(&mut w.through, m, d);
    }
    if found.sunk.is_none() {
        found.sunk = sunk::observe(&mut w.sunk, m, d);
    }
    if found.unsolved.is_none() {
        found.unsolved = unsolved::observe(&mut w.unsolved, m, d);
    }
}

/// The observations so far.
pub fn observations(w: &Monitors) -> &Observations {
    &w.noticed
}

/// The observations of a run that ends in this state.
pub fn final_observations(w: &Monitors, m: &Model) -> Observations {
    let last = || w.growth.as_ref().and_then(|growth| growth::evaluate_last(growth, m));
    Observations { growth: w.noticed.growth.or_else(last), ..w.noticed }
}
