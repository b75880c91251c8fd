//! A `verify` object bound to its labs and models, ready to run.

use super::claim::{Claim, looks_over_run};
use super::curves::{self, Curves};
use super::evidence::{self, Kind};
use super::found;
use super::layout::{Layout, Slot};
use super::measure::Sampled;
use super::outcome::{Outcome, RunOutcome};
use super::reads;
use super::run_cache::{BoundLab, Stage};
use super::runner::{self, Asked};
use super::search::{self, SearchCase};
use super::units;
use crate::bind::{ModelNames, Scope, Shown, to_finding};
use crate::finding::Finding;
use crate::rules;
use crate::run::{Budget, Session, StepVariant};
use crate::source::Text;
use crate::spec::{Find, Run, Sweep, Verify};
use labspec_core::reflect::{FieldId, Object, option};
use labspec_core::{self as core, AccessSet, Model};
use labspec_expr::{Compiled, Compiler, Globals, Program, Value};
use std::cell::{OnceCell, RefCell};
use std::collections::{BTreeMap, BTreeSet};
use std::rc::Rc;

/// A program with the text that it came from.
#[derive(Debug)]
pub(super) struct Named<'a> {
    pub(super) text: &'a Text,
    pub(super) program: Program,
}

/// A lab with the measures that are taken in its runs.
#[derive(Debug)]
pub(super) struct BoundScene<'a> {
    pub(super) scene: BoundLab<'a>,
    pub(super) globals: Globals,
    pub(super) measures: Vec<(&'a str, Named<'a>)>,
    /// What it shows under labels, and which of them are asked for.
    pub(super) shown: Shown,
}

/// A run with its own texts compiled.
#[derive(Debug)]
pub(super) struct BoundRun<'a> {
    pub(super) name: &'a str,
    pub(super) spec: Option<&'a Run>,
    pub(super) setup: Option<Named<'a>>,
    pub(super) stop: Option<Named<'a>>,
    /// Its place in a sweep, and its value there; with the control that is set to it, where it is no attribute of the model.
    pub(super) swept: Option<(usize, f64)>,
    pub(super) control: Option<(&'a Text, f64)>,
    /// No student need be able to choose this value.
    pub(super) freely: bool,
    /// The place of its lab in the list.
    scene: usize,
}

/// The labs, the runs and the measures of a `verify` object.
#[derive(Debug)]
pub struct BoundVerify<'a> {
    /// The lab of the object, or else of its first run, comes first.
    scenes: Vec<BoundScene<'a>>,
    pub(super) runs: Vec<BoundRun<'a>>,
    verify: &'a Verify,
    stage: &'a Stage<'a>,
    /// Each lab at its start, for expressions over measures, which read nothing of it, and for imagined runs.
    idle: RefCell<BTreeMap<usize, Session<'a>>>,
    /// What the measures measure, once somebody has asked.
    units: OnceCell<Option<units::Known>>,
    /// The places of all numbers, and of which kind each is.
    layout: Layout,
    kinds: OnceCell<Vec<Kind>>,
    /// What was compiled, by its text.
    claims: RefCell<BTreeMap<String, Rc<Claim>>>,
}

impl BoundRun<'_> {
    /// The place of its lab in the list.
    pub(super) fn scene(&self) -> usize {
        self.scene
    }

    /// How conditions call it: `fall`, `fall[2]`.
    pub(super) fn title(&self) -> String {
        match self.swept {
            Some((i, _)) => format!("{}[{i}]", self.name),
            None => self.name.to_string(),
        }
    }
}

impl BoundScene<'_> {
    /// The names of a measure, or of what it is compared with.
    pub(super) fn names(&self, scope: Scope) -> ModelNames<'_> {
        ModelNames::new(&self.scene.model, scope).with(&self.scene.programs.functions).showing(&self.shown)
    }
}

impl<'a> BoundVerify<'a> {
    /// Compiles what runs do and what is measured. `scenes` has the lab of every run, one for each member of a sweep; the lab of
    /// the object itself, where there is one, is `base`. What is wrong goes to `findings`; `None` when it cannot run.
    pub fn new(
        verify: &'a Verify,
        base: Option<&BoundLab<'a>>,
        scenes: &[Vec<BoundLab<'a>>],
        stage: &'a Stage<'a>,
        findings: &mut Vec<Finding>,
    ) -> Option<BoundVerify<'a>> {
        let mut bound = BoundVerify {
            scenes: Vec::new(),
            runs: Vec::new(),
            verify,
            stage,
            idle: RefCell::default(),
            units: OnceCell::new(),
            layout: Layout::default(),
            kinds: OnceCell::new(),
            claims: RefCell::default(),
        };
        if verify.runs.is_empty() {
            let scene = bound.add(base?);
            bound.runs.push(BoundRun {
                name: "run",
                spec: None,
                setup: None,
                stop: None,
                swept: None,
                control: None,
                freely: false,
                scene,
            });
        }
        let mut good = true;
        for (run, scenes) in verify.runs.iter().zip(scenes) {
            for (i, scene) in scenes.iter().enumerate() {
                let at = bound.add(scene);
                let bound_run = bound.run(run, at, findings).map(|made| match &run.sweep {
                    None => made,
                    Some(Sweep { what, values }) => {
                        let x = values.get(i).copied().unwrap_or(f64::NAN);
                        let control = scene.lab.control(&what.value).map(|_| (what, x));
                        BoundRun { swept: Some((i, x)), control, ..made }
                    }
                });
                good &= bound_run.is_some();
                let failed = bound_run.is_none();
                bound.runs.extend(bound_run);
                if failed {
                    break;
                }
            }
        }
        // Closed forms are those of the object's own lab.
        if !verify.exact.is_empty() {
            let first = bound.add(base?);
            bound.scenes.swap(0, first);
            let swap = |i: usize| {
                if i == 0 {
                    first
                } else if i == first {
                    0
                } else {
                    i
                }
            };
            bound.runs.iter_mut().for_each(|run| run.scene = swap(run.scene));
        }
        for (name, text) in &verify.measure {
            good &= bound.measure(&name.value, text, findings);
        }
        bound.lay_out();
        good.then_some(bound)
    }

    fn lay_out(&mut self) {
        let names = |run: &BoundRun<'_>| {
            let measures = self.scene_of(run).into_iter().flat_map(|s| &s.measures);
            measures.map(|(name, _)| name.to_string()).collect()
        };
        let bare = |run: &BoundRun<'_>| (run.name.to_string(), run.swept, names(run));
        let runs: Vec<_> = self.runs.iter().map(bare).collect();
        self.layout = Layout::of(&runs, self.verify.find.iter().map(|f| f.name.value.clone()));
    }

    /// The places of the numbers that claims read.
    pub(super) fn layout(&self) -> &Layout {
        &self.layout
    }

    /// Whether a measure looks at a simulation.
    pub(super) fn is_simulated(&self, run: usize, measure: usize) -> bool {
        let stops = self.runs.get(run).is_some_and(|run| run.stop.is_some());
        self.measure_at(run, measure).is_some_and(|m| looks_over_run(&m.program, stops))
    }

    pub(super) fn measure_at(&self, run: usize, measure: usize) -> Option<&Named<'a>> {
        let (_, named) = self.scene_of(self.runs.get(run)?)?.measures.get(measure)?;
        Some(named)
    }

    /// Of which kind each number is.
    pub(super) fn kinds(&self) -> &[Kind] {
        self.kinds.get_or_init(|| {
            let mut known: BTreeMap<(usize, &str), Kind> = BTreeMap::new();
            let mut measure = |run: usize, m: usize| {
                let (named, scene) = (self.measure_at(run, m)?, self.runs.get(run)?.scene);
                let kind =
                    |session: &mut Session<'a>| evidence::kind_of(named, &session.world, &session.context);
                let place = (scene, named.text.as_str());
                if let Some(known) = known.get(&place) {
                    return Some(*known);
                }
                let kind = self.idle_in(scene, kind)?;
                known.insert(place, kind);
                Some(kind)
            };
            let mut one = |slot: &Slot| match *slot {
                Slot::Measure(run, m) => measure(run, m).unwrap_or(Kind::ANY),
                Slot::Warnings(_) => Kind::COUNT,
                _ => Kind::ANY,
            };
            self.layout.slots.iter().map(&mut one).collect()
        })
    }

    /// Works with a lab at its start, for expressions over measures: they read nothing of its data.
    pub(super) fn idle<T>(&self, work: impl FnOnce(&mut Session<'a>) -> T) -> Option<T> {
        self.idle_in(0, work)
    }

    /// The same with the lab at a place of the list.
    pub(super) fn idle_in<T>(&self, place: usize, work: impl FnOnce(&mut Session<'a>) -> T) -> Option<T> {
        let scene = &self.scenes.get(place)?.scene;
        let mut idle = self.idle.borrow_mut();
        let start = || Session::start(scene.programs.clone(), &scene.model, None, &AccessSet::ANY);
        Some(work(idle.entry(place).or_insert_with(start)))
    }

    /// The names of the runs that texts read; of one run that it is read on the spot.
    pub(super) fn runs_read(&self, texts: &[Text]) -> BTreeSet<&'a str> {
        let mut names = BTreeSet::new();
        for claim in texts.iter().filter_map(|text| self.claim(text)) {
            let slots = claim.reads.iter().filter_map(|place| self.layout.slots.get(*place));
            for slot in slots {
                if let Slot::Measure(run, _) | Slot::Warnings(run) = *slot {
                    names.extend(self.runs.get(run).map(|run| run.name));
                }
            }
            let own = claim.program.as_ref().is_some_and(|p| !p.aggregates().is_empty());
            names.extend(self.runs.first().filter(|_| own).map(|run| run.name));
        }
        names
    }

    /// The numbers that texts read of an outcome, by their bits.
    pub(super) fn read_by(&self, outcome: &Outcome, texts: &[Text]) -> Vec<u64> {
        let numbers = self.layout.numbers(outcome);
        let claims = texts.iter().filter_map(|text| self.claim(text));
        let places: BTreeSet<usize> = claims.flat_map(|claim| claim.reads.clone()).collect();
        places.iter().filter_map(|place| numbers.get(*place)).map(|x| x.to_bits()).collect()
    }

    /// Whether a control makes any difference to what the simulation computes: at its start, or in its first steps. Colours and
    /// views make none.
    pub(super) fn moves_anything(&self, label: &Text, from: f64, to: f64) -> bool {
        const STEPS: usize = 20;
        let Some(BoundLab { lab, model, programs, .. }) = self.lab() else { return false };
        let start = |x: f64| {
            let mut session = Session::start_within(
                programs.clone(),
                model,
                lab.keyframe(),
                &AccessSet::ANY,
                Budget::TRIAL,
            );
            let (i, _) = programs.control(&label.value)?;
            session.set_control(i, Value::Number(x));
            Some(session)
        };
        let (Some(mut a), Some(mut b)) = (start(from), start(to)) else { return false };
        let variables =
            programs.effects_of(&label.value).is_some_and(|e| !e.ctx_writes.is_empty() || e.any_ctx);
        let differs = |a: &Session<'_>, b: &Session<'_>, f: FieldId| {
            let count = core::length(&a.world.model, &a.world.data, f);
            let other = core::length(&b.world.model, &b.world.data, f);
            let bits =
                |s: &Session<'_>, i| core::element(&s.world.model, &s.world.data, f, i).map(f64::to_bits);
            count != other || (0..count).any(|i| bits(a, i) != bits(b, i))
        };
        let computed = |f: &FieldId| f.info().object == Object::Data || *f == option::timestep;
        let any = |a: &Session<'_>, b: &Session<'_>| {
            (0..).map_while(FieldId::new).filter(computed).any(|f| differs(a, b, f))
        };
        if variables || any(&a, &b) {
            return true;
        }
        for _ in 0..STEPS {
            a.step();
            b.step();
        }
        any(&a, &b)
    }

    /// Whether a text reads a value that is searched for.
    pub(super) fn reads_found(&self, text: &Text, index: usize) -> bool {
        let is = |place: &usize| self.layout.slots.get(*place) == Some(&Slot::Found(index));
        self.claim(text).is_some_and(|claim| claim.reads.iter().any(is))
    }

    /// An expression over the measures, compiled the first time that it is asked for.
    pub(super) fn claim(&self, text: &Text) -> Option<Rc<Claim>> {
        if let Some(known) = self.claims.borrow().get(&text.value) {
            return Some(known.clone());
        }
        let claim = Rc::new(Claim::of(self, &text.value)?);
        self.claims.borrow_mut().insert(text.value.clone(), claim.clone());
        Some(claim)
    }

    /// The place of a lab in the list, to which it is added the first time.
    fn add(&mut self, scene: &BoundLab<'a>) -> usize {
        if let Some(known) = self.scenes.iter().position(|s| s.scene.is(scene)) {
            return known;
        }
        let (globals, shown) = (scene.programs.globals.clone(), reads::labels(&scene.lab));
        self.scenes.push(BoundScene { scene: scene.clone(), globals, measures: Vec::new(), shown });
        self.scenes.len() - 1
    }

    /// Compiles the texts of a run; `None` when they have mistakes.
    fn run(&mut self, run: &'a Run, scene: usize, findings: &mut Vec<Finding>) -> Option<BoundRun<'a>> {
        let BoundScene { scene: here, globals, shown, .. } = self.scenes.get_mut(scene)?;
        let names = |scope| ModelNames::new(&here.model, scope).with(&here.programs.functions).showing(shown);
        let mut good = true;
        let mut keep = |text: &'a Text, compiled: Compiled| {
            findings.extend(compiled.diagnostics.iter().map(|d| to_finding(d, text)));
            good &= compiled.program.is_some();
            compiled.program.map(|program| Named { text, program })
        };
        let setup = run.setup.as_ref();
        let setup =
            setup.and_then(|t| keep(t, Compiler::new(&names(Scope::Lab), globals).statements(&t.value)));
        let stop = run.stop.as_ref();
        let stop =
            stop.and_then(|t| keep(t, Compiler::new(&names(Scope::Measure), globals).expression(&t.value)));
        if let Some(stop) = stop.as_ref().filter(|stop| !stop.program.aggregates().is_empty()) {
            findings.push(
                Finding::error(rules::RUN_IMPOSSIBLE, stop.text.span(), "`stop` must look at one sample, not at a whole run")
                    .why("a value over all samples is known only after the run")
                    .help("write the condition itself: `contact('ball', 'floor')`, not `first(contact('ball', 'floor'))`"),
            );
            good = false;
        }
        let name = &run.name.value;
        good.then_some(BoundRun {
            name,
            spec: Some(run),
            setup,
            stop,
            swept: None,
            control: None,
            freely: false,
            scene,
        })
    }

    /// Compiles a measure for every lab. One that has no meaning in some of them is not taken there; one that has a meaning in none
    /// is told of the first.
    fn measure(&mut self, name: &'a str, text: &'a Text, findings: &mut Vec<Finding>) -> bool {
        let mut told: Option<Vec<Finding>> = None;
        let mut known = false;
        for bound in &mut self.scenes {
            let mut globals = bound.globals.clone();
            let compiled = Compiler::new(&bound.names(Scope::Measure), &mut globals).expression(&text.value);
            bound.globals = globals;
            let said = || compiled.diagnostics.iter().map(|d| to_finding(d, text)).collect();
            if told.is_none() || (!known && compiled.program.is_some()) {
                told = Some(said());
            }
            known |= compiled.program.is_some();
            bound.measures.extend(compiled.program.map(|program| (name, Named { text, program })));
        }
        findings.extend(told.into_iter().flatten());
        known
    }

    /// The labs of every run, as [`BoundVerify::new`] takes them.
    pub(super) fn labs(&self) -> Vec<Vec<BoundLab<'a>>> {
        let of = |run: &'a Run| {
            let own = self.runs.iter().filter(|b| b.spec.is_some_and(|spec| std::ptr::eq(spec, run)));
            own.filter_map(|b| self.scene_of(b).map(|s| s.scene.clone())).collect()
        };
        self.verify.runs.iter().map(of).collect()
    }

    /// What the `verify` objects of the lesson share.
    pub(super) fn stage(&self) -> &'a Stage<'a> {
        self.stage
    }

    /// The lab that expressions over measures are read in.
    pub(super) fn base(&self) -> Option<&BoundScene<'a>> {
        self.scenes.first()
    }

    /// What is known of the units of the measures.
    pub(super) fn units(&self) -> Option<&units::Known> {
        self.units.get_or_init(|| units::Known::of(self)).as_ref()
    }

    /// The lab of the object with its model and programs.
    pub(super) fn lab(&self) -> Option<&BoundLab<'a>> {
        self.scenes.first().map(|s| &s.scene)
    }

    fn scene_of(&self, run: &BoundRun<'_>) -> Option<&BoundScene<'a>> {
        self.scenes.get(run.scene)
    }

    /// Makes every run and takes every measure. `None` when a run cannot be made.
    pub(super) fn outcome(&self, numerics: StepVariant, findings: &mut Vec<Finding>) -> Option<Outcome> {
        let mut runs = Vec::new();
        for run in &self.runs {
            let scene = self.scene_of(run)?;
            let measures: Vec<&Named<'_>> = scene.measures.iter().map(|(_, m)| m).collect();
            let made = self.perform(run, numerics, &measures, findings)?;
            let names = scene.measures.iter().map(|(name, _)| name.to_string());
            let mut doubts = Vec::new();
            let mut measures = Vec::new();
            for (name, Sampled { value, doubt, .. }) in names.zip(made.values) {
                doubts.extend(doubt.map(|doubt| (name.clone(), doubt)));
                measures.push((name, value));
            }
            runs.push(RunOutcome {
                name: run.name.to_string(),
                swept: run.swept,
                measures,
                doubts,
                warnings: made.warnings,
                broke: made.broke,
            });
        }
        let (mut found, mut looked) = (Vec::new(), Vec::new());
        for f in &self.verify.find {
            let limit = self.search(f, numerics, findings)?;
            found.push((f.name.value.clone(), limit.value));
            looked.push(limit.looked);
        }
        Some(Outcome { runs, found, looked, numerics, elsewhere: Vec::new() })
    }

    /// Searches for a value; `None` when a run cannot be made, NaN when there is no such value, which is reported.
    fn search(
        &self,
        find: &Find,
        numerics: StepVariant,
        findings: &mut Vec<Finding>,
    ) -> Option<search::Limit> {
        let named = |run: &&BoundRun<'_>| find.run.as_ref().is_none_or(|name| name.value == run.name);
        let mut runs = self.runs.iter().filter(named);
        let (Some(run), None) = (runs.next(), runs.next()) else {
            let place = find.run.as_ref().unwrap_or(&find.name).span();
            findings.push(
                Finding::error(rules::RUN_IMPOSSIBLE, place, "a search needs a single run, not a sweep")
                    .help("name the run: \"run\": \"coarse\""),
            );
            return None;
        };
        let case = SearchCase {
            find,
            run: run.spec,
            measure: &self.verify.measure,
            scene: &self.scene_of(run)?.scene,
        };
        search::search(&case, self.stage, numerics, findings)
    }

    /// The only run, with a control set to a value that a student need not be able to choose.
    pub(super) fn set_freely(&mut self, control: &'a Text, x: f64) {
        for run in &mut self.runs {
            (run.control, run.freely) = (Some((control, x)), true);
        }
    }

    pub(super) fn perform(
        &self,
        run: &BoundRun<'a>,
        numerics: StepVariant,
        measures: &[&Named<'_>],
        findings: &mut Vec<Finding>,
    ) -> Option<runner::Made> {
        let place = run.spec.map_or(self.verify.span.clone(), |r| r.name.span());
        let asked = Asked { scene: self.scene_of(run)?, run, numerics, measures, place };
        runner::perform(&asked, self.stage, findings)
    }

    /// The place of a run in the lesson, and whether the lesson says that it breaks.
    pub(super) fn run_place(&self, index: usize) -> (std::ops::Range<usize>, bool) {
        let spec = self.runs.get(index).and_then(|r| r.spec);
        (spec.map_or(self.verify.span.clone(), |r| r.name.span()), spec.is_some_and(|r| r.breaks))
    }

    /// Whether every run states its own timestep, so that half of it says nothing new.
    pub(super) fn states_every_timestep(&self) -> bool {
        let states =
            |run: &BoundRun<'_>| self.scene_of(run).is_some_and(|s| runner::states(s, run, option::timestep));
        self.runs.iter().all(states)
    }

    /// Every run with its lab, in the order of an outcome.
    pub(super) fn cast(&self) -> impl Iterator<Item = (&BoundRun<'a>, &BoundScene<'a>)> {
        self.runs.iter().filter_map(|run| Some((run, self.scene_of(run)?)))
    }

    /// Looks at the names of expressions over the outcome before there is one.
    pub(super) fn lint_texts<'t>(&self, texts: impl Iterator<Item = &'t Text>, findings: &mut Vec<Finding>) {
        for text in texts {
            let Some(claim) = self.claim(text) else { return };
            let errors = claim.diagnostics.iter().filter(|d| d.is_error());
            findings.extend(errors.map(|d| to_finding(d, text)));
            if claim.outside && claim.program.is_some() {
                findings.push(found::outside(text));
            }
        }
    }

    /// What the traces of its lab show in every run, up to so many; a run that cannot be made, or whose lab shows nothing, is left
    /// out.
    pub(crate) fn curves(&self, most: usize) -> Vec<Curves> {
        let one = |run: &BoundRun<'a>| {
            let (scene, place) = (self.scene_of(run)?, self.verify.span.clone());
            let asked = Asked { scene, run, numerics: StepVariant::NOMINAL, measures: &[], place };
            curves::of_run(&asked, self.stage)
        };
        self.runs.iter().take(most).filter_map(one).collect()
    }

    /// The model of every run as it begins: after the run's controls and its setup. `None` for a run that cannot be made.
    pub(crate) fn begun(&self) -> Vec<(String, Option<Model>)> {
        let begin = |run: &BoundRun<'_>| runner::begun(self.scenes.get(run.scene)?, run);
        self.runs.iter().map(|run| (run.name.to_string(), begin(run))).collect()
    }
}
