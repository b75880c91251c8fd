//! The finding about a measure without a value: which measure of which run, why, and the run that would give it one.

use super::bound::BoundVerify;
use super::bound_run::{BoundRun, CompiledText};
use super::format::significant;
use super::measure::NoValue;
use super::outcome::{MeasuredRun, MeasuredRuns};
use super::runner::{self, RunRequest};
use crate::finding::Finding;
use crate::json::Number;
use crate::json::read::named;
use crate::rules;
use crate::run::StepVariant;
use crate::source::Text;
use crate::spec::Run;
use std::borrow::Cow;

/// A measure without a value, and the claim that reads it.
#[derive(Clone, Copy)]
pub(super) struct MissingMeasure<'m> {
    /// The index of the run.
    pub(super) run: usize,
    /// The index of the measure; `None` for the aggregates of the claim itself.
    pub(super) measure: Option<usize>,
    /// The reason, if it is known.
    pub(super) no_value: Option<&'m NoValue>,
    /// The claim.
    pub(super) text: &'m Text,
}

/// What longer runs have shown.
enum LongerRun {
    /// A run of this length, s, gives the measure this value.
    Value { until: f64, value: f64 },
    /// A run of this length, s, gives it no value either.
    Nothing { until: f64 },
    /// The run ends by itself at this time, s.
    Stops { end: f64 },
}

/// The factors by which a run is made longer.
const FACTORS: [f64; 3] = [2.0, 4.0, 8.0];

/// Reports a measure without a value, once for all claims that read it. Returns the reason for the claims.
pub(super) fn report_missing(
    bound: &BoundVerify<'_>,
    outcome: &MeasuredRuns,
    missing: &MissingMeasure<'_>,
    findings: &mut Vec<Finding>,
) -> String {
    let run = outcome.runs.get(missing.run);
    let title = run.map_or(String::new(), MeasuredRun::title);
    let of_run = missing.measure.and_then(|measure| bound.measure_at(missing.run, measure));
    let name = run.zip(missing.measure).and_then(|(run, measure)| run.measures.get(measure));
    let what = match name {
        Some((name, _)) => format!("`{title}.{name}` has no value"),
        None => format!("this expression has no value in the run {}", named(&title)),
    };
    let without = own_aggregates(bound, missing);
    let sampled = of_run.or(without.as_ref());
    let text = sampled.map_or(missing.text, |measure| &*measure.text);
    let code = rules::MEASURE_WITHOUT_VALUE.code;
    if findings.iter().any(|f| f.code == code && f.span == text.span()) {
        return what;
    }
    if let Some(reported) = report_of_same_event(bound, outcome, missing, findings) {
        *reported = reported.clone().related(text.span(), format!("{what} for the same reason"));
        return what;
    }
    let end = run.map_or(0.0, |run| run.end);
    let mut finding = Finding::error(rules::MEASURE_WITHOUT_VALUE, text.span(), what.clone());
    let reason = match missing.no_value {
        Some(no_value) => no_value.to_string(),
        None => "it divides zero by zero, or its value is not a number".to_string(),
    };
    finding = finding.why(format!("{reason}; the run {} ends at {} s", named(&title), significant(end)));
    let is_event = matches!(missing.no_value, Some(NoValue::Event { .. }));
    let tried = sampled.filter(|_| is_event).and_then(|text| try_longer(bound, missing.run, text, end));
    let without = "or test for it with `isNaN(x)`";
    finding = finding.help(match tried {
        Some(LongerRun::Value { until, value }) => format!(
            "make the run longer: with `\"until\": {}` it is {}",
            significant(until),
            significant(value)
        ),
        Some(LongerRun::Nothing { until }) => format!(
            "correct the measure, {without}: it has no value with `\"until\": {}` either",
            significant(until)
        ),
        Some(LongerRun::Stops { end }) => format!(
            "let the run end later than at {} s, where its `stop` holds, or correct the measure, {without}",
            significant(end)
        ),
        None if is_event => {
            format!("correct the measure, {without}; no run of a greater length could be tested")
        }
        None => format!("correct the measure, {without}"),
    });
    if of_run.is_some() {
        finding = finding.related(missing.text.span(), "this claim reads it");
    }
    findings.push(finding);
    what
}

/// The finding about another measure of the run that waits for the same event.
fn report_of_same_event<'f>(
    bound: &BoundVerify<'_>,
    outcome: &MeasuredRuns,
    missing: &MissingMeasure<'_>,
    findings: &'f mut [Finding],
) -> Option<&'f mut Finding> {
    let (run, no_value) = (outcome.runs.get(missing.run)?, missing.no_value?);
    let same = run.without_value.iter().filter(|(_, other)| no_value.is_same_event(other));
    let places =
        run.measures.iter().enumerate().filter(|(_, (name, _))| same.clone().any(|(n, _)| n == name));
    let spans: Vec<_> = places
        .filter(|(i, _)| Some(*i) != missing.measure)
        .filter_map(|(i, _)| Some(bound.measure_at(missing.run, i)?.text.span()))
        .collect();
    let code = rules::MEASURE_WITHOUT_VALUE.code;
    findings.iter_mut().find(|f| f.code == code && spans.contains(&f.span))
}

/// The claim itself, if its own aggregates have no value.
fn own_aggregates<'m>(bound: &BoundVerify<'_>, missing: &MissingMeasure<'m>) -> Option<CompiledText<'m>> {
    let program = bound.claim(missing.text)?.program.clone().filter(|_| missing.measure.is_none())?;
    Some(CompiledText { text: Cow::Borrowed(missing.text), program })
}

/// Makes the run longer until the measure has a value.
fn try_longer(
    bound: &BoundVerify<'_>,
    run: usize,
    measure: &CompiledText<'_>,
    end: f64,
) -> Option<LongerRun> {
    let run = bound.runs.get(run)?;
    let scene = bound.scene_of(run)?;
    let mut last = None;
    for factor in FACTORS {
        // Half of the work remains for the claims that are still to be checked.
        if !bound.stage().has_half_its_work() || end.is_nan() || end <= 0.0 {
            break;
        }
        let until: f64 = format!("{:.1e}", factor * end).parse().ok()?;
        let longer = with_length(run.spec, until);
        let longer = BoundRun { spec: Some(&longer), ..run.clone() };
        let place = measure.text.span();
        let measures = [measure];
        let request =
            RunRequest { scene, run: &longer, numerics: StepVariant::NOMINAL, measures: &measures, place };
        let made = runner::execute_run(&request, bound.stage(), &mut Vec::new())?;
        let value = made.values.first()?.value;
        match made.broke {
            Some(_) => break,
            None if value.is_finite() => return Some(LongerRun::Value { until, value }),
            None if made.end < 0.9 * until => return Some(LongerRun::Stops { end: made.end }),
            None => last = Some(LongerRun::Nothing { until }),
        }
    }
    last
}

/// The run with another length.
fn with_length(run: Option<&Run>, until: f64) -> Run {
    let until = Some(Number { value: until, span: 0..0 });
    match run {
        Some(run) => Run { until, steps: None, ..run.clone() },
        None => Run { until, ..Run::named("run") },
    }
}
