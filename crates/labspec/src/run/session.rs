//! One run of a lab: the order of events of the lab format, step by step.

use super::budget::{Budget, End};
use super::held::Held;
use super::steady::Steady;
use super::table::Cell;
use crate::bind::coupled::{self, Coupled};
use crate::bind::{ActionProgram, Bound, ControlProgram, Programs, World};
use crate::interrupt;
use crate::monitors::growth::Growth;
use crate::monitors::watch::{self, Monitors, Noticed};
use crate::source::Text;
use labspec_core::reflect::{FieldId, Kind, data, option};
use labspec_core::{self as core, AccessSet, Data, Model, Plan, Planned, Warning, WarningStat};
use labspec_expr::rules::{self, Rule};
use labspec_expr::{Context, FieldKey, Program, RuntimeError, Value};

/// Something that went wrong in a program while the lab ran; JavaScript would have thrown, or said nothing.
#[derive(Clone, Debug, PartialEq)]
pub struct Trouble {
    /// What was broken.
    pub rule: &'static Rule,
    /// The text and the bytes of it that failed.
    pub text: Text,
    /// Bytes of `text`.
    pub span: std::ops::Range<usize>,
    /// What happened.
    pub message: String,
    /// Simulated time of the first occurrence, s.
    pub time: f64,
}

/// A change of the numerics that a lesson does not mention, to see whether its answers depend on it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StepVariant {
    /// The timestep is multiplied by this.
    pub timestep: f64,
    /// The constraint problem is solved to rounding.
    pub tight: bool,
    /// Every coordinate of the start is moved by this: far less than anybody could measure.
    pub perturbation: f64,
    /// Another integrator, where the scene has the one that it has unless somebody says otherwise.
    pub integrator: Option<i32>,
}

impl StepVariant {
    /// As the lesson states it.
    pub const NOMINAL: StepVariant =
        StepVariant { timestep: 1.0, tight: false, perturbation: 0.0, integrator: None };
}

/// A running lab. Its clone goes on as it would.
#[derive(Clone, Debug)]
pub struct Session<'p> {
    /// The model and its data.
    pub world: World,
    /// The `ctx` variables.
    pub context: Context,
    /// What went wrong, the first time for each place.
    pub troubles: Vec<Trouble>,
    /// Warnings of the engine, also those of before a reset.
    pub warnings: [WarningStat; Warning::COUNT],
    programs: Held<'p>,
    key: Option<usize>,
    /// The current value of each control.
    values: Vec<Value>,
    watched: Option<Watched>,
    /// How the controller ran last, where it need not run in every step.
    steady: Option<Steady>,
    /// Work that may be done from the start on, that of the data before, and that of samples.
    budget: u64,
    before: u64,
    sampled: u64,
    end: Option<End>,
    /// A program left a partner of its parameter behind, as far as that is observed.
    left_behind: bool,
}

/// What a sample of a trace counts besides its own work.
const SAMPLE: u64 = 100;

/// What a program may write in every step that moves nothing by itself.
const PUSHES: [FieldId; 3] = [data::ctrl, data::qfrc_applied, data::xfrc_applied];

/// Whether a field is one that pushes.
fn pushes(field: FieldKey) -> bool {
    FieldId::new(field.0 as usize).is_some_and(|f| PUSHES.contains(&f))
}

/// Whether a field follows from others, or says what of them is computed: writing it moves nothing.
fn follows(field: FieldKey) -> bool {
    FieldId::new(field.0 as usize).is_some_and(|f| f.info().kind == Kind::Derived || f == option::enableflags)
}

/// Whether a program may move things by itself, or change the model.
fn moves(bound: &Bound) -> bool {
    let effects = bound.program.effects();
    let still = |field: FieldKey| pushes(field) || follows(field);
    effects.writes_everything || effects.calls_values || !effects.writes.iter().all(|a| still(a.field))
}

/// A run that is watched for what goes wrong without a word.
#[derive(Clone, Debug)]
struct Watched {
    watch: Monitors,
    /// Something from outside changed the state or the model since the last step.
    disturbed: bool,
}

impl<'p> Session<'p> {
    /// Loads the lab: steps 1 to 3 of the order of events.
    pub fn start(
        programs: impl Into<Held<'p>>,
        model: &Model,
        key: Option<usize>,
        demand: &AccessSet,
    ) -> Session<'p> {
        Session::start_within(programs, model, key, demand, Budget::ASKED)
    }

    /// The same with another budget.
    pub fn start_within(
        programs: impl Into<Held<'p>>,
        model: &Model,
        key: Option<usize>,
        demand: &AccessSet,
        budget: Budget,
    ) -> Session<'p> {
        let data = Data::planned(model, Plan::new(model, demand));
        Session::load(programs.into(), model, key, data, budget)
    }

    /// The same with data whose plan is already decided.
    pub fn start_with(
        programs: impl Into<Held<'p>>,
        model: &Model,
        key: Option<usize>,
        data: Data<Planned>,
    ) -> Session<'p> {
        Session::load(programs.into(), model, key, data, Budget::ASKED)
    }

    /// The same within a budget.
    pub fn start_with_within(
        programs: impl Into<Held<'p>>,
        model: &Model,
        key: Option<usize>,
        data: Data<Planned>,
        budget: Budget,
    ) -> Session<'p> {
        Session::load(programs.into(), model, key, data, budget)
    }

    fn load(
        programs: Held<'p>,
        model: &Model,
        key: Option<usize>,
        data: Data<Planned>,
        budget: Budget,
    ) -> Session<'p> {
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
                own: programs.functions.clone(),
                shown: Vec::new(),
                numbers: Vec::new(),
            },
            context: Context::for_globals(&programs.globals),
            troubles: Vec::new(),
            warnings: [WarningStat::default(); Warning::COUNT],
            values: values.collect(),
            watched: None,
            steady: programs.controller.as_ref().and_then(|bound| Steady::of(&bound.program)),
            budget: budget.left,
            before,
            sampled: 0,
            end: None,
            left_behind: false,
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

    /// Whether a program changed a parameter and left behind what belongs to it, as far as its programs observe that.
    pub(crate) fn left_behind(&self) -> bool {
        self.left_behind
    }

    /// Lets the run do so much work from here on, whatever it did before: for a page, which plays for as long as somebody
    /// looks. A run that has ended stays ended.
    pub fn renew(&mut self, budget: Budget) {
        self.budget = self.spent().saturating_add(budget.left);
    }

    /// Starts over, also after an end: the same reset as [`Session::reset`], and the lab is no longer frozen.
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

    /// The work that was done, in units of about a nanosecond.
    pub fn spent(&self) -> u64 {
        (core::cost(&self.world.data) - self.before) + self.context.work() + self.sampled
    }

    /// Why the run has ended, if it has: from there on nothing happens any more.
    pub fn ended(&self) -> Option<&End> {
        self.end.as_ref()
    }

    fn left(&self) -> u64 {
        self.budget.saturating_sub(self.spent())
    }

    /// Lets the engine and the next program do what is left; `false` when the run has ended.
    fn go(&mut self) -> bool {
        if self.end.is_none() {
            let left = self.left();
            core::limit(&mut self.world.data, left);
            self.context.allow(left);
        }
        self.end.is_none()
    }

    /// Ends the run when its budget is spent; what it did since this time is of no use then.
    fn settle(&mut self, time: f64) -> bool {
        if self.end.is_none() && (core::exhausted(&self.world.data) || self.left() == 0) {
            self.end = Some(End::Budget { time });
        }
        self.end.is_none()
    }

    /// A control changes: step 5.
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

    /// A button is pressed.
    pub fn press(&mut self, index: usize) {
        let programs = self.programs.clone();
        if let Some((_, ControlProgram::Press(Some(bound)))) = programs.controls.get(index) {
            self.execute(&bound.program, &bound.text, None);
            self.forward();
        }
    }

    /// Presses every button whose time has come, and drops it from the list.
    pub fn press_due(&mut self, pending: &mut &[(usize, f64)]) {
        while let Some(&(button, time)) = pending.first()
            && self.world.data.time() >= time - 1e-12
        {
            *pending = &pending[1..];
            self.press(button);
        }
    }

    /// Back to the start: step 6. The model and `ctx` keep what was written to them.
    pub fn reset(&mut self) {
        self.reset_data();
        self.after_reset();
    }

    /// The controller, then one step of the engine. Nothing when the run has ended.
    #[inline]
    pub fn step(&mut self) {
        self.step_by(core::step);
    }

    /// The same with a step that the caller takes, who looks at the clock before and after it.
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

    /// The controller. One that would change nothing is not run; its work counts, so that every run ends where it would.
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

    /// Watches the run that begins here for what goes wrong without a word. Programs that push in every step
    /// may give any energy, and one that moves things by itself may put them anywhere: such a run is watched for the rest,
    /// or not at all.
    pub fn watch(&mut self) {
        if self.end.is_some() {
            return;
        }
        let probes = self.programs.probes.iter().filter_map(|p| p.bound.as_ref());
        let programs: Vec<&Bound> = probes.chain(&self.programs.controller).collect();
        if programs.iter().any(|bound| moves(bound)) {
            return;
        }
        let pushed =
            programs.iter().any(|bound| bound.program.effects().writes.iter().any(|a| pushes(a.field)));
        let watch = watch::watch(&self.world.model, &self.world.data, pushed);
        self.watched = Some(Watched { watch, disturbed: false });
    }

    /// Energy that nothing gave, when the run was watched and has gained any.
    pub fn growth(&self) -> Option<Growth> {
        self.noticed().growth
    }

    /// Everything that went wrong without a word, as far as the run was watched.
    pub fn noticed(&self) -> Noticed {
        self.watched.as_ref().map(|w| *watch::noticed(&w.watch)).unwrap_or_default()
    }

    /// Time and every probe. What throws is nothing, as on the page.
    pub fn sample(&mut self) -> Vec<Cell> {
        let mut row = Vec::with_capacity(self.programs.probes.len() + 1);
        row.push(Cell::Number(self.world.data.time()));
        let programs = self.programs.clone();
        for probe in &programs.probes {
            let value = probe.bound.as_ref().and_then(|b| self.evaluate(&b.program, &b.text));
            row.push(value.map_or(Cell::Nothing, Cell::from));
        }
        row
    }

    /// The value of an expression now; `None` when it throws, and when the budget is spent. One that came to no end before is
    /// not tried again.
    pub fn evaluate(&mut self, program: &Program, text: &Text) -> Option<Value> {
        let endless = |t: &Trouble| t.rule == rules::BUDGET && t.text == *text;
        if matches!(self.end, Some(End::Budget { .. } | End::Foreign)) || self.troubles.iter().any(endless) {
            return None;
        }
        self.sampled += SAMPLE;
        let (time, left) = (self.world.data.time(), self.left());
        core::limit(&mut self.world.data, left);
        self.context.allow(left.min(Budget::SAMPLE.left));
        match program.run(&mut self.world, &mut self.context, None) {
            Ok(value) => self.settle(time).then_some(value),
            Err(e) => {
                self.threw(e, text, time);
                None
            }
        }
    }

    /// A run in which the engine refuses a call has nothing to go on from.
    fn refused(&mut self, done: Result<(), core::Error>) {
        if done.is_err() {
            self.end.get_or_insert(End::Threw);
        }
    }

    /// Notes what threw, unless it is the budget of the run that was spent.
    fn threw(&mut self, e: RuntimeError, text: &Text, time: f64) {
        let spent = e.rule == rules::BUDGET && (self.left() == 0 || core::exhausted(&self.world.data));
        if spent {
            self.end.get_or_insert(End::Budget { time });
        } else {
            self.note(e.rule, text, e.span.start..e.span.end, e.message);
        }
    }

    /// Runs statements, then `mj_forward`: what a question adds to the setup of its lab.
    pub fn run_statements(&mut self, program: &Program, text: &Text) {
        self.execute(program, text, None);
        self.forward();
    }

    /// Changes the numerics. What the lesson states itself is left alone: `mentioned` says that it states the
    /// timestep.
    pub fn perturb(&mut self, numerics: StepVariant, mentioned: bool) {
        let opt = self.world.model.edit().opt;
        if !mentioned {
            *opt.timestep *= numerics.timestep;
        }
        if let Some(other) =
            numerics.integrator.filter(|_| *opt.integrator == labspec_core::integrator::EULER)
        {
            *opt.integrator = other;
        }
        if numerics.tight {
            (*opt.tolerance, *opt.ls_tolerance) = (0.0, 1e-10);
            (*opt.iterations, *opt.ls_iterations) = (200, 100);
        }
        if numerics.perturbation != 0.0 {
            self.world.data.edit().qpos.iter_mut().for_each(|q| *q += numerics.perturbation);
            self.forward();
        }
    }

    /// Computes everything from the state at hand: after a step, forces and what follows from them are still those of the state
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

    /// Stores the value of a control and does what it says.
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
        let behind = |c: &Option<Coupled>| c.as_ref().and_then(|c| c.behind(program, text));
        let corrected = behind(&self.programs.coupled);
        let observed = if self.left_behind { None } else { behind(&self.programs.observed) };
        let before = (corrected.is_some() || observed.is_some()).then(|| self.world.model.clone());
        let result = program.run(&mut self.world, &mut self.context, value);
        let good = result.is_ok();
        if let Err(e) = result {
            self.threw(e, text, time);
        }
        if let (Some(pairs), Some(before)) = (observed, &before) {
            self.left_behind = coupled::left_behind(pairs, before, &self.world.model);
        }
        if let (Some(pairs), Some(before), Some(follower)) = (corrected, &before, &self.programs.coupled) {
            let done = follower.follow(pairs, before, program, &mut self.world);
            self.refused(done);
        }
        if !self.settle(time) {
            return good;
        }
        // Reading past the end gives `undefined`, which a lesson may mean; a lost store it cannot.
        let broken = self.context.events().iter().find_map(|e| Some((e.rule()?, *e)));
        if let Some((rule, event)) = broken {
            self.note(rule, text, event.span.start..event.span.end, event.to_string());
        }
        self.note_warnings();
        good
    }

    fn note(&mut self, rule: &'static Rule, text: &Text, span: std::ops::Range<usize>, message: String) {
        let known = |t: &Trouble| t.rule == rule && t.span == span && t.text == *text;
        if !self.troubles.iter().any(known) {
            let time = self.world.data.time();
            self.troubles.push(Trouble { rule, text: text.clone(), span, message, time });
        }
    }

    /// Keeps warnings over resets of the data: the engine's own counters start again.
    fn note_warnings(&mut self) {
        // Asked after every step, and nearly always none.
        if self.world.data.fields().warning.iter().map(|w| w.number).sum::<usize>() == 0 {
            return;
        }
        for (kept, now) in self.warnings.iter_mut().zip(&self.world.data.fields().warning) {
            if now.number > 0 && kept.number == 0 {
                *kept = *now;
            }
            kept.number = kept.number.max(now.number);
        }
    }
}
