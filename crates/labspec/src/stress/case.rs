//! One run of a lab under an interaction, and the faults in it.

use super::interaction::{Action, Interaction, InteractionKind, PUSH_SPEED};
use super::run_faults::{DIVERGED, earliest_observed_fault, reported_faults, warned};
use crate::bind::{Bound, Programs};
use crate::run::{self, Budget, End, Play, Session, Start};
use crate::spec::Lab;
use labspec_core::reflect::{FieldId, data};
use labspec_core::{AccessSet, Model, Plan};
use labspec_monitors::stress::{Fault, FaultKind, MOST_PAIRS, RunMonitor, pairs};
use std::collections::VecDeque;
use std::ops::ControlFlow;

/// The common data of all runs of a lab.
pub struct StressCase<'a> {
    /// The lab.
    pub lab: &'a Lab,
    /// Its compiled model, before `setup` and controls.
    pub model: &'a Model,
    /// Its programs, compiled for this model or for one that differs in numbers only.
    pub programs: &'a Programs,
    pub(super) access: AccessSet,
    /// Whether a program runs before every step. It may apply any force.
    controlled: bool,
    /// Whether a program may write positions of bodies.
    jumps: bool,
    /// Whether a display stores something when it is evaluated, so that its evaluation affects the run.
    shows: bool,
    /// The interaction that precedes all others.
    pub base: Interaction,
}

/// The results of a run.
#[derive(Clone, Debug, Default)]
pub struct RunOutcome {
    /// All faults.
    pub faults: Vec<Fault>,
    /// Length of the completed part of the run, s.
    pub covered: f64,
    /// Its work, in units of about a nanosecond.
    pub spent: u64,
    /// Drift speed of each body and each joint with friction at the end, by name, m/s or rad/s.
    pub speeds: Vec<(String, f64)>,
    /// Pairs of geoms that made contact.
    pub touching: Vec<[usize; 2]>,
    /// Whether it ended early, because its budget ran out or the user pressed Ctrl-C.
    pub cut: bool,
}

/// A run under an interaction: the pending actions, and the monitors of the run.
pub(crate) struct RunWatcher<'h> {
    /// The pending actions, in order of time.
    pending: VecDeque<&'h Action>,
    watch: RunMonitor,
    shows: bool,
    controlled: bool,
}

impl RunWatcher<'_> {
    /// Executes the actions that are due; returns whether there were any.
    fn act(&mut self, session: &mut Session<'_>) -> bool {
        let current = session.world.data.time();
        let mut acted = false;
        while let Some(action) = self.pending.front().filter(|a| current >= a.time - 1e-12).copied() {
            match &action.value {
                Some(value) => session.set_control(action.control, value.clone()),
                None => session.press(action.control),
            }
            acted = true;
            self.pending.pop_front();
        }
        acted
    }

    /// Executes the actions that are due before the first sample.
    pub(super) fn press_at_start(&mut self, session: &mut Session<'_>) {
        self.act(session);
    }

    /// Call at the start and after every step: executes the actions that are due, unless the run is over, and updates the
    /// monitors.
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

    /// The faults, after the run.
    pub(crate) fn faults(self, session: &Session<'_>) -> Vec<Fault> {
        let mut faults = reported_faults(session);
        // After a divergence, all other observations are consequences of it.
        let is_breakdown = |f: &Fault| matches!(f.kind, FaultKind::Diverges | FaultKind::Grows);
        let when = faults.iter().filter(|f| is_breakdown(f)).map(|f| f.time).fold(f64::INFINITY, f64::min);
        let noticed =
            earliest_observed_fault(&session.world.model, &session.observations()).filter(|f| f.time < when);
        faults.extend(noticed);
        let seen = self.watch.faults(&session.world.model).into_iter();
        let seen = seen
            .filter(|f| f.time < when && !(f.kind == FaultKind::Silent && when.is_finite()))
            .filter(|f| f.kind != FaultKind::Drifts || !self.controlled);
        for mut fault in seen {
            match faults.iter_mut().find(|reported| reported.covers(&fault)) {
                None => faults.push(fault),
                // The same fault with more evidence.
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

/// A modification of the model for a run, after all actions at its start.
pub type Change<'c> = &'c dyn Fn(&mut Session<'_>);

impl<'a> StressCase<'a> {
    /// The runs of a lab in which `base` precedes all other interactions.
    pub fn new(lab: &'a Lab, model: &'a Model, programs: &'a Programs, base: Interaction) -> StressCase<'a> {
        let mut access = programs.access;
        [data::geom_xpos, data::geom_xmat, data::xpos].into_iter().for_each(|f| access.reads.insert(f));
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
            access,
            controlled: programs.controller.is_some(),
            jumps: probes().chain(&programs.controller).any(jumps),
            shows: probes().any(stores),
            base,
        }
    }

    /// The case with another model that differs in numbers only.
    pub fn with_model<'b>(&'b self, model: &'b Model) -> StressCase<'b> {
        StressCase { lab: self.lab, model, programs: self.programs, base: self.base.clone(), ..*self }
    }

    /// The number of pairs of geoms that are monitored for tunnelling, if the model has more of them.
    pub fn watched_pairs_limit(&self) -> Option<usize> {
        (!self.jumps && pairs(self.model, MOST_PAIRS).1).then_some(MOST_PAIRS)
    }

    /// The lab after all actions before the first step.
    pub fn start(&self, interaction: &Interaction, budget: u64) -> Session<'a> {
        let plan = Some(Plan::new(self.model, &self.access));
        let start = Start { key: self.lab.keyframe(), plan, budget: Budget { left: budget } };
        let mut session = Session::start(self.programs, self.model, start);
        for action in interaction.actions.iter().filter(|a| a.time <= 0.0) {
            match &action.value {
                Some(value) => session.set_control(action.control, value.clone()),
                None => session.press(action.control),
            }
        }
        if interaction.kind == InteractionKind::Touched {
            session.world.data.edit().qvel.iter_mut().for_each(|v| *v += PUSH_SPEED);
            session.refresh();
        }
        session
    }

    /// Number of steps of a run of this length.
    pub fn steps(&self, timestep: f64, length: f64) -> usize {
        let most = (run::MAX_STEPS - 1) as f64;
        let count = (length / timestep).round();
        if count.is_finite() && timestep > 0.0 { count.clamp(0.0, most) as usize } else { 0 }
    }

    /// The watcher of a started run.
    pub(crate) fn watcher<'h>(&self, interaction: &'h Interaction, session: &Session<'_>) -> RunWatcher<'h> {
        RunWatcher {
            pending: interaction.actions.iter().filter(|a| a.time > 0.0).collect(),
            watch: RunMonitor::new(&session.world.model, self.jumps),
            shows: self.shows,
            controlled: self.controlled,
        }
    }

    /// Like [`StressCase::watcher`], for a run whose samples evaluate the displays, and that starts with the presses of
    /// `interaction`.
    pub(super) fn table_watcher<'h>(
        &self,
        interaction: &'h Interaction,
        session: &Session<'_>,
    ) -> RunWatcher<'h> {
        RunWatcher {
            pending: interaction.actions.iter().collect(),
            shows: false,
            ..self.watcher(interaction, session)
        }
    }

    /// Makes a run of `length` seconds.
    pub fn run(
        &self,
        interaction: &Interaction,
        change: Option<Change<'_>>,
        length: f64,
        budget: u64,
    ) -> RunOutcome {
        self.run_to_model(interaction, change, length, budget).0
    }

    /// Like [`StressCase::run`]; also returns the model at the end of the run.
    pub fn run_to_model(
        &self,
        interaction: &Interaction,
        change: Option<Change<'_>>,
        length: f64,
        budget: u64,
    ) -> (RunOutcome, Model) {
        let mut session = self.start(interaction, budget);
        if let Some(change) = change {
            change(&mut session);
            session.refresh();
        }
        let timestep = session.world.model.opt.timestep;
        let steps = self.steps(timestep, length);
        let mut watcher = self.watcher(interaction, &session);
        let reaches_stop = self.lab.stop_at.as_ref().is_some_and(|stop| stop.value == length);
        let stop = run::stop_time(self.lab, None, None, steps).filter(|_| reaches_stop);
        let played = Play { stop, watched: true, ..Play::steps(steps) };
        let made = run::play(&mut session, &played, |session, made| {
            watcher.observe(session, made, played.is_over(session, made));
            let over = DIVERGED.iter().any(|&w| warned(session, w).is_some());
            if over { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        });
        let is_whole = made == steps || session.ended().is_none() && played.is_over(&session, made);
        let speeds = watcher.watch.drift_speeds(&session.world.model);
        let touching = watcher.watch.touching();
        let faults = watcher.faults(&session);
        let outcome = RunOutcome {
            faults,
            covered: if is_whole { length } else { made as f64 * timestep },
            spent: session.spent(),
            speeds,
            touching,
            cut: matches!(session.ended(), Some(End::Budget { .. } | End::Interrupted)),
        };
        (outcome, session.world.model)
    }
}
