//! Closed forms: whether a trace follows the formula that the author gives.
//!
//! With a tolerance, the trace must stay within it. Without one, the convergence of the lab decides: the error of a method
//! of order p decreases as hᵖ with the timestep h, so the difference that remains after Richardson extrapolation
//! (Richardson 1911) is the error of the formula. For a correct formula this remainder is smaller than the difference
//! between the extrapolations. For a wrong formula the remainder is the error of the formula.

use super::bound::BoundVerify;
use super::format::significant;
use super::run_cache::{BoundLab, RunCache};
use crate::bind::{Bound, ModelNames, Programs, Scope, functions, include, to_finding};
use crate::finding::Finding;
use crate::json::nearest;
use crate::ledger::{Evidence, State};
use crate::rules;
use crate::run::{self, Budget, End, Play, Session, Start};
use crate::spec::{Exact, Lab};
use labspec_core::reflect::{FieldId, Object, data};
use labspec_core::{Model, Plan, integrator};
use labspec_expr::{Access, Compiler, Program};
use serde::{Deserialize, Serialize};
use std::ops::{ControlFlow, Range};

/// Maximum number of steps of the run at the timestep of the lab. The other runs take two and four times as many.
const MAX_STEPS: usize = 50_000;
/// Number of samples of a run.
const SAMPLES: usize = 500;
/// Rounding error of a trace, relative to its size.
const ROUNDING: f64 = 1e-9;
/// Fractions of the range of a trace: the uncertainty up to which a formula without a tolerance is confirmed, and the
/// largest accepted distance of the trace from the formula at the timestep of the lab.
const MAX_UNCERTAINTY: f64 = 0.01;
const MAX_DISTANCE: f64 = 0.1;

/// A tolerance that is a larger fraction of the change of the formula, or of the values if the formula is constant, does not tell
/// the trace from others. `NOISE` is the difference that rounding alone produces.
const WIDE_TOLERANCE: f64 = 0.25;
const WIDE_CONSTANT_TOLERANCE: f64 = 0.5;
const NOISE: f64 = 1e-12;

/// The result of checking the closed form of a trace.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ClosedForm {
    /// Label of the trace.
    pub trace: String,
    /// Its span in the lesson.
    pub span: Range<usize>,
    /// The state of the claim.
    pub state: State,
    /// The reason why it is not true, or the evidence that it is.
    pub remark: String,
}

impl ClosedForm {
    /// A closed form that could not be checked.
    pub(super) fn unchecked(exact: &Exact, reason: &str) -> ClosedForm {
        ClosedForm {
            trace: exact.trace.value.clone(),
            span: exact.trace.span(),
            state: State::Unchecked,
            remark: reason.to_string(),
        }
    }
}

/// The values of the trace and of its closed form at common times.
struct Differences {
    times: Vec<f64>,
    values: Vec<[f64; 2]>,
}

impl Differences {
    fn difference(&self, i: usize) -> f64 {
        self.values.get(i).map_or(f64::NAN, |[trace, form]| trace - form)
    }

    /// The range of the trace, or its magnitude if it is constant.
    fn range(&self) -> f64 {
        let traces = || self.values.iter().map(|[trace, _]| *trace);
        let [least, most] =
            [traces().fold(f64::INFINITY, f64::min), traces().fold(f64::NEG_INFINITY, f64::max)];
        let range = most - least;
        if range > ROUNDING * self.size() { range } else { self.size() }
    }

    /// The difference between the largest and the smallest value of the formula; `None` if it is constant.
    fn change_of_form(&self) -> Option<f64> {
        let forms = || self.values.iter().map(|[_, form]| *form);
        let change = forms().fold(f64::NEG_INFINITY, f64::max) - forms().fold(f64::INFINITY, f64::min);
        (change > ROUNDING * self.size()).then_some(change)
    }

    fn size(&self) -> f64 {
        self.values.iter().flatten().fold(0.0, |m: f64, x| m.max(x.abs()))
    }
}

/// Compares a trace with its closed form. Errors are added to `findings`.
pub(super) fn check_closed_form(
    bound: &BoundVerify<'_>,
    claim: &Exact,
    findings: &mut Vec<Finding>,
) -> ClosedForm {
    let (traces, form) = match bind_closed_form(bound, claim, findings) {
        Ok((traces, form)) => (traces, form),
        Err(reason) => return ClosedForm::unchecked(claim, reason),
    };
    // A label that several plots have denotes all these traces. The worst result counts.
    let held = traces.into_iter().map(|trace| hold(bound, claim, trace, &form, findings));
    let worst = |a: ClosedForm, b: ClosedForm| if rank(b.state) > rank(a.state) { b } else { a };
    held.reduce(worst).unwrap_or_else(|| ClosedForm::unchecked(claim, "the lab has no such trace"))
}

fn rank(state: State) -> u8 {
    match state {
        State::True(_) => 0,
        State::False => 2,
        _ => 1,
    }
}

/// Compares one trace with the closed form.
fn hold(
    bound: &BoundVerify<'_>,
    claim: &Exact,
    trace: &Bound,
    form: &Bound,
    findings: &mut Vec<Finding>,
) -> ClosedForm {
    let unchecked = |reason: &str| ClosedForm::unchecked(claim, reason);
    let Some(BoundLab { lab, model, programs, .. }) = bound.lab() else { return unchecked("it has no lab") };
    let case = ClosedFormRuns { lab, model, programs, trace, form };
    let mut runs = Vec::new();
    for parts in [1, 2, 4] {
        match case.run(parts, bound.stage()) {
            Ok(run) => runs.push(run),
            Err(reason) => {
                findings.push(
                    Finding::error(
                        rules::CLOSED_FORM_UNTRIED,
                        claim.form.span(),
                        format!("the closed form cannot be tested: {reason}"),
                    )
                    .why("nothing shows whether the trace follows it")
                    .help("fix the run or the expression"),
                );
                return unchecked(&reason);
            }
        }
        if claim.tol.is_some() {
            break;
        }
    }
    let (state, remark, wrong) = match (&claim.tol, runs.as_slice()) {
        (Some(tol), [run, ..]) => within(tol.value, run),
        (None, [h, half, quarter]) => converges(case.order(), h, half, quarter),
        _ => (State::Unchecked, "no run was made".to_string(), None),
    };
    if let Some(wrong) = wrong {
        findings.push(wrong.finding(claim));
    } else if state == State::Unchecked {
        findings.push(
            Finding::error(
                rules::CLOSED_FORM_UNDECIDED,
                claim.form.span(),
                format!("the runs do not decide whether the trace follows \"{}\": {remark}", claim.trace.value),
            )
            .why(match &claim.tol {
                None => "the difference between the trace and the formula neither vanishes nor settles as the timestep shrinks",
                Some(_) => "with this tolerance, nearly any curve would count as following the formula",
            })
            .help("state the allowed difference: {\"is\": \"…\", \"tol\": 0.001}"),
        );
    }
    ClosedForm { trace: claim.trace.value.clone(), span: claim.trace.span(), state, remark }
}

/// The traces of the label and their closed form as programs. Errors are added to `findings`.
pub(super) fn bind_closed_form<'b>(
    bound: &'b BoundVerify<'_>,
    claim: &Exact,
    findings: &mut Vec<Finding>,
) -> Result<(Vec<&'b Bound>, Bound), &'static str> {
    let BoundLab { lab, model, programs, .. } = bound.lab().ok_or("it has no lab")?;
    let named =
        lab.traces().zip(&programs.probes).filter(|(trace, _)| trace.label.value == claim.trace.value);
    let probes: Vec<_> = named.map(|(_, probe)| probe.bound.as_ref()).collect();
    if probes.is_empty() {
        findings.push(unknown_trace(claim, lab));
        return Err("the lab has no such trace");
    }
    let names = ModelNames::new(model, Scope::Lab).with(&programs.functions);
    let mut globals = programs.globals.clone();
    let compiled = Compiler::new(&names, &mut globals).linting().expression(&claim.form.value);
    findings.extend(compiled.diagnostics.iter().map(|d| to_finding(d, &claim.form)));
    let form = compiled.program.map(|program| Bound { text: claim.form.clone(), program });
    let traces: Option<Vec<&Bound>> = probes.into_iter().collect();
    let (traces, form) = traces.zip(form).ok_or("the trace or its closed form has errors")?;
    if traces.iter().any(|trace| reads_the_run(&trace.program, programs).is_none()) {
        findings.push(
            Finding::error(
                rules::CLOSED_FORM_UNTRIED,
                claim.trace.span(),
                format!("the trace \"{}\" reads nothing that is simulated", claim.trace.value),
            )
            .why("two formulas of time are compared, so the run shows nothing about either")
            .help("let the trace read the data of the run, such as `data.qpos[0]`"),
        );
        return Err("the trace reads nothing that is simulated");
    }
    if let Some(what) = reads_the_run(&form.program, programs) {
        findings.push(no_formula(claim, &what));
        return Err("the closed form reads computed values of the simulation");
    }
    Ok((traces, form))
}

/// The simulation data that a closed form reads besides the time; `None` for a formula of time and parameters.
fn reads_the_run(form: &Program, programs: &Programs) -> Option<String> {
    let effects = form.effects();
    let of_data = |access: &Access| {
        let field = FieldId::new(access.field.0 as usize)?;
        (field.info().object == Object::Data && field != data::time)
            .then(|| format!("`data.{}`", field.info().name))
    };
    if let Some(field) = effects.reads.iter().find_map(of_data) {
        return Some(field);
    }
    if effects.reads_everything || effects.calls_values || effects.calls.iter().any(|f| functions::reads(*f))
    {
        return Some("a function that reads the simulation".to_string());
    }
    // Values that the lab writes to `ctx` or to the model during the run are unknown.
    let running = programs
        .controller
        .iter()
        .map(|b| &b.program)
        .chain(programs.probes.iter().filter_map(|p| p.bound.as_ref()).map(|b| &b.program));
    for program in running.map(Program::effects) {
        let may_write = |slot: &u32| program.any_ctx || program.ctx_writes.contains(slot);
        if effects.any_ctx || effects.ctx_reads.iter().any(may_write) {
            return Some("a variable of `ctx` that the lab writes while it runs".to_string());
        }
        let written =
            |a: &Access| program.writes_everything || program.writes.iter().any(|w| w.field == a.field);
        if effects.reads.iter().any(|a| written(a) && !is_time(a)) {
            return Some("a field that the lab writes while it runs".to_string());
        }
    }
    None
}

fn is_time(access: &Access) -> bool {
    FieldId::new(access.field.0 as usize).is_some_and(|f| f.info().object == Object::Data)
}

fn no_formula(claim: &Exact, what: &str) -> Finding {
    let message = format!("this closed form reads {what}");
    Finding::error(rules::CLOSED_FORM_UNTRIED, claim.form.span(), message)
        .why("the trace would follow it in every run, because the same run computes both")
        .help("write a formula of `data.time` and parameters of the lab")
}

fn unknown_trace(claim: &Exact, lab: &Lab) -> Finding {
    let labels: Vec<&str> = lab.traces().map(|t| t.label.as_str()).collect();
    let message = format!("the lab has no trace \"{}\"", claim.trace.value);
    let finding = Finding::error(rules::UNKNOWN_TRACE, claim.trace.span(), message)
        .why("the closed form has no trace to compare with");
    match nearest(&claim.trace.value, labels.iter().copied()) {
        Some(right) => finding.help(format!("did you mean \"{right}\"?")),
        None if labels.is_empty() => finding.help("add a plot with a trace of this label"),
        None => finding.help(format!("use one of its traces: \"{}\"", labels.join("\", \""))),
    }
}

/// The point at which a trace deviates from its closed form.
struct LargestDeviation {
    time: f64,
    trace: f64,
    form: f64,
    how: String,
}

impl LargestDeviation {
    fn finding(&self, claim: &Exact) -> Finding {
        let message = format!(
            "the trace \"{}\" does not follow its closed form: at t = {} s it is {}, but the formula gives {}",
            claim.trace.value,
            significant(self.time),
            significant(self.trace),
            significant(self.form)
        );
        Finding::error(rules::CLOSED_FORM_WRONG, claim.form.span(), message)
            .why(self.how.clone())
            .help("correct the formula, or the lab that it describes")
    }
}

type Comparison = (State, String, Option<LargestDeviation>);

/// Whether the trace stays within a tolerance.
fn within(tol: f64, run: &Differences) -> Comparison {
    let (i, worst) = largest(run.times.len(), |i| run.difference(i));
    let difference =
        format!("they differ by at most {}, the tolerance is {}", significant(worst), significant(tol));
    // Near zero, both values are noise, and no tolerance is too large for them.
    let noise = worst <= NOISE;
    let (scale, wide, what) = match run.change_of_form() {
        Some(change) => (change, WIDE_TOLERANCE, "the formula changes by only"),
        None => (run.size(), WIDE_CONSTANT_TOLERANCE, "no value exceeds"),
    };
    if worst <= tol && tol > wide * scale && !noise {
        let how = format!(
            "a tolerance of {} is too wide to distinguish the formula from other curves: {what} {}",
            significant(tol),
            significant(scale)
        );
        return (State::Unchecked, how, None);
    }
    if worst <= tol {
        return (State::True(Evidence::Simulated), difference, None);
    }
    (State::False, difference.clone(), wrong(run, i, run.difference(i), difference))
}

/// Whether the difference vanishes as the timestep decreases.
fn converges(order: i32, h: &Differences, half: &Differences, quarter: &Differences) -> Comparison {
    let n = h.times.len();
    let power = f64::from(2_i32.pow(order.unsigned_abs()));
    let extrapolated = |coarse: &Differences, fine: &Differences, i: usize| {
        (power * fine.difference(i) - coarse.difference(i)) / (power - 1.0)
    };
    let errors = [h, half, quarter].map(|run| largest(n, |i| run.difference(i)).1);
    let rounding = ROUNDING * quarter.size().max(h.size());
    let list = errors.map(significant).join(", ");
    let shrinks = format!("they differ by {list} at the timestep of the lab, at half and at a quarter of it");
    if errors.iter().all(|e| *e <= rounding) {
        return (State::True(Evidence::Simulated), "equal except for rounding".into(), None);
    }
    let (i, left) = largest(n, |i| extrapolated(half, quarter, i));
    let (_, unsure) = largest(n, |i| extrapolated(half, quarter, i) - extrapolated(h, half, i));
    let vanishing = errors[2] <= 0.75 * errors[0];
    let range = quarter.range();
    if vanishing && left <= unsure + rounding {
        // A formula that is confirmed only to more than a hundredth of the range of the trace is not accepted. Neither is
        // a formula that differs by more than a tenth of that range from the trace at the timestep of the lab.
        if unsure > MAX_UNCERTAINTY * range + rounding {
            let how = format!("{shrinks}, so the formula is confirmed only to {}", significant(unsure));
            return (State::Unchecked, how, None);
        }
        if errors[0] > MAX_DISTANCE * range + rounding {
            let how = format!("{shrinks}, and the trace ranges over {}", significant(range));
            return (State::Unchecked, how, None);
        }
        return (State::True(Evidence::Simulated), shrinks, None);
    }
    if left > 3.0 * unsure + rounding {
        let how = format!(
            "the difference does not vanish as the timestep shrinks, {} remains: {shrinks}",
            significant(left)
        );
        let difference = extrapolated(half, quarter, i);
        return (State::False, how.clone(), wrong(quarter, i, difference, how));
    }
    (State::Unchecked, shrinks, None)
}

/// The extrapolated trace and the formula, at the point of the largest difference.
fn wrong(run: &Differences, i: usize, difference: f64, how: String) -> Option<LargestDeviation> {
    let [_, form] = *run.values.get(i)?;
    Some(LargestDeviation { time: *run.times.get(i)?, trace: form + difference, form, how })
}

/// The index and the magnitude of the largest of `n` numbers.
fn largest(n: usize, x: impl Fn(usize) -> f64) -> (usize, f64) {
    (0..n)
        .map(|i| (i, x(i).abs()))
        .fold((0, 0.0), |best, current| if current.1 > best.1 { current } else { best })
}

/// The common data of the runs.
struct ClosedFormRuns<'a> {
    lab: &'a Lab,
    model: &'a Model,
    programs: &'a Programs,
    trace: &'a Bound,
    form: &'a Bound,
}

impl ClosedFormRuns<'_> {
    /// Order of the integrator of the lab.
    fn order(&self) -> i32 {
        if self.start().world.model.opt.integrator == integrator::RK4 { 4 } else { 1 }
    }

    fn start(&self) -> Session<'_> {
        let mut access = self.programs.access;
        include(self.form.program.effects(), &mut access);
        let plan = Some(Plan::new(self.model, &access));
        let start = Start { key: self.lab.keyframe(), plan, budget: Budget::TRIAL };
        Session::start(self.programs, self.model, start)
    }

    /// Runs the lab with its timestep divided by `parts`. The sample times do not depend on `parts`.
    fn run(&self, parts: usize, stage: &RunCache<'_>) -> Result<Differences, String> {
        let mut session = self.start();
        let h = session.world.model.opt.timestep;
        let count = run::count_steps(self.lab, None, None, h).map_err(|e| e.message)?.clamp(1, MAX_STEPS);
        let every = count.div_ceil(SAMPLES);
        *session.world.model.edit().opt.timestep = h / parts as f64;
        let mut found = Differences { times: Vec::new(), values: Vec::new() };
        let mut gap = None;
        let played =
            Play { steps: count * parts, stop: None, every: every * parts, presses: &[], watched: true };
        run::play(&mut session, &played, |session, _| {
            let mut value =
                |b: &Bound| session.evaluate(&b.program, &b.text).map_or(f64::NAN, |v| v.to_number());
            let pair = [value(self.trace), value(self.form)];
            let time = session.world.data.time();
            if pair.iter().any(|x| !x.is_finite()) {
                gap = Some(time);
                return ControlFlow::Break(());
            }
            found.times.push(time);
            found.values.push(pair);
            ControlFlow::Continue(())
        });
        stage.note(session.has_uncoupled_change());
        if let Some(time) = gap {
            let time = significant(time);
            return Err(format!("at t = {time} s the trace or the formula is not a number"));
        }
        if let Some(End::Budget { time }) = session.ended() {
            return Err(format!("the work budget ran out at t = {} s", run::time(*time)));
        }
        if let Some(program_error) = session.program_errors.first() {
            return Err(program_error.message.clone());
        }
        match (run::worst_breakdown(&session), session.ended()) {
            (Some(breakdown), _) => Err(format!("the run breaks: {}", breakdown.what)),
            (None, Some(_)) => Err("the run ends early".to_string()),
            (None, None) => Ok(found),
        }
    }
}

#[cfg(test)]
mod tests {
    /// The codes of the findings about a closed form of a trace of a ball that falls from 1 m for 0.3 s.
    fn codes(trace: &str, form: &str, tol: f64) -> Vec<&'static str> {
        let lab = serde_json::json!({"stopAt": 0.3,
            "xml": "<mujoco><worldbody><body pos='0 0 1'><freejoint/><geom size='.05' mass='2'/></body></worldbody></mujoco>",
            "plots": [{"window": 0.3, "traces": [{"label": "trace", "expr": trace}]}],
            "verify": {"exact": {"trace": {"is": form, "tol": tol}}}})
        .to_string();
        let report = crate::Checker::new(|_: &str| None::<String>).check("lab.json", &lab);
        report.findings.iter().map(|f| f.code).filter(|code| code.starts_with("closed-form")).collect()
    }

    #[test]
    fn a_tolerance_tells_curves_apart() {
        let (height, law) = ("data.qpos[2]", "1 - 4.905 * data.time ** 2");
        for (form, tol, expected) in [
            (law, 0.01, None),
            (law, 0.1, None),
            // The ball falls by 0.44 m.
            (law, 0.2, Some("closed-form-undecided")),
            ("0.8", 0.3, None),
            ("0.8", 0.6, Some("closed-form-undecided")),
            ("1 - 4 * data.time ** 2", 0.05, Some("closed-form-wrong")),
        ] {
            assert_eq!(codes(height, form, tol), Vec::from_iter(expected), "{form} {tol}");
        }
    }

    #[test]
    fn a_trace_that_reads_nothing_is_no_evidence() {
        let form = "1 - 3 * data.time ** 2";
        for trace in [form, "model.body_mass[1] * 0.5 - 3 * data.time ** 2"] {
            assert_eq!(codes(trace, form, 0.01), ["closed-form-untried"], "{trace}");
        }
    }
}
