//! One run of a lab: executes the events of the lab format in order.

use super::budget::{Budget, End};
use super::held::ProgramsRef;
use super::program_error::ProgramError;
use super::steady::SteadyController;
use super::variant::StepVariant;
use super::watched::MonitoredRun;
use crate::bind::coupled::{self, Coupled};
use crate::bind::{ActionProgram, ControlProgram, Programs, World};
use crate::interrupt;
use crate::source::Text;
use crate::spec::Lab;
use labspec_core::{self as core, Data, Model, Plan, Planned, Warning, WarningStat};
use labspec_expr::rules::{self, Rule};
use labspec_expr::{Context, Program, RuntimeError, Value};
use labspec_monitors::growth::Growth;
use labspec_monitors::watch::{self, Observations};

/// A running lab. A clone continues independently with equal results.
#[derive(Clone, Debug)]
pub struct Session<'p> {
    /// The model and its data.
    pub world: World,
    /// The `ctx` variables.
    pub context: Context,
    /// Errors, the first for each place.
    pub program_errors: Vec<ProgramError>,
    /// Warnings of the engine, including those before a reset.
    pub warnings: [WarningStat; Warning::COUNT],
    pub(super) programs: ProgramsRef<'p>,
    key: Option<usize>,
    /// The current value of each control.
    values: Vec<Value>,
    watched: Option<MonitoredRun>,
    /// The last run of a controller that need not run in every step.
    steady: Option<SteadyController>,
    /// Work budget since the start, work of the data before the start, and work of samples.
    budget: u64,
    before: u64,
    pub(super) sampled: u64,
    pub(super) end: Option<End>,
    /// Whether a program changed a parameter without the parameters coupled to it, as far as programs observe that.
    has_uncoupled_change: bool,
}

/// How a run starts.
#[derive(Clone, Debug, Default)]
pub struct Start {
    /// The index of the keyframe to which it is reset; if `None`, the initial state of the model.
    pub key: Option<usize>,
    /// The plan; if `None`, that of the reads and writes of the lab's programs.
    pub plan: Option<Plan>,
    /// Its work budget.
    pub budget: Budget,
}

impl Start {
    /// From the keyframe of a lab.
    pub fn of_lab(lab: &Lab) -> Start {
        Start { key: lab.keyframe(), ..Start::default() }
    }
}

impl<'p> Session<'p> {
    /// Loads the lab: steps 1 to 3 of the order of events.
    pub fn start(programs: impl Into<ProgramsRef<'p>>, model: &Model, start: Start) -> Session<'p> {
        let (programs, Start { key, plan, budget }) = (programs.into(), start);
        let data = Data::planned(model, plan.unwrap_or_else(|| Plan::new(model, &programs.access)));
        let before = core::cost(&data);
        let values = programs.controls.iter().map(|(_, c)| match c {
            ControlProgram::Change(value, _) => value.clone(),
            ControlProgram::Press(_) => Value::Undefined,
        });
        let mut session = Session {
            world: World {
                model: model.clone(),
                data,
                key,
                functions: programs.functions.clone(),
                displayed: Vec::new(),
                numbers: Vec::new(),
                playback: None,
            },
            context: Context::for_globals(&programs.globals),
            program_errors: Vec::new(),
            warnings: [WarningStat::default(); Warning::COUNT],
            values: values.collect(),
            watched: None,
            steady: programs
                .controller
                .as_ref()
                .and_then(|bound| SteadyController::of_program(&bound.program)),
            budget: budget.left,
            before,
            sampled: 0,
            end: None,
            has_uncoupled_change: false,
            programs,
            key,
        };
        if session.programs.model != model.identity() {
            session.end = Some(End::Foreign);
            return session;
        }
        session.forward();
        if session.key.is_some() {
            session.reset_data();
        }
        for i in 0..session.values.len() {
            session.apply(i, session.values[i].clone());
        }
        session.after_reset();
        session
    }

    /// The programs of the lab.
    pub fn programs(&self) -> &Programs {
        &self.programs
    }

    /// The current value of each control; `undefined` for a button.
    pub fn values(&self) -> &[Value] {
        &self.values
    }

    /// Whether a program changed a parameter without the parameters coupled to it, as far as programs observe that.
    pub(crate) fn has_uncoupled_change(&self) -> bool {
        self.has_uncoupled_change
    }

    /// Renews the work budget from the current time on, for a page, which plays as long as it is open. A run that has ended
    /// stays ended.
    pub fn renew(&mut self, budget: Budget) {
        self.budget = self.spent().saturating_add(budget.left);
    }

    /// Restarts the run, even after its end: the same reset as [`Session::reset`], and the lab is no longer frozen.
    pub fn start_over(&mut self) {
        if self.end != Some(End::Foreign) {
            self.end = None;
            self.reset();
        }
    }

    /// The names of its traces and readouts.
    pub(crate) fn probes(&self) -> impl Iterator<Item = String> {
        let names: Vec<String> = self.programs.probes.iter().map(|p| p.name.clone()).collect();
        names.into_iter()
    }

    /// The work so far, in units of about a nanosecond.
    pub fn spent(&self) -> u64 {
        (core::cost(&self.world.data) - self.before) + self.context.work() + self.sampled
    }

    /// Why the run has ended, if it has. It does not continue after that.
    pub fn ended(&self) -> Option<&End> {
        self.end.as_ref()
    }

    pub(super) fn left(&self) -> u64 {
        self.budget.saturating_sub(self.spent())
    }

    /// Sets the remaining work as the limit of the engine and the next program; `false` when the run has ended.
    fn go(&mut self) -> bool {
        if self.end.is_none() {
            let left = self.left();
            core::limit(&mut self.world.data, left);
            self.context.allow(left);
        }
        self.end.is_none()
    }

    /// Ends the run when its budget has run out. Everything computed since `time` is then invalid.
    pub(super) fn settle(&mut self, time: f64) -> bool {
        if self.end.is_none() && (core::exhausted(&self.world.data) || self.left() == 0) {
            self.end = Some(End::Budget { time });
        }
        self.end.is_none()
    }

    /// Changes a control: step 5.
    pub fn set_control(&mut self, index: usize, value: Value) {
        let Some((_, ControlProgram::Change(_, action))) = self.programs.controls.get(index) else { return };
        let resets = action.reset;
        self.apply(index, value);
        if resets {
            self.reset();
        } else {
            self.forward();
        }
    }

    /// Presses a button.
    pub fn press(&mut self, index: usize) {
        let programs = self.programs.clone();
        if let Some((_, ControlProgram::Press(Some(bound)))) = programs.controls.get(index) {
            self.execute(&bound.program, &bound.text, None);
            self.forward();
        }
    }

    /// Presses every button whose time has come, and removes it from the list.
    pub fn press_due(&mut self, pending: &mut &[(usize, f64)]) {
        while let Some(&(button, time)) = pending.first()
            && self.world.data.time() >= time - 1e-12
        {
            *pending = &pending[1..];
            self.press(button);
        }
    }

    /// Resets the run: step 6. The model and `ctx` keep the values that were written to them.
    pub fn reset(&mut self) {
        self.reset_data();
        self.after_reset();
    }

    /// Runs the controller, then one step of the engine. Does nothing when the run has ended.
    #[inline]
    pub fn step(&mut self) {
        self.step_by(core::step);
    }

    /// Like [`Session::step`], with a step function of the caller, which may measure the time of the step.
    #[inline]
    pub fn step_by(&mut self, engine: impl FnOnce(&Model, &mut Data<Planned>) -> Result<(), core::Error>) {
        if self.end.is_some() {
            return;
        }
        let time = self.world.data.time();
        if self.programs.controller.is_some() {
            self.control();
        }
        if !self.go() {
            return;
        }
        let World { model, data, .. } = &mut self.world;
        if let Some(w) = self.watched.as_mut().filter(|w| w.disturbed) {
            w.disturbed = false;
            watch::restart(&mut w.watch, model, data);
        }
        let stepped = engine(model, data);
        self.refused(stepped);
        if !self.settle(time) {
            return;
        }
        if interrupt::requested() {
            self.end = Some(End::Interrupted);
            return;
        }
        let World { model, data, .. } = &self.world;
        if let Some(w) = &mut self.watched {
            watch::observe(&mut w.watch, model, data);
        }
        self.note_warnings();
    }

    /// Runs the controller. A controller that would change nothing is skipped; its work is counted, so that every run ends
    /// at the same step.
    fn control(&mut self) {
        let holds = self.steady.as_ref().and_then(|steady| steady.holds(&self.world, &self.context));
        if let Some(work) = holds.filter(|work| *work < self.left()) {
            self.sampled += work;
            return;
        }
        let programs = self.programs.clone();
        let before = self.context.work();
        if let Some(bound) = &programs.controller
            && !self.execute(&bound.program, &bound.text, None)
        {
            self.end.get_or_insert(End::Threw);
        }
        if let Some(steady) = &mut self.steady {
            let clean = self.end.is_none() && self.context.events().is_empty();
            let work = clean.then(|| self.context.work() - before);
            steady.keep(&self.world, &self.context, work);
        }
    }

    /// Starts monitoring the run for silent faults. Programs that apply forces in every step may supply any energy, and a
    /// program that sets positions may put bodies anywhere: such a run is monitored for other faults only, or not at all.
    pub fn watch(&mut self) {
        if self.end.is_some() {
            return;
        }
        self.watched = MonitoredRun::begin(&self.programs, &self.world);
    }

    /// Energy growth, when the run is monitored and has gained energy.
    pub fn growth(&self) -> Option<Growth> {
        self.observations().growth
    }

    /// All silent faults, as far as the run is monitored.
    pub fn observations(&self) -> Observations {
        let watched = self.watched.as_ref();
        watched.map(|w| watch::final_observations(&w.watch, &self.world.model)).unwrap_or_default()
    }

    /// Ends a run in which the engine refuses a call, because it has no valid state.
    fn refused(&mut self, done: Result<(), core::Error>) {
        if done.is_err() {
            self.end.get_or_insert(End::Threw);
        }
    }

    /// Records an error, or ends the run if its budget ran out.
    pub(super) fn report_error(&mut self, e: RuntimeError, text: &Text, time: f64) {
        let spent = e.rule == rules::BUDGET && (self.left() == 0 || core::exhausted(&self.world.data));
        if spent {
            self.end.get_or_insert(End::Budget { time });
        } else {
            self.note(e.rule, text, e.span.start..e.span.end, e.message);
        }
    }

    /// Runs statements, then `mj_forward`: the setup that a question adds to that of its lab.
    pub fn run_statements(&mut self, program: &Program, text: &Text) {
        self.execute(program, text, None);
        self.forward();
    }

    /// Changes the numerics. `mentioned` states that the lesson sets the timestep, which is then kept.
    pub fn perturb(&mut self, variant: StepVariant, mentioned: bool) {
        variant.change_options(&mut self.world.model, mentioned);
        if variant.perturbation != 0.0 {
            self.world.data.edit().qpos.iter_mut().for_each(|q| *q += variant.perturbation);
            self.forward();
        }
    }

    /// Recomputes everything from the current state. After a step, forces and dependent values are those of the state
    /// before it.
    pub fn refresh(&mut self) {
        self.forward();
    }

    fn forward(&mut self) {
        if !self.go() {
            return;
        }
        let time = self.world.data.time();
        let done = core::forward(&self.world.model, &mut self.world.data);
        self.refused(done);
        self.settle(time);
        if let Some(w) = &mut self.watched {
            w.disturbed = true;
        }
    }

    fn reset_data(&mut self) {
        let done = self.world.reset_to(self.key);
        self.refused(done);
        self.forward();
    }

    /// Step 3: setup, the `init` controls, forward.
    fn after_reset(&mut self) {
        let programs = self.programs.clone();
        if let Some(bound) = &programs.setup
            && self.end.is_none()
            && !self.execute(&bound.program, &bound.text, None)
        {
            self.end.get_or_insert(End::Threw);
        }
        for (i, (_, control)) in programs.controls.iter().enumerate() {
            if let ControlProgram::Change(_, action) = control
                && action.init
            {
                let value = self.values[i].clone();
                self.run_action(action, &value);
            }
        }
        self.forward();
    }

    /// Stores the value of a control and runs its action.
    fn apply(&mut self, index: usize, value: Value) {
        let programs = self.programs.clone();
        if let Some((_, ControlProgram::Change(_, action))) = programs.controls.get(index) {
            self.values[index] = value.clone();
            if let Some(slot) = action.param {
                self.context.store(&self.programs.globals, slot, value.clone());
            }
            self.run_action(action, &value);
        }
    }

    fn run_action(&mut self, action: &ActionProgram, value: &Value) {
        if let Some(bound) = &action.run {
            self.execute(&bound.program, &bound.text, Some(value));
        }
    }

    /// Runs statements, unless the run has ended; `false` when they throw.
    fn execute(&mut self, program: &Program, text: &Text, value: Option<&Value>) -> bool {
        if !self.go() {
            return false;
        }
        let time = self.world.data.time();
        let pairs = |c: &Option<Coupled>| c.as_ref().and_then(|c| c.pairs_after(program, text));
        let corrected = pairs(&self.programs.coupled);
        let observed = if self.has_uncoupled_change { None } else { pairs(&self.programs.observed) };
        let before = (corrected.is_some() || observed.is_some()).then(|| self.world.model.clone());
        let result = program.run(&mut self.world, &mut self.context, value);
        let good = result.is_ok();
        if let Err(e) = result {
            self.report_error(e, text, time);
        }
        if let (Some(pairs), Some(before)) = (observed, &before) {
            self.has_uncoupled_change = coupled::has_uncoupled_change(pairs, before, &self.world.model);
        }
        if let (Some(pairs), Some(before), Some(follower)) = (corrected, &before, &self.programs.coupled) {
            let done = follower.follow(pairs, before, program, &mut self.world);
            self.refused(done);
        }
        if !self.settle(time) {
            return good;
        }
        // A read past the end gives `undefined`, which a lesson may intend. A lost store is an error.
        let broken = self.context.events().iter().find_map(|e| Some((e.rule()?, *e)));
        if let Some((rule, event)) = broken {
            self.note(rule, text, event.span.start..event.span.end, event.to_string());
        }
        self.note_warnings();
        good
    }

    fn note(&mut self, rule: &'static Rule, text: &Text, span: std::ops::Range<usize>, message: String) {
        let is_noted = |t: &ProgramError| t.rule == rule && t.span == span && t.text == *text;
        if !self.program_errors.iter().any(is_noted) {
            let time = self.world.data.time();
            self.program_errors.push(ProgramError { rule, text: text.clone(), span, message, time });
        }
    }

    /// Keeps warnings across resets of the data, which reset the counters of the engine.
    fn note_warnings(&mut self) {
        // Called after every step, almost always without warnings.
        if self.world.data.fields().warning.iter().map(|w| w.number).sum::<usize>() == 0 {
            return;
        }
        for (stored, current) in self.warnings.iter_mut().zip(&self.world.data.fields().warning) {
            if current.number > 0 && stored.number == 0 {
                *stored = *current;
            }
            stored.number = stored.number.max(current.number);
        }
    }
}
