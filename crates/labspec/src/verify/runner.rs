//! Executes one run of a `verify` object: the events of its lab in order, then its own controls and setup, and its
//! measures.

use super::bound_run::{BoundRun, BoundScene, CompiledText};
use super::measure::Measure;
use super::numerics::TIGHT_SOLVER;
use super::reads;
use super::run_cache::RunCache;
use super::run_result::RunResult;
use crate::bind::{include, scalar};
use crate::finding::Finding;
use crate::json::read::named;
use crate::rules;
use crate::run::{self, Budget, End, Play, RunError, Session, Start, StepVariant, StopTime};
use crate::spec::{Control, ControlKind};
use labspec_core::reflect::{FieldId, option};
use labspec_core::{AccessSet, Model, Plan, integrator};
use labspec_expr::{Effects, Program, Value, Watch};
use std::collections::BTreeMap;
use std::ops::{ControlFlow, Range};

/// Maximum number of steps of one run of a `verify` object.
const MAX_VERIFY_STEPS: usize = 2_000_000;

/// A requested run: its step variant and its measures.
pub(super) struct RunRequest<'r, 'a> {
    pub(super) scene: &'r BoundScene<'a>,
    pub(super) run: &'r BoundRun<'a>,
    pub(super) numerics: StepVariant,
    pub(super) measures: &'r [&'r CompiledText<'r>],
    /// The span for findings about the run.
    pub(super) place: Range<usize>,
}

/// Executes a run. A result in the cache is reused; its findings were reported before.
pub(super) fn execute_run(
    request: &RunRequest<'_, '_>,
    stage: &RunCache<'_>,
    findings: &mut Vec<Finding>,
) -> Option<RunResult> {
    // A step variant does not override what the lesson sets. A run that sets its timestep is about numerics.
    let (timestep, integrator) = (
        states(request.scene, request.run, option::timestep),
        states(request.scene, request.run, option::integrator),
    );
    let StepVariant { timestep: shorter, integrator: other, .. } = request.numerics;
    let numerics = StepVariant {
        timestep: if timestep { 1.0 } else { shorter },
        integrator: other.filter(|_| !timestep && !integrator),
        ..request.numerics
    };
    let request = &RunRequest { numerics, place: request.place.clone(), ..*request };
    // Without constraints, the solver has nothing to do: the result is that of the nominal run.
    if numerics == TIGHT_SOLVER {
        let nominal = RunRequest { numerics: StepVariant::NOMINAL, place: request.place.clone(), ..*request };
        if let Some(made) = stage.cached_run(&key(&nominal)).filter(|made| !made.solved) {
            return Some(made);
        }
    }
    let key = key(request);
    if let Some(cached) = stage.cached_run(&key) {
        stage.note(cached.has_uncoupled_change);
        return Some(cached);
    }
    let made = make(request, stage, findings)?;
    stage.note(made.has_uncoupled_change);
    stage.keep(key, &made);
    Some(made)
}

/// The cache key: a text of everything that the result of a run depends on.
fn key(request: &RunRequest<'_, '_>) -> String {
    let RunRequest { scene, run, numerics, measures, .. } = request;
    let texts: Vec<&str> = measures.iter().map(|m| m.text.as_str()).collect();
    let set: Option<Vec<_>> =
        run.spec.map(|spec| spec.set.iter().map(|(label, v)| (label.as_str(), scalar(v))).collect());
    // A search sets controls of the only run of an object without `runs`, too.
    let controls: Vec<_> = run.controls.iter().map(|(label, x)| (label.as_str(), x)).collect();
    format!("{} {} {set:?} {controls:?} {numerics:?} {texts:?}", key_of_programs(scene, run), length_key(run))
}

/// The part of a key that is independent of controls, numerics, measures and the length of the run.
fn key_of_programs(scene: &BoundScene<'_>, run: &BoundRun<'_>) -> String {
    let lab = &scene.scene.lab;
    let of_run = run.spec.map(|spec| {
        let press: Vec<_> = spec.press.iter().map(|(label, t)| (label.as_str(), t.value)).collect();
        format!("{press:?} {:?}", spec.setup.as_ref().map(|t| t.as_str()))
    });
    format!("{:?} {} {:?} {:?} {of_run:?}", lab.span, scene.scene.model.identity(), lab.key, lab.controller)
}

/// A text of the length that a run sets.
pub(super) fn length_key(run: &BoundRun<'_>) -> String {
    let of_run = run.spec.map(|spec| {
        let length = [&spec.until, &spec.steps].map(|n| n.as_ref().map(|n| n.value));
        format!("{length:?} {:?}", spec.stop.as_ref().map(|t| t.as_str()))
    });
    format!("{of_run:?}")
}

/// A text of the settings of a run without its length, equal for runs with the same settings: a control that a run does not set has its
/// start value.
pub(super) fn settings_key(scene: &BoundScene<'_>, run: &BoundRun<'_>) -> String {
    let start = |control: &Control| match &control.kind {
        ControlKind::Slider { value, .. } => Some(Value::Number(value.value)),
        ControlKind::Select { value, .. } => Some(scalar(value)),
        ControlKind::Button { .. } => None,
    };
    let controls = &scene.scene.lab.controls;
    let mut values: BTreeMap<&str, Value> =
        controls.iter().filter_map(|control| Some((control.label.as_str(), start(control)?))).collect();
    values.extend(run.spec.iter().flat_map(|spec| &spec.set).map(|(label, v)| (label.as_str(), scalar(v))));
    format!("{} {values:?}", key_of_programs(scene, run))
}

/// A run after its setup, and the data for playing it.
pub(super) struct PreparedRun<'r> {
    pub(super) session: Session<'r>,
    /// Buttons by index, and the times at which they are pressed, s.
    pub(super) press: Vec<(usize, f64)>,
    /// Number of steps.
    pub(super) count: usize,
    /// The `stopAt` of the lab, if the run does not have a length of its own.
    stop: Option<StopTime>,
    /// Why the end of the run is undecided, if it is: `stop` was decided by a NaN, or the run never reaches its `stopAt`.
    pub(super) open: Option<String>,
}

/// Sets up a run: its controls, its setup, its length. Errors are added to `findings`.
pub(super) fn prepare_run<'r>(
    request: &RunRequest<'r, '_>,
    stage: &RunCache<'_>,
    findings: &mut Vec<Finding>,
) -> Option<PreparedRun<'r>> {
    let RunRequest { scene: bound, run, numerics, place, .. } = request;
    let (lab, programs) = (&*bound.scene.lab, &*bound.scene.programs);
    let plan = Some(Plan::new(&bound.scene.model, &access(request)));
    let start = Start { key: lab.keyframe(), plan, budget: Budget { left: stage.left() } };
    let mut session = Session::start(bound.scene.programs.clone(), &bound.scene.model, start);
    let mut refuse_at = |place: Range<usize>, e: RunError| {
        let message = format!("the run {} cannot be executed: {}", named(run.name), e.message);
        let finding = Finding::error(rules::RUN_IMPOSSIBLE, place, message);
        findings.push(match e.help {
            Some(help) => finding.help(help),
            None => finding,
        });
    };
    set(&mut session, bound, run).map_err(|(span, e)| refuse_at(span, e)).ok()?;
    let mut press = Vec::new();
    let (mut until, mut steps) = (None, None);
    if let Some(spec) = run.spec {
        let list: Vec<_> = spec.press.iter().map(|(label, t)| (label.value.clone(), t.value)).collect();
        press = run::presses(programs, &list).map_err(|e| refuse_at(place.clone(), e)).ok()?;
        until = spec.until.as_ref().map(|n| n.value);
        // The same duration at any timestep.
        steps = spec.steps.as_ref().map(|n| (n.value.max(0.0) / numerics.timestep).round() as usize);
    }
    if let Some(setup) = &run.setup {
        session.run_statements(&setup.program, &setup.text);
    }
    session.perturb(*numerics, false);
    let mut refuse = |e: RunError| refuse_at(place.clone(), e);
    let timestep = session.world.model.opt.timestep;
    let count = run::count_steps(lab, until, steps, timestep).map_err(&mut refuse).ok()?;
    run::presses_within(programs, &press, count, timestep).map_err(&mut refuse).ok()?;
    // A shorter timestep takes more steps. The work is limited separately.
    if count as f64 * numerics.timestep > MAX_VERIFY_STEPS as f64 {
        refuse(RunError::new(format!(
            "it takes {count} steps, but a verified run may take at most {MAX_VERIFY_STEPS}"
        )));
        return None;
    }
    let stop = run::stop_time(lab, until, steps, count)
        .map(|stop| StopTime { most: stop.most.min(MAX_VERIFY_STEPS).max(count), ..stop });
    Some(PreparedRun { session, press, count, stop, open: None })
}

/// Plays a run to its end. `sample` is called at the start and after every step, with the number of steps made.
pub(super) fn play<'r>(
    request: &RunRequest<'r, '_>,
    ready: &mut PreparedRun<'r>,
    mut sample: impl FnMut(&mut Session<'_>, usize),
) {
    let RunRequest { scene: bound, run, .. } = request;
    let (lab, programs, displayed) =
        (&*bound.scene.lab, &*bound.scene.programs, bound.displayed.used_labels());
    let played =
        Play { steps: ready.count, stop: ready.stop, every: 1, presses: &ready.press, watched: true };
    let mut watch = Some(Box::new(Watch::losses()));
    let mut open = None;
    let made = run::play(&mut ready.session, &played, |session, made| {
        reads::show(&displayed, lab, programs, session);
        sample(session, made);
        let Some(stop) = run.stop.as_ref() else { return ControlFlow::Continue(()) };
        session.context.watch(watch.take());
        let holds = session.evaluate(&stop.program, &stop.text);
        watch = session.context.watch(None);
        let nan =
            matches!(holds, Some(Value::Undefined)) || matches!(holds, Some(Value::Number(x)) if x.is_nan());
        if nan || watch.as_ref().is_some_and(|watch| watch.lost.is_some()) {
            open = Some(undecided_stop(session.world.data.time()));
            return ControlFlow::Break(());
        }
        if holds.is_some_and(|holds| holds.truthy()) {
            ControlFlow::Break(())
        } else {
            ControlFlow::Continue(())
        }
    });
    ready.open = open.or_else(|| run::describe_unreached(&played, &ready.session, made));
}

fn make(
    request: &RunRequest<'_, '_>,
    stage: &RunCache<'_>,
    findings: &mut Vec<Finding>,
) -> Option<RunResult> {
    let RunRequest { run, measures, .. } = request;
    let mut ready = prepare_run(request, stage, findings)?;
    let mut running: Vec<Measure<'_>> = measures.iter().map(|m| Measure::new(&m.program, &m.text)).collect();
    let mut solved = false;
    play(request, &mut ready, |session, _| {
        running.iter_mut().for_each(|m| m.sample(session));
        // A step of RK4 solves at several states, of which the data keep one.
        let world = &session.world;
        solved |= world.data.fields().nefc > 0 || world.model.opt.integrator == integrator::RK4;
    });
    let open = ready.open;
    let mut session = ready.session;
    stage.spend(session.spent());
    let values = running.into_iter().map(|m| m.finish(&mut session)).collect();
    for t in &session.program_errors {
        let message = format!("{} (in the run {}, at t = {} s)", t.message, named(run.name), t.time);
        findings.push(Finding::error(t.rule, t.text.span_of(t.span.clone()), message));
    }
    Some(RunResult {
        values,
        end: session.world.data.time(),
        warnings: session.warnings.iter().map(|w| w.number).sum(),
        solved,
        broke: describe_breakdown(&session).or(open),
        has_uncoupled_change: session.has_uncoupled_change() || request.scene.scene.has_uncoupled_change,
    })
}

/// Sets the controls of a run. An error is returned with its span.
fn set(
    session: &mut Session<'_>,
    bound: &BoundScene<'_>,
    run: &BoundRun<'_>,
) -> Result<(), (Range<usize>, RunError)> {
    let (lab, programs) = (&*bound.scene.lab, &*bound.scene.programs);
    // A control of the lab may have set the timestep while the lab was loaded; the modification of the run takes
    // precedence.
    if bound.scene.patches.iter().any(|(patch, _)| is_timestep(&patch.path)) {
        *session.world.model.edit().opt.timestep = bound.scene.model.opt.timestep;
    }
    for (label, v) in run.spec.iter().flat_map(|spec| &spec.set) {
        let is_control = lab.control(&label.value).is_some();
        let span = if is_control { v.span() } else { label.span() };
        let one = [(label.value.clone(), scalar(v))];
        run::set_controls(session, lab, programs, &one).map_err(|e| (span, e))?;
    }
    for (label, value) in &run.controls {
        match programs.control(&label.value).filter(|_| run.freely) {
            Some((i, _)) => session.set_control(i, value.clone()),
            None => {
                let one = [(label.value.clone(), value.clone())];
                run::set_controls(session, lab, programs, &one).map_err(|e| (label.span(), e))?;
            }
        }
    }
    Ok(())
}

/// The model of a run at its start, after its controls and its setup. `None` for a run that cannot be started.
pub(super) fn started_models(bound: &BoundScene<'_>, run: &BoundRun<'_>) -> Option<Model> {
    Some(started_session(bound, run)?.world.model)
}

/// A run at its start, after its controls and its setup. `None` for a run that cannot be started.
pub(super) fn started_session<'r>(bound: &'r BoundScene<'_>, run: &BoundRun<'_>) -> Option<Session<'r>> {
    let scene = &bound.scene;
    let start = Start { budget: Budget::TRIAL, ..Start::of_lab(&scene.lab) };
    let mut session = Session::start(scene.programs.clone(), &scene.model, start);
    set(&mut session, bound, run).ok()?;
    if let Some(setup) = &run.setup {
        session.run_statements(&setup.program, &setup.text);
    }
    Some(session)
}

/// The fields that the programs of the lab and of the run read and write.
fn access(request: &RunRequest<'_, '_>) -> AccessSet {
    let mut access = request.scene.scene.programs.access;
    let texts_of_run = request.run.setup.iter().chain(&request.run.stop).map(|s| &s.program);
    for program in request.measures.iter().map(|m| &m.program).chain(texts_of_run) {
        include(program.effects(), &mut access);
        for arg in program.aggregates().iter().flat_map(|a| &a.args) {
            include(arg.effects(), &mut access);
        }
    }
    access
}

fn undecided_stop(time: f64) -> String {
    format!("its `stop` compares NaN at t = {} s", run::time(time))
}

/// How a run broke, in one clause.
fn describe_breakdown(session: &Session<'_>) -> Option<String> {
    match (run::worst_breakdown(session), session.program_errors.first()) {
        (Some(breakdown), _) => Some(breakdown.what),
        (None, Some(t)) => Some(format!("{}, at t = {} s", t.message, t.time)),
        (None, None) => session.ended().map(|end| match end {
            End::Threw => "an error froze it".to_string(),
            End::Interrupted => "it was interrupted".to_string(),
            End::Foreign => "its programs belong to another model".to_string(),
            End::Budget { time } => {
                format!("the work budget ran out, so this run ends at t = {} s", run::time(*time))
            }
        }),
    }
}

/// Whether the lesson itself sets an option of a run: in the run, or in the setup of the lab.
pub(super) fn states(scene: &BoundScene<'_>, run: &BoundRun<'_>, field: FieldId) -> bool {
    let option = field.info().name;
    let writes = |e: &Effects| e.writes.iter().any(|a| a.field.0 as usize == field.index());
    let programs = &scene.scene.programs;
    let set = run.spec.iter().flat_map(|r| &r.set).map(|(label, _)| label);
    let mut set = set.chain(run.controls.iter().map(|(label, _)| *label));
    let setups = run.setup.iter().map(|s| &s.program).chain(programs.setup.iter().map(|b| &b.program));
    set.any(|label| programs.effects_of(&label.value).is_some_and(writes))
        || setups.map(Program::effects).any(writes)
        || scene.scene.patches.iter().any(|(patch, _)| patch.path.split_whitespace().eq(["option", option]))
}

/// The path of the timestep among the attributes of a model.
pub(super) const TIMESTEP: &str = "option timestep";

/// Whether a path of the model is that of the timestep.
pub(super) fn is_timestep(path: &str) -> bool {
    path.split_whitespace().eq(TIMESTEP.split_whitespace())
}
