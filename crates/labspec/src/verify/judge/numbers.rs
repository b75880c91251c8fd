//! Substitutes the numbers of a reference engine for ours, and compares them.

use super::task::own_texts;
use super::{Difference, Judged, Reference};
use crate::spec::Verify;
use crate::verify::bound::BoundVerify;
use crate::verify::numerics::{PERTURBED_START, TIGHT_SOLVER};
use crate::verify::outcome::MeasuredRuns;

/// Numbers are equal if they differ by less than this fraction, or by less than a thousandth of it near zero.
const RELATIVE_TOLERANCE: f64 = 1e-6;
/// A difference below this factor times the effect of a perturbed start or a converged solver is not attributed to the
/// engine.
const NUMERICS: f64 = 2.0;

/// Our outcome with the reference values in place of ours, where they exist.
pub(super) fn replaced(
    bound: &BoundVerify<'_>,
    verify: &Verify,
    nominal: &MeasuredRuns,
    reference: &Reference<'_>,
    judged: &mut Judged,
) -> MeasuredRuns {
    let mut outcome = nominal.clone();
    let unknown = || Err("its run is not recorded".to_string());
    for (i, run) in outcome.runs.iter_mut().enumerate() {
        let title = run.title();
        let recorded = match reference.runs.get(i).cloned().unwrap_or_else(unknown) {
            Ok(recorded) => recorded,
            Err(why) => {
                let names = run.measures.iter().map(|(m, _)| (format!("{title}.{m}"), why.clone()));
                judged.unjudged.extend(names);
                continue;
            }
        };
        for (name, x) in &mut run.measures {
            match recorded.values.get(name) {
                Some(value) => *x = *value,
                None => {
                    let why = recorded.refused.get(name).map_or("it is not recorded", String::as_str);
                    judged.unjudged.push((format!("{title}.{name}"), why.to_string()));
                }
            }
        }
        // A breakdown that only our monitors detect, such as energy growth, is kept. A warning about bad numbers that only
        // our run has is not.
        let only_nominal = run.warnings > 0 && recorded.warnings == 0;
        run.broke = recorded.broke.clone().or(run.broke.take().filter(|_| !only_nominal));
        run.warnings = recorded.warnings;
    }
    for text in own_texts(bound, verify) {
        let recorded = reference.runs.first().and_then(|run| run.as_ref().ok());
        match recorded.and_then(|t| t.values.get(&text.value)) {
            Some(x) => outcome.elsewhere.push((text.value.clone(), *x)),
            None => {
                let why = recorded.and_then(|t| t.refused.get(&text.value));
                let why = why.map_or("it is not recorded", String::as_str);
                judged.unjudged.push((text.value.clone(), why.to_string()));
            }
        }
    }
    outcome
}

/// Compares both outcomes.
pub(super) fn compare(
    bound: &BoundVerify<'_>,
    verify: &Verify,
    nominal: &MeasuredRuns,
    replaced: &MeasuredRuns,
    reference: &Reference<'_>,
    judged: &mut Judged,
) {
    let mut other: Option<Vec<Vec<f64>>> = None;
    let numbers = |outcome: &MeasuredRuns| -> Vec<(String, f64)> {
        let own_values = own_texts(bound, verify).into_iter().map(|text| {
            let found = bound.find(outcome, text, &mut Vec::new());
            (text.value.clone(), found.map_or(f64::NAN, |f| f.value.to_number()))
        });
        let titled = outcome.runs.iter().flat_map(|run| {
            let title = run.title();
            run.measures.iter().map(move |(m, x)| (format!("{title}.{m}"), *x))
        });
        titled.chain(own_values).collect()
    };
    for (i, ((name, a), (_, b))) in numbers(nominal).into_iter().zip(numbers(replaced)).enumerate() {
        if judged.unjudged.iter().any(|(unjudged, _)| *unjudged == name) {
            continue;
        }
        judged.compared += 1;
        let difference = (a - b).abs();
        let same = a == b
            || a.is_nan() && b.is_nan()
            || difference <= RELATIVE_TOLERANCE * a.abs().max(b.abs()) + 1e-3 * RELATIVE_TOLERANCE;
        if same {
            continue;
        }
        let others = other.get_or_insert_with(|| {
            let made = [PERTURBED_START, TIGHT_SOLVER].map(|n| bound.outcome(n, &mut Vec::new()));
            made.iter().flatten().map(|o| numbers(o).into_iter().map(|(_, x)| x).collect()).collect()
        });
        let moved = others.iter().filter_map(|list| list.get(i)).map(|x| (x - a).abs()).fold(0.0, f64::max);
        if difference.is_nan() || difference > NUMERICS * moved {
            let no_value = why_nan(reference, nominal, &name, [a, b]);
            judged.differing.push(Difference { name, labspec_value: a, reference_value: b, no_value });
        }
    }
}

/// Why our value or the reference value of a measure is NaN.
fn why_nan(
    reference: &Reference<'_>,
    nominal: &MeasuredRuns,
    name: &str,
    [labspec_value, reference_value]: [f64; 2],
) -> Option<String> {
    let runs = nominal.runs.iter().zip(&reference.runs);
    let mut reasons = runs.filter_map(|(run, recorded)| {
        let measure = name.strip_prefix(&run.title()).and_then(|rest| rest.strip_prefix('.'));
        let no_labspec_value = || {
            let found = run.without_value.iter().find(|(other, _)| Some(other.as_str()) == measure);
            found.map(|(_, why)| format!("{why} here"))
        };
        let no_reference_value = || {
            let why = recorded.as_ref().ok()?.without_value.get(measure.unwrap_or(name))?;
            Some(format!("{why} there"))
        };
        match (labspec_value.is_nan(), reference_value.is_nan()) {
            (true, false) => no_labspec_value(),
            (false, true) => no_reference_value(),
            _ => None,
        }
    });
    reasons.next()
}
