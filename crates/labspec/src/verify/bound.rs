//! A `verify` object bound to its labs and models, ready to run.

use super::bound_run::{BoundRun, BoundScene, CompiledText};
use super::compiled_claim::{CompiledClaim, reads_run};
use super::layout::{NumberLayout, Slot};
use super::list_measure::{self, ArrayLanguage};
use super::measure::Sampled;
use super::measure_units::MeasureUnits;
use super::nested_final::nested_finals;
use super::outcome::{MeasuredRun, MeasuredRuns, SweepMember};
use super::reads;
use super::run_cache::{BoundLab, RunCache};
use super::run_result::RunResult;
use super::runner::{self, RunRequest};
use super::value_kind::{ValueKind, kind_of};
use crate::bind::{ModelNames, Scope, to_finding};
use crate::finding::Finding;
use crate::rules;
use crate::run::{self, Session, Start, StepVariant};
use crate::source::Text;
use crate::spec::{BreakExpectation, Run, Verify};
use labspec_core::reflect::option;
use labspec_core::{AccessSet, Model, Plan};
use labspec_expr::{Compiled, Compiler, Value};
use std::borrow::Cow;
use std::cell::{OnceCell, RefCell};
use std::collections::{BTreeMap, BTreeSet};
use std::rc::Rc;

/// The labs, runs and measures of a `verify` object.
#[derive(Debug)]
pub struct BoundVerify<'a> {
    /// The lab of the object, or else the lab of its first run, comes first.
    pub(super) scenes: Vec<BoundScene<'a>>,
    pub(super) runs: Vec<BoundRun<'a>>,
    pub(super) verify: &'a Verify,
    pub(super) stage: &'a RunCache<'a>,
    /// Each lab in its initial state, for expressions over measures (which read nothing of it) and for imagined runs.
    idle: RefCell<BTreeMap<usize, Session<'a>>>,
    /// For each run, the first run that is the same simulation, computed on first use.
    pub(super) same_runs: OnceCell<Vec<usize>>,
    /// The units of the measures, computed on first use.
    pub(super) units: OnceCell<Option<MeasureUnits>>,
    /// The positions of all numbers, and the kind of each.
    layout: NumberLayout,
    /// The measures, as pairs of lab and measure, that depend on variables of `ctx` which the lab computes from the simulation.
    simulated_ctx: BTreeSet<(usize, usize)>,
    kinds: OnceCell<Vec<ValueKind>>,
    /// Compiled claims by their texts.
    pub(super) claims: RefCell<BTreeMap<String, Rc<CompiledClaim>>>,
}

/// The language of the measures of one lab.
struct ArrayOfLab<'b, 'a> {
    bound: &'b mut BoundVerify<'a>,
    place: usize,
}

impl ArrayLanguage for ArrayOfLab<'_, '_> {
    fn compile(&mut self, text: &Text) -> Option<Compiled> {
        self.bound.compile_measure(self.place, text)
    }

    fn number(&mut self, text: &Text) -> Option<f64> {
        let program = self.compile(text)?.program?;
        let value = self.bound.idle_in(self.place, |session| session.evaluate(&program, text))??;
        Some(value.to_number())
    }
}

impl<'a> BoundVerify<'a> {
    /// Compiles the runs and the measures. `scenes` contains the labs of every run, one for each member of a sweep. `base`
    /// is the lab of the object itself, if it has one. Errors are added to `findings`; returns `None` when the object
    /// cannot run.
    pub fn new(
        verify: &'a Verify,
        base: Option<&BoundLab<'a>>,
        scenes: &[Vec<BoundLab<'a>>],
        stage: &'a RunCache<'a>,
        findings: &mut Vec<Finding>,
    ) -> Option<BoundVerify<'a>> {
        let mut bound = BoundVerify {
            scenes: Vec::new(),
            runs: Vec::new(),
            verify,
            stage,
            idle: RefCell::default(),
            same_runs: OnceCell::new(),
            units: OnceCell::new(),
            layout: NumberLayout::default(),
            simulated_ctx: BTreeSet::new(),
            kinds: OnceCell::new(),
            claims: RefCell::default(),
        };
        if verify.runs.is_empty() {
            let scene = bound.add(base?);
            bound.runs.push(BoundRun::new("run", None, scene));
        }
        let mut good = true;
        for (run, scenes) in verify.runs.iter().zip(scenes) {
            good &= bound.add_runs(run, scenes, findings);
        }
        // Closed forms belong to the lab of the object.
        if !verify.exact.is_empty() {
            let first = bound.add(base?);
            bound.put_first(first);
        }
        for (name, text) in &verify.measure {
            good &= bound.measure(&name.value, text, findings);
        }
        bound.compute_layout();
        bound.simulated_ctx = bound.find_simulated_ctx();
        good.then_some(bound)
    }

    /// Binds the members of a run, one for each of its labs; `false` when one has errors.
    fn add_runs(&mut self, run: &'a Run, scenes: &[BoundLab<'a>], findings: &mut Vec<Finding>) -> bool {
        for (i, scene) in scenes.iter().enumerate() {
            let lab = self.add(scene);
            let Some(made) = self.run(run, lab, findings) else { return false };
            self.runs.push(match &run.sweep {
                None => made,
                Some(sweep) => {
                    let (mut controls, mut values) = (Vec::new(), Vec::new());
                    for (axis, value) in sweep.values(i) {
                        let control = scene.lab.control(&axis.what.value);
                        let value = run::swept_value(control, axis, value);
                        values.push(match value {
                            Value::Number(x) => x,
                            // Texts are numbered in their order.
                            _ => axis
                                .values
                                .iter()
                                .position(|v| v.to_string() == value.to_string())
                                .map_or(f64::NAN, |i| i as f64),
                        });
                        if control.is_some() {
                            controls.push((&axis.what, value));
                        }
                    }
                    let swept = sweep.is_list().then_some(SweepMember { index: i, values });
                    BoundRun { swept, controls, ..made }
                }
            });
        }
        true
    }

    /// Moves the lab at index `place` to the front of the list.
    fn put_first(&mut self, place: usize) {
        self.scenes.swap(0, place);
        for run in &mut self.runs {
            run.scene = match run.scene {
                0 => place,
                i if i == place => 0,
                i => i,
            };
        }
    }

    fn compute_layout(&mut self) {
        let names = |run: &BoundRun<'_>| {
            let measures = self.scene_of(run).into_iter().flat_map(|s| &s.measures);
            measures.map(|(name, _)| name.to_string()).collect()
        };
        let bare = |run: &BoundRun<'_>| (run.name.to_string(), run.swept.clone(), names(run));
        let runs: Vec<_> = self.runs.iter().map(bare).collect();
        self.layout = NumberLayout::from_runs(&runs, self.verify.find.iter().map(|f| f.name.value.clone()));
    }

    /// The positions of the numbers that claims read.
    pub(super) fn layout(&self) -> &NumberLayout {
        &self.layout
    }

    /// Whether a measure reads the simulation.
    pub(super) fn is_simulated(&self, run: usize, measure: usize) -> bool {
        let stops = self.runs.get(run).is_some_and(|run| run.stop.is_some());
        let scene = self.runs.get(run).map_or(0, |run| run.scene);
        self.measure_at(run, measure).is_some_and(|m| reads_run(&m.program, stops))
            || self.simulated_ctx.contains(&(scene, measure))
    }

    fn find_simulated_ctx(&self) -> BTreeSet<(usize, usize)> {
        let measures = self.scenes.iter().enumerate().flat_map(|(place, scene)| {
            scene.measures.iter().enumerate().map(move |(i, (_, measure))| (place, i, measure))
        });
        let simulated =
            measures.filter(|(place, _, m)| self.depends_on_simulated_ctx(*place, &m.program, &m.text));
        simulated.map(|(place, i, _)| (place, i)).collect()
    }

    pub(super) fn measure_at(&self, run: usize, measure: usize) -> Option<&CompiledText<'a>> {
        let (_, named) = self.scene_of(self.runs.get(run)?)?.measures.get(measure)?;
        Some(named)
    }

    /// The kind of each number.
    pub(super) fn kinds(&self) -> &[ValueKind] {
        self.kinds.get_or_init(|| {
            let mut cached: BTreeMap<(usize, &str), ValueKind> = BTreeMap::new();
            let mut measure = |run: usize, m: usize| {
                let (named, scene) = (self.measure_at(run, m)?, self.runs.get(run)?.scene);
                let kind = |session: &mut Session<'a>| kind_of(named, &session.world, &mut session.context);
                let place = (scene, named.text.as_str());
                if let Some(cached) = cached.get(&place) {
                    return Some(*cached);
                }
                let kind = self.idle_in(scene, kind)?;
                cached.insert(place, kind);
                Some(kind)
            };
            let mut one = |slot: &Slot| match *slot {
                Slot::Measure(run, m) => measure(run, m).unwrap_or(ValueKind::ANY),
                Slot::Warnings(_) => ValueKind::COUNT,
                _ => ValueKind::ANY,
            };
            self.layout.slots.iter().map(&mut one).collect()
        })
    }

    /// Names and texts of the measures.
    pub(super) fn measure_texts(&self) -> impl Iterator<Item = (&str, &str)> {
        let measures = self.scenes.iter().flat_map(|scene| &scene.measures);
        measures.map(|(name, measure)| (name.as_ref(), measure.text.as_str()))
    }

    /// The text of a measure by its name.
    pub(super) fn text_of_measure(&self, name: &str) -> Option<String> {
        self.measure_texts().find(|(other, _)| *other == name).map(|(_, text)| text.to_string())
    }

    /// Calls `work` with the first lab in its initial state, for expressions over measures: they read nothing of its data.
    pub(super) fn idle<T>(&self, work: impl FnOnce(&mut Session<'a>) -> T) -> Option<T> {
        self.idle_in(0, work)
    }

    /// Like [`BoundVerify::idle`], with the lab at an index of the list.
    pub(super) fn idle_in<T>(&self, place: usize, work: impl FnOnce(&mut Session<'a>) -> T) -> Option<T> {
        let scene = &self.scenes.get(place)?.scene;
        let mut idle = self.idle.borrow_mut();
        let session = || {
            let plan = Some(Plan::new(&scene.model, &AccessSet::ANY));
            Session::start(scene.programs.clone(), &scene.model, Start { plan, ..Start::default() })
        };
        Some(work(idle.entry(place).or_insert_with(session)))
    }

    /// The index of a lab in the list; the lab is added on first use.
    fn add(&mut self, scene: &BoundLab<'a>) -> usize {
        if let Some(existing) = self.scenes.iter().position(|s| s.scene.is(scene)) {
            return existing;
        }
        let (globals, displayed) = (scene.programs.globals.clone(), reads::labels(&scene.lab));
        self.scenes.push(BoundScene { scene: scene.clone(), globals, measures: Vec::new(), displayed });
        self.scenes.len() - 1
    }

    /// Compiles the texts of a run; `None` when they have errors.
    fn run(&mut self, run: &'a Run, scene: usize, findings: &mut Vec<Finding>) -> Option<BoundRun<'a>> {
        let BoundScene { scene: here, globals, displayed, .. } = self.scenes.get_mut(scene)?;
        let names =
            |scope| ModelNames::new(&here.model, scope).with(&here.programs.functions).showing(displayed);
        let mut good = true;
        let mut keep = |text: &'a Text, compiled: Compiled| {
            findings.extend(compiled.diagnostics.iter().map(|d| to_finding(d, text)));
            good &= compiled.program.is_some();
            compiled.program.map(|program| CompiledText { text: Cow::Borrowed(text), program })
        };
        let setup = run.setup.as_ref();
        let setup = setup
            .and_then(|t| keep(t, Compiler::new(&names(Scope::Lab), globals).linting().statements(&t.value)));
        let stop = run.stop.as_ref();
        let stop = stop.and_then(|t| {
            keep(t, Compiler::new(&names(Scope::Measure), globals).linting().expression(&t.value))
        });
        if let Some(stop) = stop.as_ref().filter(|stop| !stop.program.aggregates().is_empty()) {
            findings.push(
                Finding::error(rules::RUN_IMPOSSIBLE, stop.text.span(), "`stop` must look at one sample, not at a whole run")
                    .why("a value over all samples is known only after the run")
                    .help("write the condition itself: `contact('ball', 'floor')`, not `first(contact('ball', 'floor'))`"),
            );
            good = false;
        }
        good.then_some(BoundRun { setup, stop, ..BoundRun::new(&run.name.value, Some(run), scene) })
    }

    /// Compiles a measure for every lab. A lab for which it does not compile does not get the measure. If it compiles for
    /// no lab, the diagnostics of the first lab are reported.
    fn measure(&mut self, name: &'a str, text: &'a Text, findings: &mut Vec<Finding>) -> bool {
        let mut reported: Option<Vec<Finding>> = None;
        let mut has_meaning = false;
        for place in 0..self.scenes.len() {
            let Some(compiled) = self.compile_measure(place, text) else { continue };
            let has_room =
                self.scenes.get(place).is_some_and(|s| s.measures.len() < list_measure::MAX_OF_OBJECT);
            let elements = match &compiled.program {
                None if has_room => list_measure::elements(text, &mut ArrayOfLab { bound: self, place }),
                _ => None,
            };
            let mut all: Vec<(Cow<'a, str>, Cow<'a, Text>, Compiled)> = Vec::new();
            match elements {
                None => all.push((Cow::Borrowed(name), Cow::Borrowed(text), compiled)),
                Some(elements) => all.extend(elements.into_iter().enumerate().filter_map(|(i, text)| {
                    let compiled = self.compile_measure(place, &text)?;
                    Some((Cow::Owned(list_measure::element_name(name, i)), Cow::Owned(text), compiled))
                })),
            }
            let nested: Vec<Finding> = all
                .first()
                .and_then(|(_, text, compiled)| Some(nested_finals(compiled.program.as_ref()?, text)))
                .unwrap_or_default();
            let compiles = nested.is_empty() && all.iter().all(|(.., compiled)| compiled.program.is_some());
            if reported.is_none() || (!has_meaning && compiles) {
                let first = all
                    .first()
                    .into_iter()
                    .flat_map(|(_, text, compiled)| compiled.diagnostics.iter().map(|d| to_finding(d, text)));
                reported = Some(first.chain(nested).collect());
            }
            has_meaning |= compiles;
            let Some(scene) = self.scenes.get_mut(place).filter(|_| compiles) else { continue };
            scene.measures.extend(all.into_iter().filter_map(|(name, text, compiled)| {
                compiled.program.map(|program| (name, CompiledText { text, program }))
            }));
        }
        findings.extend(reported.into_iter().flatten());
        has_meaning
    }

    /// Compiles an expression over the samples of the runs of a lab.
    fn compile_measure(&mut self, place: usize, text: &Text) -> Option<Compiled> {
        let bound = self.scenes.get_mut(place)?;
        let mut globals = bound.globals.clone();
        let compiled =
            Compiler::new(&bound.names(Scope::Measure), &mut globals).linting().expression(&text.value);
        bound.globals = globals;
        Some(compiled)
    }

    /// The labs of every run, in the form that [`BoundVerify::new`] takes.
    pub(super) fn labs(&self) -> Vec<Vec<BoundLab<'a>>> {
        let labs_of_run = |run: &'a Run| {
            let members = self.runs.iter().filter(|b| b.spec.is_some_and(|spec| std::ptr::eq(spec, run)));
            members.filter_map(|b| self.scene_of(b).map(|s| s.scene.clone())).collect()
        };
        self.verify.runs.iter().map(labs_of_run).collect()
    }

    /// The cache that the `verify` objects of the lesson share.
    pub(super) fn stage(&self) -> &'a RunCache<'a> {
        self.stage
    }

    /// The lab in which expressions over measures are evaluated.
    pub(super) fn base(&self) -> Option<&BoundScene<'a>> {
        self.scenes.first()
    }

    /// The lab of the object with its model and programs.
    pub(super) fn lab(&self) -> Option<&BoundLab<'a>> {
        self.scenes.first().map(|s| &s.scene)
    }

    pub(super) fn scene_of(&self, run: &BoundRun<'_>) -> Option<&BoundScene<'a>> {
        self.scenes.get(run.scene)
    }

    /// Sets a control to a value for all runs. The value need not be one that a student can choose.
    pub(super) fn set_freely(&mut self, control: &'a Text, x: f64) {
        for run in &mut self.runs {
            (run.controls, run.freely) = (vec![(control, Value::Number(x))], true);
        }
    }

    /// Executes every run and evaluates every measure, without searches. `None` when a run cannot be executed.
    pub(super) fn outcome_of_runs(
        &self,
        numerics: StepVariant,
        findings: &mut Vec<Finding>,
    ) -> Option<MeasuredRuns> {
        let mut runs = Vec::new();
        for run in &self.runs {
            let scene = self.scene_of(run)?;
            let measures: Vec<&CompiledText<'_>> = scene.measures.iter().map(|(_, m)| m).collect();
            let made = self.execute_run(run, numerics, &measures, findings)?;
            let names = scene.measures.iter().map(|(name, _)| name.to_string());
            let mut without_value = Vec::new();
            let mut at_start = Vec::new();
            let mut measures = Vec::new();
            for (name, Sampled { value, no_value, at_start: event, .. }) in names.zip(made.values) {
                without_value.extend(no_value.map(|no_value| (name.clone(), no_value)));
                at_start.extend(event.map(|event| (name.clone(), event)));
                measures.push((name, value));
            }
            runs.push(MeasuredRun {
                name: run.name.to_string(),
                swept: run.swept.clone(),
                measures,
                without_value,
                at_start,
                end: made.end,
                warnings: made.warnings,
                broke: made.broke,
            });
        }
        Some(MeasuredRuns {
            runs,
            found: Vec::new(),
            other_ends: Vec::new(),
            looked: Vec::new(),
            numerics,
            elsewhere: Vec::new(),
        })
    }

    pub(super) fn execute_run(
        &self,
        run: &BoundRun<'a>,
        numerics: StepVariant,
        measures: &[&CompiledText<'_>],
        findings: &mut Vec<Finding>,
    ) -> Option<RunResult> {
        let place = run.spec.map_or(self.verify.span.clone(), |r| r.name.span());
        let request = RunRequest { scene: self.scene_of(run)?, run, numerics, measures, place };
        runner::execute_run(&request, self.stage, findings)
    }

    /// The span of a run in the lesson, and whether the lesson declares that it breaks.
    pub(super) fn run_place(&self, index: usize) -> (std::ops::Range<usize>, BreakExpectation) {
        let spec = self.runs.get(index).and_then(|r| r.spec);
        let span = spec.map_or(self.verify.span.clone(), |r| r.name.span());
        (span, spec.map_or(BreakExpectation::None, |r| r.expect))
    }

    /// The name of the first sweep whose numbers a text reads.
    pub(super) fn run_of_list(&self, text: &Text) -> Option<&'a str> {
        let claim = self.claim(text)?;
        let mut slots = claim.reads.iter().filter_map(|place| self.layout.slots.get(*place));
        slots.find_map(|slot| {
            let (Slot::Measure(run, _) | Slot::Warnings(run) | Slot::Swept(run, _)) = *slot else {
                return None;
            };
            self.runs.get(run).filter(|run| run.swept.is_some()).map(|run| run.name)
        })
    }

    /// Whether a claim of the object reads how often the engine warned in a run: it decides itself what a break means.
    pub(super) fn reads_warnings(&self, index: usize) -> bool {
        let reads = |text: &Text| {
            let claim = self.claim(text)?;
            let slots = claim.reads.iter().filter_map(|place| self.layout.slots.get(*place));
            Some(slots.into_iter().any(|slot| *slot == Slot::Warnings(index)))
        };
        let verify = self.verify;
        let mut claims = verify.options.iter().chain(&verify.value).chain(verify.quoted());
        claims.any(|text| reads(text) == Some(true))
    }

    /// Whether every run sets its own timestep, so that a halved timestep adds no information.
    pub(super) fn states_every_timestep(&self) -> bool {
        let states =
            |run: &BoundRun<'_>| self.scene_of(run).is_some_and(|s| runner::states(s, run, option::timestep));
        self.runs.iter().all(states)
    }

    /// Every run with its lab, in the order of an outcome.
    pub(super) fn runs_with_scenes(&self) -> impl Iterator<Item = (&BoundRun<'a>, &BoundScene<'a>)> {
        self.runs.iter().filter_map(|run| Some((run, self.scene_of(run)?)))
    }

    /// The model of every run at its start, after the controls and the setup of the run. `None` for a run that cannot be
    /// started.
    pub(crate) fn started_models(&self) -> Vec<(String, Option<Model>)> {
        let begin = |run: &BoundRun<'_>| runner::started_models(self.scenes.get(run.scene)?, run);
        self.runs.iter().map(|run| (run.name.to_string(), begin(run))).collect()
    }
}
