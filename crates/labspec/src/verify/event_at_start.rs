//! Finds measures whose event happens at the first sample of every run that a claim reads.

use super::bound::BoundVerify;
use super::layout::Slot;
use super::outcome::MeasuredRuns;
use crate::finding::Finding;
use crate::rules;
use crate::source::Text;
use crate::spec::Verify;
use std::collections::BTreeMap;

/// Reports them. An event that one of the runs has later is compared with that run.
pub(super) fn check_events(
    bound: &BoundVerify<'_>,
    outcome: &MeasuredRuns,
    verify: &Verify,
    findings: &mut Vec<Finding>,
) {
    let claims = verify.options.iter().chain(&verify.value).chain(verify.quoted());
    let slots = &bound.layout().slots;
    // The measures that are read: the aggregate where it happens at the first sample of all runs so far.
    let mut read: BTreeMap<&str, Option<&str>> = BTreeMap::new();
    for claim in claims.filter_map(|text| bound.claim(text)) {
        for slot in claim.reads.iter().filter_map(|place| slots.get(*place)) {
            let Slot::Measure(run, measure) = *slot else { continue };
            let Some(measured) = outcome.runs.get(run) else { continue };
            let Some((name, _)) = measured.measures.get(measure) else { continue };
            let event = measured.at_start.iter().find(|(other, _)| other == name);
            let event = event.map(|(_, event)| event.as_str());
            read.entry(name).and_modify(|all| *all = all.and(event)).or_insert(event);
        }
    }
    for (name, event) in read.into_iter().filter_map(|(name, event)| Some((name, event?))) {
        let Some(text) = measure_text(verify, name) else { continue };
        let runs = if outcome.runs.len() > 1 { "every run" } else { "the run" };
        findings.push(
            Finding::new(
                rules::EVENT_AT_START,
                text.span(),
                format!("`{event}` happens at the first sample of {runs}"),
            )
            .why("the measure is a value of the start, not of something that happens")
            .help("wait for what comes later (`first(… && data.time > 0.1)`), or take the value of the start with `initial(…)`"),
        );
    }
}

/// The text of a measure, or of the list that an element belongs to.
fn measure_text<'v>(verify: &'v Verify, name: &str) -> Option<&'v Text> {
    let list = name.split('[').next().unwrap_or(name);
    verify.measure.iter().find(|(other, _)| other.value == name || other.value == list).map(|(_, text)| text)
}
