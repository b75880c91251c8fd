//! Whether the precision of a search decides a claim. A search stops when it knows its limit to its `tol`: the limit is
//! anywhere in a bracket of that length. A claim that some limits in the bracket make true and others false cannot be
//! checked.

use super::bound::BoundVerify;
use super::format::significant;
use super::outcome::MeasuredRuns;
use crate::finding::Finding;
use crate::rules::Rule;
use crate::source::Text;
use crate::spec::Find;
use labspec_expr::Value;
use std::ops::Range;

/// Number of parts into which a bracket is divided.
const PARTS: usize = 32;
/// Number of tolerances that are tried for a proposal, each a tenth of the one before.
const PROPOSALS: i32 = 12;

/// A claim that reads a search.
pub(super) struct BracketClaim<'c> {
    pub(super) text: &'c Text,
    /// The span and the rule of the finding.
    pub(super) place: Range<usize>,
    pub(super) rule: &'static Rule,
    /// Whether the claim has the same result for all these values of its expression.
    pub(super) agrees: &'c dyn Fn(&[Value]) -> bool,
}

/// Reports a claim that the bracket of a search does not decide, and returns the reason.
pub(super) fn report_undecided_bracket(
    bound: &BoundVerify<'_>,
    outcome: &MeasuredRuns,
    claim: &BracketClaim<'_>,
    findings: &mut Vec<Finding>,
) -> Option<String> {
    let read = bound.verify.find.iter().enumerate().filter(|(i, _)| bound.reads_found(claim.text, *i));
    for (i, find) in read {
        let Some(bracket) = outcome.bracket(i) else { continue };
        let agrees = |bracket| (claim.agrees)(&values_in(bound, outcome, claim.text, i, bracket));
        if agrees(bracket) {
            continue;
        }
        let [low, high] = [bracket[0].min(bracket[1]), bracket[0].max(bracket[1])].map(significant);
        let message = format!(
            "`{}` is between {low} and {high}; this interval is too wide to decide the claim",
            find.name.value
        );
        let tol = significant(find.tol.value);
        findings.push(
            Finding::error(claim.rule, claim.place.clone(), message.clone())
                .why(format!("the search finds the limit only to within its `tol` of {tol}"))
                .help(describe_finer(find, bracket, &agrees))
                .related(find.tol.span.clone(), "the precision of the search"),
        );
        return Some(message);
    }
    None
}

/// The values of an expression for limits throughout a bracket; NaN where it has none.
fn values_in(
    bound: &BoundVerify<'_>,
    outcome: &MeasuredRuns,
    text: &Text,
    index: usize,
    [value, other]: [f64; 2],
) -> Vec<Value> {
    let mut tried = outcome.clone();
    let at = |part: usize| value + (other - value) * part as f64 / PARTS as f64;
    let mut value_at = |limit: f64| {
        if let Some((_, found)) = tried.found.get_mut(index) {
            *found = limit;
        }
        let found = bound.find(&tried, text, &mut Vec::new());
        found.map_or(Value::Number(f64::NAN), |found| found.value)
    };
    (0..=PARTS).map(|part| value_at(at(part))).collect()
}

/// Proposes a precision that decides the claim, if the limit remains near the value that was found.
fn describe_finer(find: &Find, [value, other]: [f64; 2], agrees: &dyn Fn([f64; 2]) -> bool) -> String {
    let largest = 10f64.powf((other - value).abs().log10().floor());
    let tolerances = (0..PROPOSALS).map(|k| largest / 10f64.powi(k)).filter(|tol| *tol < find.tol.value);
    let mut finer = tolerances.filter(|tol| agrees([value, value + tol.copysign(other - value)]));
    match finer.next() {
        Some(tol) => format!("search more precisely: write `\"tol\": {}`", significant(tol)),
        None => "ask about a value that is farther from the limit".to_string(),
    }
}

/// Whether all values are numbers and the claim about them has the same result: they are all accepted, or none is, and the
/// number that is claimed is not among them.
pub(super) fn numbers_agree(values: &[Value], claimed: f64, accepts: &dyn Fn(f64) -> bool) -> bool {
    let numbers: Vec<f64> = values.iter().map(Value::to_number).collect();
    let low = numbers.iter().copied().fold(f64::INFINITY, f64::min);
    let high = numbers.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let accepted = numbers.iter().filter(|x| accepts(**x)).count();
    let is_among = low <= claimed && claimed <= high;
    numbers.iter().all(|x| !x.is_nan()) && (accepted == numbers.len() || accepted == 0 && !is_among)
}

/// Whether a condition has the same result for all values.
pub(super) fn conditions_agree(values: &[Value]) -> bool {
    let is_nan = |value: &Value| matches!(value, Value::Number(x) if x.is_nan());
    let holds = values.iter().filter(|value| value.truthy()).count();
    (holds == 0 || holds == values.len()) && !values.iter().any(is_nan)
}
