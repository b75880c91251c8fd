//! A `verify` object bound to its lab and model, ready to run.

use super::condition::{self, Weighed};
use super::measure::Measure;
use super::outcome::{Outcome, OutcomeNames, RunOutcome};
use super::reads::{self, Reading};
use crate::bind::{ModelNames, Programs, Scope, functions, include, scalar, to_finding};
use crate::finding::Finding;
use crate::ledger::Evidence;
use crate::rules;
use crate::run::{self, Breakdown, Budget, End, Numerics, Play, Session};
use crate::source::Text;
use crate::spec::{Lab, Run, Verify};
use labspec_core::reflect::{self, FieldId, Object};
use labspec_core::{Demand, Model};
use labspec_expr::{Compiled, Compiler, Effects, Globals, Program, Value};
use std::cell::{Cell, RefCell};
use std::collections::BTreeMap;
use std::ops::ControlFlow;

/// Most steps of one run of a `verify` object.
const MAX_VERIFY_STEPS: usize = 2_000_000;

/// The work that the runs of all `verify` objects of a lesson may do together.
#[derive(Debug)]
pub struct Allowance(Cell<u64>);

impl Default for Allowance {
    fn default() -> Allowance {
        Allowance(Cell::new(6_000_000_000))
    }
}

/// A program with the text that it came from.
#[derive(Debug)]
struct Named<'a> {
    text: &'a Text,
    program: Program,
    /// It reads what the lab shows.
    reads: bool,
}

/// A run with its own setup compiled.
#[derive(Debug)]
struct BoundRun<'a> {
    name: &'a str,
    spec: Option<&'a Run>,
    setup: Option<Named<'a>>,
}

/// The lab, the model, the runs and the measures of a `verify` object.
#[derive(Debug)]
pub struct BoundVerify<'a> {
    lab: &'a Lab,
    model: &'a Model,
    programs: &'a Programs,
    globals: Globals,
    runs: Vec<BoundRun<'a>>,
    measures: Vec<(&'a str, Named<'a>)>,
    /// What measures read of what the lab shows.
    readings: Vec<Reading>,
    place: std::ops::Range<usize>,
    allowance: &'a Allowance,
    /// A lab at its start, for expressions over measures: they read nothing of it.
    idle: RefCell<Option<Session<'a>>>,
    /// What was measured on the spot, by the numerics and the text.
    spot: RefCell<BTreeMap<String, (f64, Option<String>)>>,
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

impl<'a> BoundVerify<'a> {
    /// Compiles setups and measures. What is wrong goes to `findings`; `None` when it cannot run.
    pub fn new(
        verify: &'a Verify,
        lab: &'a Lab,
        model: &'a Model,
        programs: &'a Programs,
        allowance: &'a Allowance,
        findings: &mut Vec<Finding>,
    ) -> Option<BoundVerify<'a>> {
        let mut globals = programs.globals.clone();
        let mut good = true;
        let replaced =
            |(_, text): &(Text, Text)| reads::replaced(text, lab, programs, &mut globals, findings);
        let replaced: Vec<Option<(String, Vec<Reading>)>> = verify.measure.iter().map(replaced).collect();
        let mut keep = |text: &'a Text, compiled: Compiled| {
            findings.extend(compiled.diagnostics.iter().map(|d| to_finding(d, text)));
            good &= compiled.program.is_some();
            compiled.program.map(|program| Named { text, program, reads: false })
        };
        let in_lab = ModelNames::new(model, Scope::Lab).with(&programs.functions);
        let mut runs: Vec<BoundRun<'a>> = Vec::new();
        for run in &verify.runs {
            let setup = run
                .setup
                .as_ref()
                .and_then(|t| keep(t, Compiler::new(&in_lab, &mut globals).statements(&t.value)));
            runs.push(BoundRun { name: &run.name.value, spec: Some(run), setup });
        }
        if runs.is_empty() {
            runs.push(BoundRun { name: "run", spec: None, setup: None });
        }
        let in_measure = ModelNames::new(model, Scope::Measure).with(&programs.functions);
        let (mut measures, mut readings) = (Vec::new(), Vec::new());
        let mut known = true;
        for ((name, text), replaced) in verify.measure.iter().zip(replaced) {
            let Some((source, read)) = replaced else {
                known = false;
                continue;
            };
            if let Some(m) = keep(text, Compiler::new(&in_measure, &mut globals).expression(&source)) {
                measures.push((name.value.as_str(), Named { reads: !read.is_empty(), ..m }));
                readings.extend(read);
            }
        }
        good &= known;
        good.then_some(BoundVerify {
            lab,
            model,
            programs,
            globals,
            runs,
            measures,
            readings,
            place: verify.span.clone(),
            allowance,
            idle: RefCell::default(),
            spot: RefCell::default(),
        })
    }

    /// The lab, its model and its programs.
    pub(super) fn lab(&self) -> (&'a Lab, &'a Model, &'a Programs) {
        (self.lab, self.model, self.programs)
    }

    /// Makes every run and takes every measure. `None` when a run cannot be made.
    pub(super) fn outcome(&self, numerics: Numerics, findings: &mut Vec<Finding>) -> Option<Outcome> {
        let measures: Vec<&Named<'_>> = self.measures.iter().map(|(_, m)| m).collect();
        let mut runs = Vec::new();
        for run in &self.runs {
            let made = self.perform(run, numerics, &measures, findings)?;
            let measures = self.measures.iter().map(|(name, _)| name.to_string()).zip(made.values).collect();
            runs.push(RunOutcome {
                name: run.name.to_string(),
                measures,
                warnings: made.warnings,
                broke: made.broke,
            });
        }
        Some(Outcome { runs, numerics })
    }

    /// The place of a run in the lesson, and whether the lesson says that it breaks.
    pub(super) fn run_place(&self, index: usize) -> (std::ops::Range<usize>, bool) {
        let spec = self.runs.get(index).and_then(|r| r.spec);
        (spec.map_or(self.place.clone(), |r| r.name.span()), spec.is_some_and(|r| r.breaks))
    }

    /// Whether every run states its own timestep, so that half of it says nothing new.
    pub(super) fn states_every_timestep(&self) -> bool {
        self.runs.iter().all(|run| self.states_timestep(run))
    }

    /// The value of an expression over the outcome. What is wrong with it goes to `findings`.
    pub(super) fn find(&self, outcome: &Outcome, text: &Text, findings: &mut Vec<Finding>) -> Option<Found> {
        let names = OutcomeNames::new(
            outcome,
            ModelNames::new(self.model, Scope::Measure).with(&self.programs.functions),
        );
        let mut globals = self.globals.clone();
        let compiled = Compiler::new(&names, &mut globals).expression(&text.value);
        findings.extend(compiled.diagnostics.iter().map(|d| to_finding(d, text)));
        let used = names.used();
        let program = compiled.program?;
        let mut broke = used.runs().iter().find_map(|&place| {
            let run = outcome.runs.get(place)?;
            let (_, expected) = self.run_place(place);
            let excused = expected || used.warnings.contains(&place);
            run.broke
                .as_ref()
                .filter(|_| !excused)
                .map(|how| format!("the run {} breaks: {how}", crate::json::read::named(&run.name)))
        });
        let measured = |name: &String| self.measures.iter().find(|(n, _)| n == name).map(|(_, m)| m);
        let simulated = !used.warnings.is_empty()
            || used
                .measures
                .iter()
                .filter_map(|(_, name)| measured(name))
                .any(|m| m.reads || looks_at_data(&m.program))
            || looks_at_data(&program);
        let value = match self.runs.as_slice() {
            // Measured on the spot, as a lesson with one run may write it: the same run once more.
            [run] if !program.aggregates().is_empty() => {
                let key = format!("{:?} {}", outcome.numerics, text.value);
                let known = self.spot.borrow().get(&key).cloned();
                let (x, how) = match known {
                    Some(found) => found,
                    None => {
                        let named = Named { text, program, reads: false };
                        let made = self.perform(run, outcome.numerics, &[&named], findings)?;
                        let found = (made.values.first().copied()?, made.broke);
                        self.spot.borrow_mut().insert(key, found.clone());
                        found
                    }
                };
                let expected = run.spec.is_some_and(|r| r.breaks);
                broke = broke.or(how.filter(|_| !expected).map(|how| format!("the run breaks: {how}")));
                Value::Number(x)
            }
            _ => self.constant(&program, text, findings)?,
        };
        let evidence = if simulated { Evidence::Simulated } else { Evidence::Computed };
        Some(Found { value, evidence, broke })
    }

    /// Looks at the names of expressions over the outcome before there is one.
    pub(super) fn look<'t>(&self, texts: impl Iterator<Item = &'t Text>, findings: &mut Vec<Finding>) {
        // Some number stands for each measure: what only depends on the number is not said.
        let run = |run: &BoundRun<'_>| RunOutcome {
            name: run.name.to_string(),
            measures: self.measures.iter().map(|(name, _)| (name.to_string(), 0.0)).collect(),
            warnings: 0,
            broke: None,
        };
        let outcome = Outcome { runs: self.runs.iter().map(run).collect(), numerics: Numerics::NOMINAL };
        for text in texts {
            let model = ModelNames::new(self.model, Scope::Measure).with(&self.programs.functions);
            let names = OutcomeNames::new(&outcome, model);
            let compiled = Compiler::new(&names, &mut self.globals.clone()).expression(&text.value);
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
    fn constant(&self, program: &Program, text: &Text, findings: &mut Vec<Finding>) -> Option<Value> {
        let mut idle = self.idle.borrow_mut();
        let start = || Session::start(self.programs, self.model, None, &Demand::ANY);
        let session = idle.get_or_insert_with(start);
        session.troubles.clear();
        let value = session.evaluate(program, text);
        findings.extend(session.troubles.iter().map(|t| {
            Finding::error(t.rule, t.text.span_of(t.span.clone()), t.message.clone())
                .why("the claim cannot be checked: this expression has no value")
                .help("correct the expression, or guard it with a condition")
        }));
        value
    }

    /// One run: the order of events of the lab, then the run's own controls and setup.
    fn perform(
        &self,
        run: &BoundRun<'_>,
        numerics: Numerics,
        measures: &[&Named<'_>],
        findings: &mut Vec<Finding>,
    ) -> Option<Made> {
        let mut demand = self.programs.demand;
        for program in measures.iter().map(|m| &m.program).chain(run.setup.as_ref().map(|s| &s.program)) {
            include(program.effects(), &mut demand);
            for arg in program.aggregates().iter().flat_map(|a| &a.args) {
                include(arg.effects(), &mut demand);
            }
        }
        let key = self.lab.keyframe();
        let budget = Budget { left: self.allowance.0.get() };
        let mut session = Session::start_within(self.programs, self.model, key, &demand, budget);
        let place = run.spec.map_or(self.place.clone(), |r| r.name.span());
        let mut refuse_at = |place: std::ops::Range<usize>, e: run::RunError| {
            findings.push(Finding::error(
                rules::RUN_IMPOSSIBLE,
                place,
                format!("the run {} cannot be made: {e}", crate::json::read::named(run.name)),
            ));
        };
        let stated = self.states_timestep(run);
        let mut press = Vec::new();
        let (mut until, mut steps) = (None, None);
        if let Some(spec) = run.spec {
            for (label, v) in &spec.set {
                let known = self.lab.control(&label.value).is_some();
                let at = if known { v.span() } else { label.span() };
                let one = [(label.value.clone(), scalar(v))];
                let made = run::set_controls(&mut session, self.lab, self.programs, &one);
                made.map_err(|e| refuse_at(at, e)).ok()?;
            }
            let list: Vec<_> = spec.press.iter().map(|(label, t)| (label.value.clone(), t.value)).collect();
            press = run::presses(self.programs, &list).map_err(|e| refuse_at(place.clone(), e)).ok()?;
            until = spec.until.as_ref().map(|n| n.value);
            // As many steps as reach as far.
            let shorter = if stated { 1.0 } else { numerics.timestep };
            steps = spec.steps.as_ref().map(|n| (n.value.max(0.0) / shorter).round() as usize);
        }
        if let Some(setup) = &run.setup {
            session.run_statements(&setup.program, setup.text);
        }
        session.perturb(numerics, stated);
        let mut refuse = |e: run::RunError| refuse_at(place.clone(), e);
        let timestep = session.world.model.opt.timestep;
        let count = run::count_steps(self.lab, until, steps, timestep).map_err(&mut refuse).ok()?;
        run::presses_within(self.programs, &press, count, timestep).map_err(&mut refuse).ok()?;

        if count > MAX_VERIFY_STEPS {
            refuse(run::RunError(format!(
                "it takes {count} steps; a verified run may take {MAX_VERIFY_STEPS}, so that a check ends"
            )));
            return None;
        }
        let mut running: Vec<Measure<'_>> =
            measures.iter().map(|m| Measure::new(&m.program, m.text)).collect();
        let played = Play { steps: count, every: 1, presses: &press, watched: true };
        run::play(&mut session, &played, |session, _| {
            reads::read(&self.readings, &self.globals, self.programs, session);
            running.iter_mut().for_each(|m| m.sample(session));
            ControlFlow::Continue(())
        });
        self.allowance.0.set(budget.left.saturating_sub(session.spent()));
        let values = running.into_iter().map(|m| m.finish(&mut session)).collect();
        for t in &session.troubles {
            let span = t.text.span_of(t.span.clone());
            findings.push(Finding::error(
                t.rule,
                span,
                format!(
                    "{} (in the run {}, at t = {} s)",
                    t.message,
                    crate::json::read::named(run.name),
                    t.time
                ),
            ));
        }
        let broke = match (Breakdown::of(&session), session.troubles.first()) {
            (Some(breakdown), _) => Some(breakdown.what),
            (None, Some(t)) => Some(format!("{}, at t = {} s", t.message, t.time)),
            (None, None) => session.ended().map(|end| match end {
                End::Threw => "an error froze it".to_string(),
                End::Interrupted => "it was interrupted".to_string(),
                End::Foreign => "its programs belong to another model".to_string(),
                End::Budget { time } => {
                    format!("the runs of this lesson take more work than a check may do, and this one ends at t = {} s", run::time(*time))
                }
            }),
        };
        Some(Made { values, warnings: session.warnings.iter().map(|w| w.number).sum(), broke })
    }

    /// The model of every run as it begins: after the run's controls and its setup. `None` for a run that cannot be made.
    pub(crate) fn begun(&self) -> Vec<(String, Option<Model>)> {
        let begin = |run: &BoundRun<'_>| {
            let (programs, key) = (self.programs, self.lab.keyframe());
            let mut session =
                Session::start_within(programs, self.model, key, &programs.demand, Budget::TRIAL);
            let set = run.spec.iter().flat_map(|spec| &spec.set);
            let set: Vec<_> = set.map(|(label, v)| (label.value.clone(), scalar(v))).collect();
            run::set_controls(&mut session, self.lab, programs, &set).ok()?;
            if let Some(setup) = &run.setup {
                session.run_statements(&setup.program, setup.text);
            }
            Some(session.world.model)
        };
        self.runs.iter().map(|run| (run.name.to_string(), begin(run))).collect()
    }

    /// Whether the lesson itself states the timestep of a run: in the run, or in the lab's setup.
    fn states_timestep(&self, run: &BoundRun<'_>) -> bool {
        let Some(timestep) = reflect::field(Object::Option, "timestep") else { return false };
        let writes = |e: &Effects| e.writes.iter().any(|a| a.field.0 as usize == timestep.index());
        let set = run
            .spec
            .iter()
            .flat_map(|r| &r.set)
            .filter_map(|(label, _)| self.programs.effects_of(&label.value));
        let setups = run.setup.iter().map(|s| s.program.effects());
        let own = self.programs.setup.iter().map(|b| b.program.effects());
        set.chain(setups).chain(own).any(writes)
    }
}

/// What came of one run.
struct Made {
    values: Vec<f64>,
    warnings: usize,
    broke: Option<String>,
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
