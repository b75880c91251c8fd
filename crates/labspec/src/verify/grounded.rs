//! The value of an expression if a claim may rely on it, or the reason why not.

use super::bound::BoundVerify;
use super::condition;
use super::format::shorten;
use super::found::{Cause, MeasuredValue, Undecided};
use super::layout::name_of_axis;
use super::no_value::{self, MissingMeasure};
use super::outcome::MeasuredRuns;
use super::unstopped::refuse_run_length;
use crate::finding::Finding;
use crate::rules;
use crate::source::Text;
use labspec_expr::Value;

/// The value of an expression if a claim may rely on it. It must have a value, must depend on the measured values that it
/// reads, must not be decided by a NaN, and the runs that it reads must not break. Otherwise returns the reason, which is
/// also reported.
pub(super) fn grounded_value(
    bound: &BoundVerify<'_>,
    outcome: &MeasuredRuns,
    text: &Text,
    findings: &mut Vec<Finding>,
) -> Result<MeasuredValue, String> {
    let found = decided_value(bound, outcome, text, findings)?;
    // A value that is not finite gets its own finding.
    let some = !matches!(found.value, Value::Number(x) if !x.is_finite());
    if some && (found.unread || !bound.could_differ(&found, None)) {
        // The finding about the runs says why.
        if bound.compares_same_runs(&found) && findings.iter().any(|f| f.code == rules::IDENTICAL_RUNS.code) {
            return Err(format!("`{}` compares a simulation with itself", shorten(text.value.trim())));
        }
        return Err(report_constant_claim(text, findings));
    }
    Ok(found)
}

/// Like [`grounded_value`], for perturbed numerics: the claim is not tested with other values again.
pub(super) fn decided_value(
    bound: &BoundVerify<'_>,
    outcome: &MeasuredRuns,
    text: &Text,
    findings: &mut Vec<Finding>,
) -> Result<MeasuredValue, String> {
    if condition::is_bare_constant(&text.value) {
        let message = format!("`{}` is a constant and proves nothing", text.value.trim());
        findings.push(
            Finding::error(rules::CONSTANT_CLAIM, text.span(), message.clone())
                .why("it gives the same result whatever the simulation does, so it checks nothing")
                .help("compare something that a run measures, or write the formula that gives the number"),
        );
        return Err(message);
    }
    let found = bound.find(outcome, text, findings).ok_or("the expression cannot be evaluated")?;
    if let Some(broke) = &found.broke {
        return Err(broke.clone());
    }
    match &found.undecided {
        Some(undecided) => Err(report_undecided(bound, outcome, text, undecided, findings)),
        None => refuse_run_length(bound, outcome, &found, text, findings).map(|()| found),
    }
}

/// Reports an expression whose value is the same for all measured values.
pub(super) fn report_constant_claim(text: &Text, findings: &mut Vec<Finding>) -> String {
    let message = format!(
        "`{}` gives the same result whatever the runs give, so it proves nothing",
        shorten(text.value.trim())
    );
    findings.push(
        Finding::error(rules::CONSTANT_CLAIM, text.span(), message.clone())
            .why("other values in place of the measured ones did not change it")
            .help("compare a measure of a run with a value that it could fail to match"),
    );
    message
}

/// Reports an expression that is decided by a NaN.
pub(super) fn report_undecided(
    bound: &BoundVerify<'_>,
    outcome: &MeasuredRuns,
    text: &Text,
    undecided: &Undecided,
    findings: &mut Vec<Finding>,
) -> String {
    let part = shorten(&undecided.part_of(text));
    match &undecided.cause {
        Some(Cause::Measure { run, measure, no_value }) => {
            let missing = MissingMeasure { run: *run, measure: *measure, no_value: no_value.as_ref(), text };
            return no_value::report_missing(bound, outcome, &missing, findings);
        }
        Some(Cause::Search(name)) => {
            findings.push(
                Finding::error(rules::COMPARES_NAN, text.span(), format!("`{part}` compares NaN"))
                    .why(format!("a comparison with NaN says nothing about the claim: `{name}` was not found"))
                    .help("correct the search, or test for it with `isNaN(x)`"),
            );
        }
        Some(Cause::SeveralAxes) => {
            let help = format!("name the values, as in `slope(run.measure, run.{})`", name_of_axis(1));
            findings.push(
                Finding::error(rules::CLAIM_WITHOUT_NUMBER, text.span(), format!("`{part}` has no value"))
                    .why("the sweep changes several quantities, so no single list of values belongs to its measures")
                    .help(help),
            );
            return format!("`{part}` has no value");
        }
        None => findings.push(
            Finding::error(rules::COMPARES_NAN, text.span(), format!("`{part}` compares NaN"))
                .why("a comparison with NaN says nothing about the claim: it divides zero by zero, or takes a root or logarithm of a negative number")
                .help("correct the expression, or test for NaN with `isNaN(x)`"),
        ),
    }
    format!("`{part}` compares NaN")
}
