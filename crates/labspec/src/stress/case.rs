//! One run of a lab under an interaction, and the faults in it.

use super::fault::{Fault, FaultKind};
use super::interaction::{Action, Interaction, Kind, TOUCH};
use super::run_faults::{DIVERGED, noticed_fault, reported_faults, warned};
use super::watch::RunMonitor;
use crate::bind::{Bound, Programs};
use crate::run::{self, Budget, End, Play, Session};
use crate::spec::Lab;
use labspec_core::reflect::{FieldId, data};
use labspec_core::{AccessSet, Model};
use std::collections::VecDeque;
use std::ops::ControlFlow;

/// What all runs share.
pub(crate) struct StressCase<'a> {
    pub(super) lab: &'a Lab,
    pub(super) model: &'a Model,
    pub(super) programs: &'a Programs,
    pub(super) demand: AccessSet,
    /// A program runs before every step: it may push whatever it likes.
    pub(super) controlled: bool,
    /// It may also write where bodies are.
    pub(super) jumps: bool,
    /// What is shown stores something when it is computed, so that it belongs to the run.
    shows: bool,
    /// What stands before everything else that is done.
    pub(super) base: Interaction,
}

/// What a run came to.
#[derive(Clone, Debug, Default)]
pub(crate) struct RunOutcome {
    pub(crate) faults: Vec<Fault>,
    /// How much of the run was made, s.
    pub(super) covered: f64,
    /// Work.
    pub(crate) spent: u64,
    /// How fast each body moved on at the end, by name, m/s.
    pub(super) speeds: Vec<(String, f64)>,
    /// Geoms that touched.
    pub(super) touching: Vec<[usize; 2]>,
    /// It ended before its time as the work was more than it may do.
    pub(crate) cut: bool,
}

/// A run under an interaction: the actions that are still due, and the monitors of the run.
pub(crate) struct RunWatcher<'h> {
    /// What is to be done, in order of time.
    pending: VecDeque<&'h Action>,
    watch: RunMonitor,
    shows: bool,
    controlled: bool,
}

impl RunWatcher<'_> {
    /// Does what is due; whether something was.
    fn act(&mut self, session: &mut Session<'_>) -> bool {
        let now = session.world.data.time();
        let mut acted = false;
        while let Some(action) = self.pending.front().filter(|a| now >= a.time - 1e-12).copied() {
            match &action.value {
                Some(value) => session.set_control(action.control, value.clone()),
                None => session.press(action.control),
            }
            acted = true;
            self.pending.pop_front();
        }
        acted
    }

    /// Presses what is to be pressed before the first sample is taken.
    pub(super) fn press_at_start(&mut self, session: &mut Session<'_>) {
        self.act(session);
    }

    /// At the start, and after every step: what is due is done, unless the run is over, and everything is looked at.
    pub(crate) fn observe(&mut self, session: &mut Session<'_>, made: usize, over: bool) {
        let acted = !over && self.act(session);
        let disturbed = made == 0 || acted;
        if self.shows {
            session.sample();
        }
        if disturbed {
            self.watch.disturb(&session.world.model, session.world.data.fields());
        } else {
            self.watch.observe(&session.world.model, session.world.data.fields());
        }
    }

    /// What went wrong, when the run is over.
    pub(crate) fn faults(self, session: &Session<'_>) -> Vec<Fault> {
        let mut faults = reported_faults(session);
        // What blew up is reported; all else that was seen follows from it.
        let broke = |f: &Fault| matches!(f.kind, FaultKind::Diverges | FaultKind::Grows);
        let when = faults.iter().filter(|f| broke(f)).map(|f| f.time).fold(f64::INFINITY, f64::min);
        let noticed = noticed_fault(&session.world.model, &session.noticed()).filter(|f| f.time < when);
        faults.extend(noticed);
        let seen = self.watch.faults(&session.world.model).into_iter();
        let seen = seen
            .filter(|f| f.time < when && !(f.kind == FaultKind::Silent && when.is_finite()))
            .filter(|f| f.kind != FaultKind::Drifts || !self.controlled);
        for mut fault in seen {
            match faults.iter_mut().find(|reported| reported.covers(&fault)) {
                None => faults.push(fault),
                // The same, with more to say of it.
                Some(reported) if reported.kind == fault.kind => {
                    fault.by_run = reported.by_run;
                    *reported = fault;
                }
                Some(_) => {}
            }
        }
        faults
    }
}

/// A change of the model that a run is made with, after everything that is done at its start.
pub(crate) type Change<'c> = &'c dyn Fn(&mut Session<'_>);

impl<'a> StressCase<'a> {
    pub(crate) fn new(
        lab: &'a Lab,
        model: &'a Model,
        programs: &'a Programs,
        base: Interaction,
    ) -> StressCase<'a> {
        let mut demand = programs.demand;
        [data::geom_xpos, data::geom_xmat, data::xpos].into_iter().for_each(|f| demand.reads.insert(f));
        let probes = || programs.probes.iter().filter_map(|p| p.bound.as_ref());
        let stores = |b: &Bound| {
            let e = b.program.effects();
            !e.ctx_writes.is_empty()
                || !e.writes.is_empty()
                || e.writes_everything
                || e.any_ctx
                || e.calls_values
        };
        let places = Some(data::qpos);
        let jumps = |b: &Bound| {
            let e = b.program.effects();
            e.writes_everything
                || e.calls_values
                || e.writes.iter().any(|w| FieldId::new(w.field.0 as usize) == places)
        };
        StressCase {
            lab,
            model,
            programs,
            demand,
            controlled: programs.controller.is_some(),
            jumps: probes().chain(&programs.controller).any(jumps),
            shows: probes().any(stores),
            base,
        }
    }

    /// The same with another model, of which nothing but numbers differs.
    pub(super) fn with_model<'b>(&'b self, model: &'b Model) -> StressCase<'b> {
        StressCase { lab: self.lab, model, programs: self.programs, base: self.base.clone(), ..*self }
    }

    /// The lab with everything done that comes before the first step.
    pub(crate) fn start(&self, handling: &Interaction, budget: u64) -> Session<'a> {
        let key = self.lab.keyframe();
        let budget = Budget { left: budget };
        let mut session = Session::start_within(self.programs, self.model, key, &self.demand, budget);
        for action in handling.actions.iter().filter(|a| a.time <= 0.0) {
            match &action.value {
                Some(value) => session.set_control(action.control, value.clone()),
                None => session.press(action.control),
            }
        }
        if handling.kind == Kind::Touched {
            session.world.data.edit().qvel.iter_mut().for_each(|v| *v += TOUCH);
            session.refresh();
        }
        session
    }

    /// Number of steps of a run that lasts so long.
    pub(crate) fn steps(&self, timestep: f64, length: f64) -> usize {
        let most = (run::MAX_STEPS - 1) as f64;
        let count = (length / timestep).round();
        if count.is_finite() && timestep > 0.0 { count.clamp(0.0, most) as usize } else { 0 }
    }

    /// The watcher of a run that has begun.
    pub(crate) fn eyes<'h>(&self, handling: &'h Interaction, session: &Session<'_>) -> RunWatcher<'h> {
        RunWatcher {
            pending: handling.actions.iter().filter(|a| a.time > 0.0).collect(),
            watch: RunMonitor::new(&session.world.model, self.jumps),
            shows: self.shows,
            controlled: self.controlled,
        }
    }

    /// The same on a run whose samples evaluate what is shown, and that begins with what `handling` presses.
    pub(super) fn eyes_of_table<'h>(
        &self,
        handling: &'h Interaction,
        session: &Session<'_>,
    ) -> RunWatcher<'h> {
        RunWatcher {
            pending: handling.actions.iter().collect(),
            shows: false,
            ..self.eyes(handling, session)
        }
    }

    /// Makes a run of so many seconds.
    pub(crate) fn run(
        &self,
        handling: &Interaction,
        change: Option<Change<'_>>,
        length: f64,
        budget: u64,
    ) -> RunOutcome {
        self.run_to_model(handling, change, length, budget).0
    }

    /// The same, and the model as the lab left it.
    pub(super) fn run_to_model(
        &self,
        handling: &Interaction,
        change: Option<Change<'_>>,
        length: f64,
        budget: u64,
    ) -> (RunOutcome, Model) {
        let mut session = self.start(handling, budget);
        if let Some(change) = change {
            change(&mut session);
            session.refresh();
        }
        let timestep = session.world.model.opt.timestep;
        let steps = self.steps(timestep, length);
        let mut eyes = self.eyes(handling, &session);
        let played = Play { steps, every: 1, presses: &[], watched: true };
        let made = run::play(&mut session, &played, |session, made| {
            eyes.observe(session, made, made == steps);
            let over = DIVERGED.iter().any(|&w| warned(session, w).is_some());
            if over { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        });
        let speeds = eyes.watch.rest.speeds(&session.world.model);
        let touching = eyes.watch.touching();
        let faults = eyes.faults(&session);
        let outcome = RunOutcome {
            faults,
            covered: if made == steps { length } else { made as f64 * timestep },
            spent: session.spent(),
            speeds,
            touching,
            cut: matches!(session.ended(), Some(End::Budget { .. } | End::Interrupted)),
        };
        (outcome, session.world.model)
    }
}
