//! Work and precision: how far each integrator and timestep is from the truth, and what it costs.
//!
//! The truth is the closed form that the author gives (`exact` in the lab's `verify`), otherwise the same lab
//! with a tiny step. Reporting error against cost, not against the step, is the method of Hairer, Nørsett and
//! Wanner 1993, *Solving Ordinary Differential Equations I*, section II.10.

use crate::bind::{Bound, ModelNames, Programs, Scope, to_finding};
use crate::finding::Finding;
use crate::interrupt;
use crate::run::{self, Play, RunError, Session};
use crate::spec::Lab;
use crate::spec::format::RUN_LENGTH;
use labspec_core::{Model, Warning, integrator};
use labspec_expr::Compiler;
use std::ops::ControlFlow;
use std::time::Instant;

/// The integrators that are compared.
pub(crate) const INTEGRATORS: [(i32, &str); 2] = [(integrator::EULER, "Euler"), (integrator::RK4, "RK4")];
/// Timesteps, as multiples of the lab's own; each divides the first.
const STEPS: [f64; 6] = [4.0, 2.0, 1.0, 0.5, 0.25, 0.125];
/// The reference takes so many steps where the finest run takes one.
const REFERENCE: usize = 16;

/// What the errors are measured against.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Truth {
    /// The closed form of the author.
    ClosedForm,
    /// RK4 with a tiny step.
    TinySteps,
}

/// One run.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// Name of the integrator.
    pub integrator: &'static str,
    /// Timestep, s.
    pub timestep: f64,
    /// Largest error of each trace over the run, in the trace's own unit.
    pub errors: Vec<f64>,
    /// Observed order of each trace: how many times the error halves when the timestep halves.
    pub orders: Vec<Option<f64>>,
    /// Run time, microseconds per simulated second.
    pub cost: f64,
    /// The engine met a bad number, or a trace ended as one.
    pub diverged: bool,
}

/// All runs of a lab.
#[derive(Clone, Debug, PartialEq)]
pub struct Report {
    /// Labels of the traces that were compared.
    pub traces: Vec<String>,
    /// What each was compared with.
    pub truth: Vec<Truth>,
    /// How far the reference itself may be off: what halving its step changes. NaN for a closed form.
    pub uncertainty: Vec<f64>,
    /// Length of the runs, s.
    pub length: f64,
    /// The runs, by integrator, then from large to small steps.
    pub rows: Vec<Row>,
}

/// A trace and its closed form.
struct Target<'a> {
    label: &'a str,
    bound: &'a Bound,
    exact: Option<Bound>,
}

/// Samples of all traces at the common times; and of the closed forms, NaN without one.
struct Samples {
    values: Vec<Vec<f64>>,
    exact: Vec<Vec<f64>>,
    diverged: bool,
    seconds: f64,
}

/// Runs the lab with every integrator and timestep.
///
/// # Errors
/// The lab has no traces, or the runs would take too many steps. Mistakes in closed forms go to `findings`.
pub fn compare(
    lab: &Lab,
    model: &Model,
    programs: &Programs,
    until: Option<f64>,
    findings: &mut Vec<Finding>,
) -> Result<Report, RunError> {
    let targets = targets(lab, model, programs, findings);
    if targets.is_empty() {
        return Err(RunError("this lab has no traces to compare; add a plot with a trace".into()));
    }
    let own = start(lab, model, programs).world.model.opt.timestep;
    let coarse = own * STEPS[0];
    let length = until.or(lab.stop_at.as_ref().map(|s| s.value)).unwrap_or(RUN_LENGTH);
    // Samples at multiples of the coarsest step, which every run meets exactly.
    let count = run::count_steps(lab, Some(length), None, coarse)?.max(1);
    let finest = STEPS.iter().fold(1.0f64, |a, &b| a.min(b)) * own;
    if count.saturating_mul((coarse / finest).round() as usize).saturating_mul(REFERENCE) > run::MAX_STEPS {
        return Err(RunError("the runs would take too many steps; shorten them with --until".into()));
    }
    let case = Case { lab, model, programs, targets, interval: coarse, count };
    let targets = &case.targets;
    let sample = |kind: i32, h: f64| samples(&case, kind, h);
    let reference = sample(integrator::RK4, finest / REFERENCE as f64);
    let check = sample(integrator::RK4, 2.0 * finest / REFERENCE as f64);

    let uncertainty: Vec<f64> = (0..targets.len())
        .map(|i| {
            if targets[i].exact.is_some() {
                f64::NAN
            } else {
                largest_difference(&check.values[i], &reference.values[i])
            }
        })
        .collect();
    let mut rows: Vec<Row> = Vec::new();
    'runs: for (kind, name) in INTEGRATORS {
        for factor in STEPS {
            let h = own * factor;
            let s = sample(kind, h);
            if interrupt::requested() {
                break 'runs;
            }
            let truth =
                |i: usize| if targets[i].exact.is_some() { &s.exact[i] } else { &reference.values[i] };
            let errors: Vec<f64> =
                (0..targets.len()).map(|i| largest_difference(&s.values[i], truth(i))).collect();
            let diverged = s.diverged || errors.iter().any(|e| !e.is_finite());
            let cost = 1e6 * s.seconds / (count as f64 * coarse);
            rows.push(Row { integrator: name, timestep: h, errors, orders: Vec::new(), cost, diverged });
        }
    }
    let magnitude: Vec<f64> =
        reference.values.iter().map(|v| v.iter().fold(0.0f64, |m, x| m.max(x.abs()))).collect();
    observe_orders(&mut rows, &uncertainty, &magnitude);
    Ok(Report {
        uncertainty,
        traces: targets.iter().map(|t| t.label.to_string()).collect(),
        truth: targets
            .iter()
            .map(|t| if t.exact.is_some() { Truth::ClosedForm } else { Truth::TinySteps })
            .collect(),
        length: count as f64 * coarse,
        rows,
    })
}

/// The observed order of each trace: log₂ of the ratio of errors when the timestep halves. Errors that rounding
/// or the reference leave uncertain do not shrink with the step, and have none.
fn observe_orders(rows: &mut [Row], uncertainty: &[f64], magnitude: &[f64]) {
    let worst = |i: usize| rows.iter().map(|r| r.errors[i]).filter(|e| e.is_finite()).fold(0.0f64, f64::max);
    // A trace may itself be a difference of large numbers: then its own size says nothing about rounding.
    let floor: Vec<f64> = (0..magnitude.len())
        .map(|i| (4.0 * uncertainty[i]).max(1e-12 * magnitude[i]).max(1e-10 * worst(i)))
        .collect();
    for r in 0..rows.len() {
        let order = |i: usize| {
            let (p, now) = (rows.get(r.checked_sub(1)?)?, &rows[r]);
            let same = p.integrator == now.integrator && !p.diverged && !now.diverged;
            let order = (p.errors[i] / now.errors[i]).log2() / (p.timestep / now.timestep).log2();
            (same && order.is_finite() && now.errors[i] > floor[i]).then_some(order)
        };
        let orders = (0..magnitude.len()).map(order).collect();
        rows[r].orders = orders;
    }
}

/// The traces of a lab; when the author gives closed forms, only those that have one.
fn targets<'a>(
    lab: &'a Lab,
    model: &Model,
    programs: &'a Programs,
    findings: &mut Vec<Finding>,
) -> Vec<Target<'a>> {
    let names = ModelNames::new(model, Scope::Lab).with(&programs.functions);
    let exact = lab.verify.as_ref().map_or(&[][..], |v| &v.exact);
    let mut all = Vec::new();
    for (trace, probe) in lab.traces().zip(&programs.probes) {
        let Some(bound) = &probe.bound else { continue };
        let closed =
            exact.iter().find(|e| e.trace.value == trace.label.value).map(|e| &e.form).and_then(|text| {
                let mut globals = programs.globals.clone();
                let compiled = Compiler::new(&names, &mut globals).expression(&text.value);
                findings.extend(compiled.diagnostics.iter().map(|d| to_finding(d, text)));
                compiled.program.map(|program| Bound { text: text.clone(), program })
            });
        all.push(Target { label: &trace.label.value, bound, exact: closed });
    }
    if all.iter().any(|t| t.exact.is_some()) {
        all.retain(|t| t.exact.is_some());
    }
    all
}

fn start<'p>(lab: &Lab, model: &Model, programs: &'p Programs) -> Session<'p> {
    let key = lab.keyframe();
    Session::start(programs, model, key, &programs.demand)
}

/// What all runs of a comparison share.
struct Case<'a> {
    lab: &'a Lab,
    model: &'a Model,
    programs: &'a Programs,
    targets: Vec<Target<'a>>,
    /// Time between samples, s, and their number.
    interval: f64,
    count: usize,
}

fn samples(case: &Case<'_>, kind: i32, h: f64) -> Samples {
    let Case { targets, count, .. } = case;
    let per_sample = (case.interval / h).round() as usize;
    let mut session = start(case.lab, case.model, case.programs);
    let opt = session.world.model.edit().opt;
    (*opt.timestep, *opt.integrator) = (h, kind);
    let mut s = Samples {
        values: vec![Vec::new(); targets.len()],
        exact: vec![Vec::new(); targets.len()],
        diverged: false,
        seconds: 0.0,
    };
    let mut clock = Instant::now();
    let played = Play { every: per_sample, ..Play::steps(count * per_sample) };
    run::play(&mut session, &played, |session, made| {
        s.seconds += clock.elapsed().as_secs_f64();
        // The start is the same for all.
        for (i, t) in targets.iter().enumerate().filter(|_| made > 0) {
            let mut value =
                |b: &Bound| session.evaluate(&b.program, &b.text).map_or(f64::NAN, |v| v.to_number());
            s.values[i].push(value(t.bound));
            s.exact[i].push(t.exact.as_ref().map_or(f64::NAN, &mut value));
        }
        clock = Instant::now();
        ControlFlow::Continue(())
    });
    // Where a run ended before its time, nothing is known.
    s.values.iter_mut().chain(&mut s.exact).for_each(|list| list.resize(*count, f64::NAN));
    s.diverged = [Warning::BadQpos, Warning::BadQvel, Warning::BadQacc]
        .iter()
        .any(|&w| session.warnings[w as usize].number > 0);
    s
}

fn largest_difference(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| (x - y).abs()).fold(0.0, |m, d| if d.is_nan() { f64::NAN } else { d.max(m) })
}
