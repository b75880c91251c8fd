//! Finds runs of a `verify` object that have the same settings.

use super::bound::BoundVerify;
use super::runner::settings_key;
use crate::finding::Finding;
use crate::json::read::named;
use crate::rules;
use std::collections::BTreeMap;

/// Reports each run that has the settings of an earlier one. The runs of a sweep are one run here.
pub(super) fn check_identical_runs(bound: &BoundVerify<'_>, findings: &mut Vec<Finding>) {
    let mut seen: BTreeMap<String, &str> = BTreeMap::new();
    for (run, scene) in bound.runs_with_scenes().filter(|(run, _)| run.swept.is_none()) {
        let Some(spec) = run.spec else { continue };
        match seen.get(&settings_key(scene, run)) {
            Some(earlier) => findings.push(
                Finding::new(
                    rules::IDENTICAL_RUNS,
                    spec.name.span(),
                    format!("the runs {} and {} have the same settings", named(earlier), named(run.name)),
                )
                .why("both are the same simulation, so every comparison between them says that nothing changes")
                .help("write the setting in which they differ, or use one run"),
            ),
            None => {
                seen.insert(settings_key(scene, run), run.name);
            }
        }
    }
}
