//! A `verify` object bound to its lab and model, ready to run.

use super::measure::Measure;
use super::outcome::{Outcome, OutcomeNames, RunOutcome};
use crate::bind::scene::finding;
use crate::bind::{ModelNames, Programs, Scope, include, scalar, to_finding};
use crate::finding::Finding;
use crate::run::{self, Numerics, Session};
use crate::source::Text;
use crate::spec::{Lab, Run, Verify};
use labspec_core::reflect::{self, Object};
use labspec_core::{Demand, Model};
use labspec_expr::{Compiled, Compiler, Effects, Globals, Program, Value};

/// Most steps of one run of a `verify` object.
const MAX_VERIFY_STEPS: usize = 2_000_000;

/// A program with the text that it came from.
#[derive(Debug)]
struct Named<'a> {
    text: &'a Text,
    program: Program,
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
    place: std::ops::Range<usize>,
}

impl<'a> BoundVerify<'a> {
    /// Compiles setups and measures. What is wrong goes to `findings`; `None` when it cannot run.
    pub fn new(
        verify: &'a Verify,
        lab: &'a Lab,
        model: &'a Model,
        programs: &'a Programs,
        findings: &mut Vec<Finding>,
    ) -> Option<BoundVerify<'a>> {
        let mut globals = programs.globals.clone();
        let mut good = true;
        let mut keep = |text: &'a Text, compiled: Compiled| {
            findings.extend(compiled.diagnostics.iter().map(|d| to_finding(d, text)));
            good &= compiled.program.is_some();
            compiled.program.map(|program| Named { text, program })
        };
        let in_lab = ModelNames { model, scope: Scope::Lab };
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
        let in_measure = ModelNames { model, scope: Scope::Measure };
        let mut measures = Vec::new();
        for (name, text) in &verify.measure {
            if let Some(m) = keep(text, Compiler::new(&in_measure, &mut globals).expression(&text.value)) {
                measures.push((name.value.as_str(), m));
            }
        }
        good.then_some(BoundVerify {
            lab,
            model,
            programs,
            globals,
            runs,
            measures,
            place: verify.span.clone(),
        })
    }

    /// Makes every run and takes every measure. `None` when a run cannot be made.
    pub(super) fn outcome(&self, numerics: Numerics, findings: &mut Vec<Finding>) -> Option<Outcome> {
        let measures: Vec<&Named<'_>> = self.measures.iter().map(|(_, m)| m).collect();
        let mut runs = Vec::new();
        for run in &self.runs {
            let (values, warnings) = self.perform(run, numerics, &measures, findings)?;
            let measures = self.measures.iter().map(|(name, _)| name.to_string()).zip(values).collect();
            runs.push(RunOutcome { name: run.name.to_string(), measures, warnings });
        }
        Some(Outcome { runs, numerics })
    }

    /// Whether each condition holds. `None` when one cannot be evaluated.
    pub(super) fn conditions(
        &self,
        outcome: &Outcome,
        verify: &Verify,
        findings: &mut Vec<Finding>,
    ) -> Option<Vec<bool>> {
        verify.options.iter().map(|text| self.value(outcome, text, findings).map(|v| v.truthy())).collect()
    }

    /// The value of an expression over the outcome, as a number.
    pub(super) fn number(&self, outcome: &Outcome, text: &Text, findings: &mut Vec<Finding>) -> Option<f64> {
        self.value(outcome, text, findings).map(|v| v.to_number())
    }

    fn value(&self, outcome: &Outcome, text: &Text, findings: &mut Vec<Finding>) -> Option<Value> {
        let names = OutcomeNames::new(outcome, ModelNames { model: self.model, scope: Scope::Measure });
        let mut globals = self.globals.clone();
        let compiled = Compiler::new(&names, &mut globals).expression(&text.value);
        findings.extend(compiled.diagnostics.iter().map(|d| to_finding(d, text)));
        let program = compiled.program?;
        match self.runs.as_slice() {
            // Measured on the spot, as a lesson with one run may write it: the same run once more.
            [run] if !program.aggregates().is_empty() => {
                let named = Named { text, program };
                let (values, _) = self.perform(run, outcome.numerics, &[&named], findings)?;
                values.first().map(|&x| Value::Number(x))
            }
            _ => self.constant(&program, text),
        }
    }

    /// The value of a program over known measures.
    fn constant(&self, program: &Program, text: &Text) -> Option<Value> {
        let mut session = Session::start(self.programs, self.model, None, &Demand::ANY);
        session.evaluate(program, text)
    }

    /// One run: the order of events of the lab, then the run's own controls and setup.
    fn perform(
        &self,
        run: &BoundRun<'_>,
        numerics: Numerics,
        measures: &[&Named<'_>],
        findings: &mut Vec<Finding>,
    ) -> Option<(Vec<f64>, usize)> {
        let mut demand = self.programs.demand;
        for program in measures.iter().map(|m| &m.program).chain(run.setup.as_ref().map(|s| &s.program)) {
            include(program.effects(), &mut demand);
            for arg in program.aggregates().iter().flat_map(|a| &a.args) {
                include(arg.effects(), &mut demand);
            }
        }
        let key = self.lab.keyframe();
        let mut session = Session::start(self.programs, self.model, key, &demand);
        let place = run.spec.map_or(self.place.clone(), |r| r.name.span());
        let mut refuse_at = |place: std::ops::Range<usize>, e: run::RunError| {
            findings.push(finding(
                "run-impossible",
                place,
                format!("the run `{}` cannot be made: {e}", run.name),
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
        let mut pending = press.as_slice();
        session.press_due(&mut pending);
        running.iter_mut().for_each(|m| m.sample(&mut session));
        for _ in 0..count {
            session.press_due(&mut pending);
            session.step();
            running.iter_mut().for_each(|m| m.sample(&mut session));
        }
        let values = running.into_iter().map(|m| m.finish(&mut session)).collect();
        for t in &session.troubles {
            let span = t.text.span_of(t.span.clone());
            findings.push(finding(
                t.code,
                span,
                format!("{} (in the run `{}`, at t = {} s)", t.message, run.name, t.time),
            ));
        }
        Some((values, session.warnings.iter().map(|w| w.number).sum()))
    }

    /// Whether the lesson itself states the timestep of a run: in the run, or in the lab's setup.
    fn states_timestep(&self, run: &BoundRun<'_>) -> bool {
        let Some(timestep) = reflect::field(Object::Option, "timestep") else { return false };
        let writes = |e: &Effects| e.writes.iter().any(|a| a.field.0 == u32::from(timestep.0));
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
