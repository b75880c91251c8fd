//! A lab whose settings are compared: the displayed numbers, and its run with a setting.

use super::event_finder::EventFinder;
use super::integrator_work::integrator_work;
use super::jumps;
use super::run_record::{EnergySampler, RecordRequest, SampledRun, SamplingPlan};
use super::setting::Setting;
use labspec::bind::{
    Bound, ControlProgram, ModelNames, Programs, Scope, dimensions, include, of_label, to_finding,
};
use labspec::finding::Finding;
use labspec::run::{self, Budget, Play, RunError, Session, Start};
use labspec::spec::{Lab, Plot};
use labspec_bind::units::written;
use labspec_core::reflect::{FieldId, option};
use labspec_core::{AccessSet, Model, Plan};
use labspec_expr::dimension::Measure;
use labspec_expr::{Compiler, Type, Value};
use schemars::JsonSchema;
use serde::Serialize;
use std::ops::ControlFlow;

/// A number that the lab displays.
pub(super) struct ComparedNumber<'a> {
    pub(super) label: String,
    /// Its unit, if known.
    pub(super) unit: Option<String>,
    pub(super) bound: &'a Bound,
    /// Its closed form, if it has one.
    pub(super) exact: Option<Bound>,
    pub(super) display: DisplayPrecision,
}

/// The precision with which a number is displayed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum DisplayPrecision {
    /// With this number of decimals.
    Decimals(u32),
    /// As a curve: the limits of its axis, if they are fixed, and its height in pixels.
    Curve { ends: [Option<f64>; 2], height: f64 },
}

impl DisplayPrecision {
    /// The largest invisible error for values with some range: half a unit of the last digit, or half a pixel.
    pub(super) fn invisible_error(self, range: f64) -> f64 {
        match self {
            DisplayPrecision::Decimals(digits) => 0.5 * 0.1f64.powi(digits as i32),
            DisplayPrecision::Curve { ends, height } => {
                let tall = match ends {
                    [Some(low), Some(high)] if high > low => high - low,
                    _ => range,
                };
                0.5 * tall / height.max(1.0)
            }
        }
    }
}

/// A trace or a readout that is not compared.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, JsonSchema)]
pub struct OmittedNumber {
    /// Its label.
    pub label: String,
    /// Why it is left out.
    pub reason: &'static str,
}

/// The reason for a number that is compared under another label.
pub(super) const REPEATED_NUMBER: &str = "it repeats another one";

/// The data that all runs of a comparison share.
pub(super) struct PrecisionCase<'a> {
    pub(super) lab: &'a Lab,
    pub(super) model: &'a Model,
    pub(super) programs: &'a Programs,
    pub(super) targets: Vec<ComparedNumber<'a>>,
    pub(super) omitted: Vec<OmittedNumber>,
    pub(super) set: &'a [(String, Value)],
    /// Buttons and the times at which they are pressed, s.
    pub(super) presses: Vec<(usize, f64)>,
    pub(super) access: AccessSet,
    /// The time between samples of the reference, s, and their number without the start.
    pub(super) interval: f64,
    pub(super) count: usize,
}

/// The number of samples at which energy and momentum are evaluated.
const CONSERVATION_SAMPLES: usize = 100;

/// The unit that a label states, otherwise the unit of the dimension; `None` for a dimensionless number.
fn unit_of(label: &str, measured: Option<Measure>) -> Option<String> {
    let stated = of_label(label).map(|(text, _)| text.to_string());
    let computed = || match measured? {
        Measure::Dimension(dimension) => Some(written(&dimension)),
        _ => None,
    };
    // A unit times a number has no name.
    stated.or_else(computed).filter(|unit| unit != "1" && !unit.contains(", times"))
}

impl<'a> PrecisionCase<'a> {
    /// The numbers that a lab displays, with their closed forms. Errors in these are added to `findings`.
    /// The times are not set yet.
    pub(super) fn new(
        lab: &'a Lab,
        model: &'a Model,
        programs: &'a Programs,
        set: &'a [(String, Value)],
        findings: &mut Vec<Finding>,
    ) -> PrecisionCase<'a> {
        let mut case = PrecisionCase {
            lab,
            model,
            programs,
            targets: Vec::new(),
            omitted: Vec::new(),
            set,
            presses: Vec::new(),
            access: programs.access,
            interval: 0.0,
            count: 0,
        };
        let names = ModelNames::new(model, Scope::Lab).with(&programs.functions);
        let exact = lab.verify.as_ref().map_or(&[][..], |v| &v.exact);
        let curve = |plot: &Plot| DisplayPrecision::Curve {
            ends: [&plot.ymin, &plot.ymax].map(|end| end.as_ref().map(|x| x.value)),
            height: plot.height(),
        };
        let curves = |plot: &'a Plot| plot.traces.iter().map(move |t| (&t.label.value, curve(plot)));
        let traces = lab.plots.iter().flat_map(curves);
        let readouts = lab.readouts.iter().map(|r| (&r.label.value, DisplayPrecision::Decimals(r.digits())));
        let measured = dimensions(lab, model, programs).probes;
        let probes = programs.probes.iter().zip(measured.into_iter().chain(std::iter::repeat(None)));
        for ((label, display), (probe, measured)) in traces.chain(readouts).zip(probes) {
            let Some(bound) = &probe.bound else { continue };
            let unit = unit_of(label, measured.map(|m| m.value));
            let closed = exact
                .iter()
                .find(|e| e.trace.value == *label && matches!(display, DisplayPrecision::Curve { .. }));
            let closed = closed.and_then(|e| {
                let mut globals = programs.globals.clone();
                let compiled = Compiler::new(&names, &mut globals).linting().expression(&e.form.value);
                findings.extend(compiled.diagnostics.iter().map(|d| to_finding(d, &e.form)));
                compiled.program.map(|program| Bound { text: e.form.clone(), program })
            });
            case.take((label, unit), display, bound, closed);
        }
        case
    }

    fn take(
        &mut self,
        (label, unit): (&str, Option<String>),
        display: DisplayPrecision,
        bound: &'a Bound,
        exact: Option<Bound>,
    ) {
        let effects = bound.program.effects();
        let reads = |id| effects.reads.iter().any(|a| FieldId::new(a.field.0 as usize) == Some(id));
        let reason = if !matches!(bound.program.result_type(), Type::Number | Type::Any) {
            "it is not a number"
        } else if exact.is_none() && (reads(option::timestep) || reads(option::integrator)) {
            "it depends on the timestep or the integrator, so it has no closed form"
        } else if self.targets.iter().any(|t| t.bound.text.value == bound.text.value && t.display == display)
        {
            REPEATED_NUMBER
        } else {
            if let Some(e) = &exact {
                include(e.program.effects(), &mut self.access);
            }
            self.targets.push(ComparedNumber { label: label.to_string(), unit, bound, exact, display });
            return;
        };
        self.omitted.push(OmittedNumber { label: label.to_string(), reason });
    }

    /// Whether a program runs at every step. Its controls are constant during a step, so that the timestep is
    /// part of the lab's behaviour.
    pub(super) fn controlled(&self) -> bool {
        self.programs.controller.is_some()
    }

    /// The program that sets the timestep during the run, in which case no other timestep can be tested.
    pub(super) fn program_that_sets_timestep(&self) -> Option<String> {
        let timestep = Some(option::timestep);
        let writes = |bound: &Bound| {
            let effects = bound.program.effects();
            effects.writes.iter().any(|w| FieldId::new(w.field.0 as usize) == timestep)
        };
        if self.programs.controller.as_ref().is_some_and(writes) {
            return Some("the controller".to_string());
        }
        self.presses.iter().find_map(|(i, _)| match self.programs.controls.get(*i) {
            Some((label, ControlProgram::Press(Some(bound)))) if writes(bound) => {
                Some(format!("the button \"{label}\""))
            }
            _ => None,
        })
    }

    /// Starts the lab with its controls set, with a setting or with its own.
    ///
    /// # Errors
    /// A control cannot be set to its value.
    pub(super) fn start(&self, setting: Option<&Setting>) -> Result<Session<'a>, RunError> {
        let mut model = self.model.clone();
        if let Some(s) = setting {
            s.apply(&mut model);
        }
        let plan = Some(Plan::new(&model, &self.access));
        let start = Start { key: self.lab.keyframe(), plan, budget: Budget::COMPARED };
        let mut session = Session::start(self.programs, &model, start);
        run::set_controls(&mut session, self.lab, self.programs, self.set)?;
        if let Some(s) = setting {
            // The lab's own code may have changed the setting.
            s.apply(&mut session.world.model);
        }
        Ok(session)
    }

    /// The length of the runs, s.
    pub(super) fn length(&self) -> f64 {
        self.count as f64 * self.interval
    }

    /// The sampling of a run with some timestep: after each step, as a page displays it, if the reference has samples as often.
    pub(super) fn sampling_plan(&self, timestep: f64) -> SamplingPlan {
        let whole = |x: f64| x.round().max(1.0) as usize;
        let stride = whole(timestep / self.interval);
        SamplingPlan { steps: whole(self.interval / timestep), stride, count: self.count / stride }
    }

    /// Runs the lab with a setting.
    pub(super) fn run(&self, setting: &Setting, request: RecordRequest<'_>) -> Result<SampledRun, RunError> {
        let mut session = self.start(Some(setting))?;
        if request.perturbation != 0.0 {
            let perturbation = request.perturbation;
            session.perturb(run::StepVariant { perturbation, ..run::StepVariant::NOMINAL }, true);
        }
        let sampling_plan = self.sampling_plan(setting.timestep);
        let steps = sampling_plan.count * sampling_plan.steps;
        let mut record = SampledRun::with_capacity(self.targets.len(), sampling_plan.count + 1);
        let mut energy = EnergySampler::new(&session.world.model);
        let mut finder = request.sought.map(|s| EventFinder::new(s, &session.world.model, setting));
        let evaluate = |session: &mut Session<'_>, i: usize| self.value(session, i);
        let every = sampling_plan.count.div_ceil(CONSERVATION_SAMPLES).max(1);
        let before = session.spent();
        let mut sampling = 0;
        let mut current = vec![0.0; self.targets.len()];
        let sample = |session: &mut Session<'_>, made: usize| {
            let began = session.spent();
            let sampled = made.is_multiple_of(sampling_plan.steps);
            if request.fresh && made > 0 {
                session.refresh();
            }
            self.sample_targets(session, &mut current, sampled.then_some(&mut record));
            record.observe(session);
            if let Some(finder) = &mut finder {
                finder.observe_step(session, &current, &evaluate);
            }
            if sampled && (made / sampling_plan.steps).is_multiple_of(every) {
                energy.sample(session, &mut record);
            }
            sampling += session.spent() - began;
            let time = session.world.data.time();
            let found = finder.as_ref().is_some_and(EventFinder::is_complete);
            match request.stop.is_some_and(|stop| found || time > stop) {
                true => ControlFlow::Break(()),
                false => ControlFlow::Continue(()),
            }
        };
        let played = Play { steps, stop: None, every: 1, presses: &self.presses, watched: !request.fresh };
        let made = match request.cut {
            true => jumps::play(&mut session, &played, setting.timestep, sample),
            false => run::play(&mut session, &played, sample),
        };
        let simulated = made as f64 * setting.timestep;
        let counted = (session.spent() - before - sampling) as f64;
        let of_steps = made as f64 * integrator_work(&session, setting.integrator);
        record.work = (counted + of_steps) / simulated.max(setting.timestep);
        if let Some(finder) = finder {
            record.take_moments(finder);
        }
        record.fill_up(sampling_plan.count + 1);
        record.set_status(&session);
        Ok(record)
    }

    /// Evaluates all targets. At a sample, the values are recorded, together with those of the closed forms.
    fn sample_targets(
        &self,
        session: &mut Session<'_>,
        current: &mut [f64],
        mut record: Option<&mut SampledRun>,
    ) {
        for (i, target) in self.targets.iter().enumerate() {
            current[i] = self.value(session, i);
            if let Some(record) = &mut record {
                record.values[i].push(current[i]);
                let exact = target.exact.as_ref().and_then(|b| session.evaluate(&b.program, &b.text));
                record.exact[i].push(exact.map_or(f64::NAN, |v| v.to_number()));
            }
        }
    }

    fn value(&self, session: &mut Session<'_>, target: usize) -> f64 {
        let bound = self.targets.get(target).map(|t| t.bound);
        let value = bound.and_then(|b| session.evaluate(&b.program, &b.text));
        value.map_or(f64::NAN, |v| v.to_number())
    }
}
