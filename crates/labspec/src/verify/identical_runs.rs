//! Finds runs of a `verify` object that are the same simulation.

use super::bound::BoundVerify;
use super::outcome::{MeasuredRun, MeasuredRuns};
use super::runner::{length_key, settings_key};
use crate::finding::Finding;
use crate::json::read::named;
use crate::rules;
use crate::source::Text;
use crate::spec::Verify;
use std::collections::BTreeMap;

/// Reports each run that has the settings of an earlier one and has measured the same, and each that differs from an earlier one in its
/// length only, if a claim compares equal numbers of both. The runs of a sweep are left out: its list shows which values they have.
pub(super) fn check_identical_runs(
    bound: &BoundVerify<'_>,
    outcome: &MeasuredRuns,
    findings: &mut Vec<Finding>,
) {
    let mut earlier_runs: BTreeMap<String, (&str, String)> = BTreeMap::new();
    for (index, (run, scene)) in
        bound.runs_with_scenes().enumerate().filter(|(_, (run, _))| run.swept.is_none())
    {
        let Some(spec) = run.spec else { continue };
        if let Some(finding) = same_start(bound, outcome, index) {
            findings.push(finding);
            continue;
        }
        let length = length_key(run);
        let (earlier, other_length) =
            earlier_runs.entry(settings_key(scene, run)).or_insert((run.name, length.clone()));
        let measured = |name: &str| outcome.runs.iter().find(|run| run.name == name);
        let (Some(a), Some(b)) = (measured(earlier), measured(run.name)) else { continue };
        if *earlier == run.name {
            continue;
        }
        let runs = format!("the runs {} and {}", named(earlier), named(run.name));
        let (message, why) = match compared_measure(bound.verify, a, b) {
            _ if *other_length == length && measure_the_same(a, b) => (
                format!("{runs} have the same settings"),
                "every measure is the same in both, so every comparison between them says that nothing changes".into(),
            ),
            Some(measure) if *other_length != length => (
                format!("{runs} differ in their length only"),
                format!("`{measure}` is the same number in both, so a comparison of it says that nothing changes"),
            ),
            _ => continue,
        };
        findings.push(
            Finding::new(rules::IDENTICAL_RUNS, spec.name.span(), message)
                .why(why)
                .help("write the setting in which they differ, or use one run"),
        );
    }
}

/// A run whose settings are written differently from those of an earlier one with which a claim compares it, and that is the same
/// simulation: its settings have values that the lab has anyway.
fn same_start(bound: &BoundVerify<'_>, outcome: &MeasuredRuns, index: usize) -> Option<Finding> {
    let measured = outcome.runs.get(index)?;
    let earlier = outcome.runs.get(..index)?;
    if !earlier.iter().any(|run| run.swept.is_none() && measure_the_same(run, measured)) {
        return None;
    }
    let first = *bound.same_runs().get(index).filter(|first| **first != index)?;
    let ((run, scene), (other, other_scene)) =
        (bound.runs_with_scenes().nth(index)?, bound.runs_with_scenes().nth(first)?);
    if settings_key(scene, run) == settings_key(other_scene, other)
        || !measure_the_same(outcome.runs.get(first)?, measured)
    {
        return None;
    }
    compared_measure(bound.verify, outcome.runs.get(first)?, measured)?;
    let [a, b] = [named(other.name), named(run.name)];
    let message = format!("the runs {a} and {b} are the same simulation");
    Some(
        Finding::new(rules::IDENTICAL_RUNS, run.spec?.name.span(), message)
            .why("their settings are written differently, but they start with the same model in the same state, so every comparison between them says that nothing changes")
            .help("write the setting in which they differ: another value, or the field that the simulation reads"),
    )
}

/// Whether all measures of two runs are the same to the last bit. A program that draws numbers or counts its calls may give
/// others with the same settings.
fn measure_the_same(a: &MeasuredRun, b: &MeasuredRun) -> bool {
    let same = |(x, y): (&(String, f64), &(String, f64))| x.0 == y.0 && x.1.to_bits() == y.1.to_bits();
    a.measures.len() == b.measures.len() && a.measures.iter().zip(&b.measures).all(same)
}

/// A measure that is the same number in both runs, and that one claim reads in both.
fn compared_measure<'m>(verify: &Verify, a: &'m MeasuredRun, b: &MeasuredRun) -> Option<&'m str> {
    // An event that never happens has no number in either.
    let same = |(x, y): &(&'m (String, f64), &(String, f64))| x.0 == y.0 && x.1 == y.1;
    let mut measures = a.measures.iter().zip(&b.measures).filter(same).map(|(x, _)| x.0.as_str());
    let reads_both = |claim: &Text, measure: &str| {
        [a, b].iter().all(|run| names_measure(claim.as_str(), &format!("{}.{measure}", run.name)))
    };
    measures.find(|measure| claims(verify).any(|claim| reads_both(claim, measure)))
}

/// The expressions of all claims of an object about single runs.
fn claims(verify: &Verify) -> impl Iterator<Item = &Text> {
    let says = verify.says.iter().flat_map(|quote| &quote.exprs);
    verify.options.iter().chain(&verify.value).chain(says)
}

/// Whether an expression contains `run.measure` as whole words.
fn names_measure(expression: &str, name: &str) -> bool {
    let is_word = |c: Option<char>| c.is_some_and(|c| c.is_alphanumeric() || matches!(c, '_' | '$' | '.'));
    expression.match_indices(name).any(|(at, _)| {
        let (before, after) = (&expression[..at], &expression[at + name.len()..]);
        !is_word(before.chars().next_back()) && !is_word(after.chars().next())
    })
}
