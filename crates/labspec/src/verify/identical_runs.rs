//! Finds runs of a `verify` object that are the same simulation.

use super::bound::BoundVerify;
use super::outcome::{MeasuredRun, MeasuredRuns};
use super::runner::settings_key;
use crate::finding::Finding;
use crate::json::read::named;
use crate::rules;
use std::collections::BTreeMap;

/// Reports each run that has the settings of an earlier one and has measured the same. The runs of a sweep are left out: its list
/// shows which values they have.
pub(super) fn check_identical_runs(
    bound: &BoundVerify<'_>,
    outcome: &MeasuredRuns,
    findings: &mut Vec<Finding>,
) {
    let mut earlier_runs: BTreeMap<String, &str> = BTreeMap::new();
    for (run, scene) in bound.runs_with_scenes().filter(|(run, _)| run.swept.is_none()) {
        let Some(spec) = run.spec else { continue };
        let earlier = *earlier_runs.entry(settings_key(scene, run)).or_insert(run.name);
        let measured = |name: &str| outcome.runs.iter().find(|run| run.name == name);
        let (Some(a), Some(b)) = (measured(earlier), measured(run.name)) else { continue };
        if earlier == run.name || !measure_the_same(a, b) {
            continue;
        }
        let message = format!("the runs {} and {} have the same settings", named(earlier), named(run.name));
        findings.push(
            Finding::new(rules::IDENTICAL_RUNS, spec.name.span(), message)
                .why("every measure is the same in both, so every comparison between them says that nothing changes")
                .help("write the setting in which they differ, or use one run"),
        );
    }
}

/// Whether all measures of two runs are the same to the last bit. A program that draws numbers or counts its calls may give
/// others with the same settings.
fn measure_the_same(a: &MeasuredRun, b: &MeasuredRun) -> bool {
    let same = |(x, y): (&(String, f64), &(String, f64))| x.0 == y.0 && x.1.to_bits() == y.1.to_bits();
    a.measures.len() == b.measures.len() && a.measures.iter().zip(&b.measures).all(same)
}
