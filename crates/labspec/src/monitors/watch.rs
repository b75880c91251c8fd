//! The watch over a run: every way in which it may go wrong without a word.

use super::growth::{self, Growth};
use super::limits::{self, Past};
use super::sunk::{self, Sunk};
use super::through::{self, Through};
use super::unsolved::{self, Unsolved};
use labspec_core::reflect::Stage;
use labspec_core::{Data, Model, Scope};

/// What was noticed, the first of each kind.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Noticed {
    /// Energy that nothing gave, or that dampers below zero give without end.
    pub growth: Option<Growth>,
    /// A joint past its limit.
    pub past: Option<Past>,
    /// A body that went through another one.
    pub through: Option<Through>,
    /// A body that stays in another one.
    pub sunk: Option<Sunk>,
    /// Forces that the solver did not find.
    pub unsolved: Option<Unsolved>,
}

impl Noticed {
    /// When the first of it was, s; infinite when there is nothing.
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

/// A run that is watched.
#[derive(Clone, Debug)]
pub struct Monitors {
    /// `None` where programs may give any energy.
    growth: Option<growth::GrowthMonitor>,
    limits: limits::LimitMonitor,
    through: through::TunnellingMonitor,
    sunk: sunk::SinkMonitor,
    unsolved: unsolved::SolverMonitor,
    /// Nothing touches, is limited or tied: only energy is to be looked at.
    bare: bool,
    noticed: Noticed,
}

/// A watch over a run that is now at `d`: for energy unless programs push in every step, and for all else. Looking costs next to
/// nothing until something is out of the ordinary.
pub fn watch<S: Scope>(m: &Model, d: &Data<S>, pushed: bool) -> Monitors {
    Monitors {
        growth: (!pushed).then(|| growth::watch(m, d)),
        limits: limits::watch(m, d),
        through: through::watch(m, d),
        sunk: sunk::watch(m),
        unsolved: unsolved::SolverMonitor::default(),
        bare: bare(d),
        noticed: Noticed::default(),
    }
}

/// From here on what was is forgotten but for what was noticed: something from outside has changed the state or the model.
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

/// Whether a scene has no constraints, whatever happens.
fn bare<S: Scope>(d: &Data<S>) -> bool {
    let plan = d.plan();
    !plan.keeps(Stage::Collision) && !plan.keeps(Stage::Constraint)
}

/// To be called after each step; nothing of the run is touched.
#[inline]
pub fn observe<S: Scope>(w: &mut Monitors, m: &Model, d: &Data<S>) {
    if let Some(growth) = &mut w.growth {
        w.noticed.growth = growth::observe(growth, m, d);
    }
    if !w.bare {
        constraints(w, m, d);
    }
}

// Apart, so that what is asked in every step stays small.
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

/// What was noticed so far.
pub fn noticed(w: &Monitors) -> &Noticed {
    &w.noticed
}
