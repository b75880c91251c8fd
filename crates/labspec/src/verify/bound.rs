//! A `verify` object bound to its labs and models, ready to run.

use super::condition::{self, Weighed};
use super::curves::{self, Curves};
use super::outcome::{Outcome, OutcomeNames, RunOutcome};
use super::perform::{self, Asked};
use super::reads;
use super::search::{self, Case};
use super::stage::{Scene, Stage};
use super::units;
use crate::bind::{ModelNames, Scope, Shown, functions, to_finding};
use crate::finding::Finding;
use crate::ledger::Evidence;
use crate::rules;
use crate::run::{Numerics, Session};
use crate::source::Text;
use crate::spec::{Find, Run, Sweep, Verify};
use labspec_core::reflect::{FieldId, Object};
use labspec_core::{Demand, Model};
use labspec_expr::{Compiled, Compiler, Effects, Globals, Program, Value};
use std::cell::{OnceCell, RefCell};

/// A program with the text that it came from.
#[derive(Debug)]
pub(super) struct Named<'a> {
    pub(super) text: &'a Text,
    pub(super) program: Program,
}

/// A lab with the measures that are taken in its runs.
#[derive(Debug)]
pub(super) struct BoundScene<'a> {
    pub(super) scene: Scene<'a>,
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
    runs: Vec<BoundRun<'a>>,
    verify: &'a Verify,
    stage: &'a Stage<'a>,
    /// A lab at its start, for expressions over measures: they read nothing of it.
    idle: RefCell<Option<Session<'a>>>,
    /// What the measures measure, once somebody has asked.
    units: OnceCell<Option<units::Known>>,
}

/// The value of an expression over the measures, and what it rests on.
#[derive(Clone, Debug)]
pub(super) struct Found {
    pub(super) value: Value,
    /// Whether a simulation says it.
    pub(super) evidence: Evidence,
    /// A run that it rests on broke: its name and how, unless the expression reads the warnings of that run.
    pub(super) broke: Option<String>,
}

impl BoundRun<'_> {
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

    fn measured(&self, name: &str) -> Option<&Named<'_>> {
        self.measures.iter().find(|(n, _)| *n == name).map(|(_, m)| m)
    }
}

impl<'a> BoundVerify<'a> {
    /// Compiles what runs do and what is measured. `scenes` has the lab of every run, one for each member of a sweep; the lab of
    /// the object itself, where there is one, is `base`. What is wrong goes to `findings`; `None` when it cannot run.
    pub fn new(
        verify: &'a Verify,
        base: Option<&Scene<'a>>,
        scenes: &[Vec<Scene<'a>>],
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
        good.then_some(bound)
    }

    /// The place of a lab in the list, to which it is added the first time.
    fn add(&mut self, scene: &Scene<'a>) -> usize {
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
                Finding::error(rules::RUN_IMPOSSIBLE, stop.text.span(), "`stop` looks at one sample, not at a whole run")
                    .why("what becomes of all samples is known only when the run is over")
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
    pub(super) fn labs(&self) -> Vec<Vec<Scene<'a>>> {
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
    pub(super) fn lab(&self) -> Option<&Scene<'a>> {
        self.scenes.first().map(|s| &s.scene)
    }

    fn scene_of(&self, run: &BoundRun<'_>) -> Option<&BoundScene<'a>> {
        self.scenes.get(run.scene)
    }

    /// Makes every run and takes every measure. `None` when a run cannot be made.
    pub(super) fn outcome(&self, numerics: Numerics, findings: &mut Vec<Finding>) -> Option<Outcome> {
        let mut runs = Vec::new();
        for run in &self.runs {
            let scene = self.scene_of(run)?;
            let measures: Vec<&Named<'_>> = scene.measures.iter().map(|(_, m)| m).collect();
            let made = self.perform(run, numerics, &measures, findings)?;
            let measures = scene.measures.iter().map(|(name, _)| name.to_string()).zip(made.values).collect();
            runs.push(RunOutcome {
                name: run.name.to_string(),
                swept: run.swept,
                measures,
                warnings: made.warnings,
                broke: made.broke,
            });
        }
        let find = |f: &Find| Some((f.name.value.clone(), self.search(f, numerics, findings)?));
        let found = self.verify.find.iter().map(find).collect::<Option<_>>()?;
        Some(Outcome { runs, found, numerics, elsewhere: Vec::new() })
    }

    /// Searches for a value; `None` when a run cannot be made, NaN when there is no such value, which is reported.
    fn search(&self, find: &Find, numerics: Numerics, findings: &mut Vec<Finding>) -> Option<f64> {
        let named = |run: &&BoundRun<'_>| find.run.as_ref().is_none_or(|name| name.value == run.name);
        let mut runs = self.runs.iter().filter(named);
        let (Some(run), None) = (runs.next(), runs.next()) else {
            let place = find.run.as_ref().unwrap_or(&find.name).span();
            findings.push(
                Finding::error(
                    rules::RUN_IMPOSSIBLE,
                    place,
                    "a search is made in one run, which is none of a sweep",
                )
                .help("name the run: \"run\": \"coarse\""),
            );
            return None;
        };
        let case =
            Case { find, run: run.spec, measure: &self.verify.measure, scene: &self.scene_of(run)?.scene };
        search::search(&case, self.stage, numerics, findings)
    }

    /// The only run, with a control set to a value that a student need not be able to choose.
    pub(super) fn set_freely(&mut self, control: &'a Text, x: f64) {
        for run in &mut self.runs {
            (run.control, run.freely) = (Some((control, x)), true);
        }
    }

    fn perform(
        &self,
        run: &BoundRun<'a>,
        numerics: Numerics,
        measures: &[&Named<'_>],
        findings: &mut Vec<Finding>,
    ) -> Option<perform::Made> {
        let place = run.spec.map_or(self.verify.span.clone(), |r| r.name.span());
        let asked = Asked { scene: self.scene_of(run)?, run, numerics, measures, place };
        perform::perform(&asked, self.stage, findings)
    }

    /// The place of a run in the lesson, and whether the lesson says that it breaks.
    pub(super) fn run_place(&self, index: usize) -> (std::ops::Range<usize>, bool) {
        let spec = self.runs.get(index).and_then(|r| r.spec);
        (spec.map_or(self.verify.span.clone(), |r| r.name.span()), spec.is_some_and(|r| r.breaks))
    }

    /// Whether every run states its own timestep, so that half of it says nothing new.
    pub(super) fn states_every_timestep(&self) -> bool {
        let states =
            |run: &BoundRun<'_>| self.scene_of(run).is_some_and(|s| perform::states(s, run, "timestep"));
        self.runs.iter().all(states)
    }

    /// The value of an expression over the outcome. What is wrong with it goes to `findings`.
    pub(super) fn find(&self, outcome: &Outcome, text: &Text, findings: &mut Vec<Finding>) -> Option<Found> {
        let base = self.scenes.first()?;
        let names = OutcomeNames::new(outcome, base.names(Scope::Measure));
        let mut globals = base.globals.clone();
        let compiled = Compiler::new(&names, &mut globals).expression(&text.value);
        findings.extend(compiled.diagnostics.iter().map(|d| to_finding(d, text)));
        let (used, numbers) = names.used();
        let program = compiled.program?;
        let mut broke = used.runs().iter().find_map(|&place| {
            let run = outcome.runs.get(place)?;
            let (_, expected) = self.run_place(place);
            let excused = expected || used.warnings.contains(&place);
            run.broke
                .as_ref()
                .filter(|_| !excused)
                .map(|how| format!("the run {} breaks: {how}", crate::json::read::named(&run.title())))
        });
        let measured = |(place, name): &(usize, String)| {
            self.runs.get(*place).and_then(|run| self.scene_of(run)?.measured(name))
        };
        let simulated = used.found
            || !used.warnings.is_empty()
            || used.measures.iter().filter_map(measured).any(|m| looks_at_data(&m.program))
            || looks_at_data(&program);
        let value = match self.runs.as_slice() {
            // Measured on the spot, as a lesson with one run may write it: the same run once more.
            [_] if !program.aggregates().is_empty() && outcome.measured_elsewhere(&text.value).is_some() => {
                Value::Number(outcome.measured_elsewhere(&text.value)?)
            }
            [run] if !program.aggregates().is_empty() => {
                let named = Named { text, program };
                let made = self.perform(run, outcome.numerics, &[&named], findings)?;
                let expected = run.spec.is_some_and(|r| r.breaks);
                let how = made.broke.filter(|_| !expected);
                broke = broke.or(how.map(|how| format!("the run breaks: {how}")));
                Value::Number(made.values.first().copied()?)
            }
            _ => self.constant(&program, text, numbers, findings)?,
        };
        let evidence = if simulated { Evidence::Simulated } else { Evidence::Computed };
        Some(Found { value, evidence, broke })
    }

    /// An outcome before there is one, for those who look at names.
    pub(super) fn blank(&self) -> Outcome {
        // Some number stands for each measure: what only depends on the number is not said.
        let run = |run: &BoundRun<'_>| {
            let measures = self.scene_of(run).into_iter().flat_map(|s| &s.measures);
            RunOutcome {
                name: run.name.to_string(),
                swept: run.swept,
                measures: measures.map(|(name, _)| (name.to_string(), 0.0)).collect(),
                warnings: 0,
                broke: None,
            }
        };
        let found = self.verify.find.iter().map(|f| (f.name.value.clone(), 0.0)).collect();
        let runs = self.runs.iter().map(run).collect();
        Outcome { runs, found, numerics: Numerics::NOMINAL, elsewhere: Vec::new() }
    }

    /// Those of the texts that look at the samples of the only run themselves.
    pub(super) fn on_the_spot<'t>(&self, texts: impl Iterator<Item = &'t Text>) -> Vec<&'t Text> {
        let (Some(base), [_]) = (self.scenes.first(), self.runs.as_slice()) else { return Vec::new() };
        let outcome = self.blank();
        let looks = |text: &&Text| {
            let names = OutcomeNames::new(&outcome, base.names(Scope::Measure));
            let compiled = Compiler::new(&names, &mut base.globals.clone()).expression(&text.value);
            compiled.program.is_some_and(|program| !program.aggregates().is_empty())
        };
        texts.filter(looks).collect()
    }

    /// Every run with its lab, in the order of an outcome.
    pub(super) fn cast(&self) -> impl Iterator<Item = (&BoundRun<'a>, &BoundScene<'a>)> {
        self.runs.iter().filter_map(|run| Some((run, self.scene_of(run)?)))
    }

    /// Looks at the names of expressions over the outcome before there is one.
    pub(super) fn look<'t>(&self, texts: impl Iterator<Item = &'t Text>, findings: &mut Vec<Finding>) {
        let outcome = self.blank();
        let Some(base) = self.scenes.first() else { return };
        for text in texts {
            let names = OutcomeNames::new(&outcome, base.names(Scope::Measure));
            let compiled = Compiler::new(&names, &mut base.globals.clone()).expression(&text.value);
            let errors = compiled.diagnostics.iter().filter(|d| d.is_error());
            findings.extend(errors.map(|d| to_finding(d, text)));
        }
    }

    /// A condition, taken apart.
    pub(super) fn weigh(&self, outcome: &Outcome, text: &Text, holds: bool) -> Weighed {
        let part = |code: &str| {
            let text = Text { value: code.to_string(), map: text.map.clone() };
            self.find(outcome, &text, &mut Vec::new()).map(|found| found.value)
        };
        condition::weigh(&text.value, holds, &part)
    }

    /// The value of a program over known measures. What it throws goes to `findings`.
    fn constant(
        &self,
        program: &Program,
        text: &Text,
        numbers: Vec<f64>,
        findings: &mut Vec<Finding>,
    ) -> Option<Value> {
        let scene = self.lab()?;
        let mut idle = self.idle.borrow_mut();
        let start = || Session::start(scene.programs.clone(), &scene.model, None, &Demand::ANY);
        let session = idle.get_or_insert_with(start);
        session.troubles.clear();
        session.world.numbers = numbers;
        let value = session.evaluate(program, text);
        findings.extend(session.troubles.iter().map(|t| {
            Finding::error(t.rule, t.text.span_of(t.span.clone()), t.message.clone())
                .why("the claim cannot be checked: this expression has no value")
                .help("correct the expression, or guard it with a condition")
        }));
        value
    }

    /// What the traces of its lab show in every run, up to so many; a run that cannot be made, or whose lab shows nothing, is left
    /// out.
    pub(crate) fn curves(&self, most: usize) -> Vec<Curves> {
        let one = |run: &BoundRun<'a>| {
            let (scene, place) = (self.scene_of(run)?, self.verify.span.clone());
            let asked = Asked { scene, run, numerics: Numerics::NOMINAL, measures: &[], place };
            curves::of_run(&asked, self.stage)
        };
        self.runs.iter().take(most).filter_map(one).collect()
    }

    /// The model of every run as it begins: after the run's controls and its setup. `None` for a run that cannot be made.
    pub(crate) fn begun(&self) -> Vec<(String, Option<Model>)> {
        let begin = |run: &BoundRun<'_>| perform::begun(self.scenes.get(run.scene)?, run);
        self.runs.iter().map(|run| (run.name.to_string(), begin(run))).collect()
    }
}

/// Whether a program looks at the data of a simulation, itself or in what it measures.
fn looks_at_data(program: &Program) -> bool {
    let of = |e: &Effects| {
        let data = |a: &labspec_expr::Access| {
            FieldId::new(a.field.0 as usize).is_some_and(|f| f.info().object == Object::Data)
        };
        e.reads_everything
            || e.calls.iter().any(|&f| functions::reads(f))
            || e.calls_values
            || e.reads.iter().any(data)
    };
    of(program.effects()) || program.aggregates().iter().flat_map(|a| &a.args).any(|p| of(p.effects()))
}
