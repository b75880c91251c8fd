//! Finds texts that say that something never happens, with a condition that reads one sample of the run.

use super::aggregate::AggregateKind;
use super::bound::BoundVerify;
use super::layout::Slot;
use crate::finding::Finding;
use crate::json::read::named;
use crate::language::Languages;
use crate::rules;
use crate::source::Text;
use labspec_expr::Program;

/// Reports an option or a statement whose condition holds. A comparison of several runs may be about all settings, not about all times, and
/// a run that ends by its `stop` ends at an event.
pub(super) fn check_one_sample(
    bound: &BoundVerify<'_>,
    (stated, condition): (&Text, &Text),
    findings: &mut Vec<Finding>,
) {
    let Some(word) = never(stated.as_str(), bound.stage().languages()) else { return };
    let Some(claim) = bound.claim(condition) else { return };
    let mut runs = Vec::new();
    for slot in claim.reads.iter().filter_map(|place| bound.layout().slots.get(*place)) {
        let Slot::Measure(run, measure) = *slot else { return };
        let is_end = bound.measure_at(run, measure).is_some_and(|measure| reads_one_sample(&measure.program));
        let stops = bound.runs.get(run).is_none_or(|run| run.stop.is_some());
        if !is_end || stops {
            return;
        }
        runs.push(run);
    }
    let is_of_text = claim.program.as_ref().is_some_and(reads_one_sample);
    let is_one_run = runs.iter().all(|run| runs.first() == Some(run));
    if !is_one_run || runs.is_empty() && !is_of_text {
        return;
    }
    let message = format!("the text says {}, and the condition reads one sample of the run", named(word));
    findings.push(
        Finding::new(rules::ONE_SAMPLE, condition.span(), message)
            .why("what happens between the start and the end is not looked at")
            .help("compare an extreme value (`max(…)`, `min(…)`), write `holds(…)`, or `isNaN(first(…))` for an event that does not happen")
            .related(stated.span(), "the text"),
    );
}

/// Whether a program has aggregates, and all of them take the value of the first or of the last sample.
fn reads_one_sample(program: &Program) -> bool {
    let is_end = |aggregate: &labspec_expr::Aggregate| {
        matches!(AggregateKind::of_aggregate(aggregate), Some(AggregateKind::Initial | AggregateKind::Final))
            && aggregate.args.iter().all(|arg| arg.aggregates().is_empty())
    };
    !program.aggregates().is_empty() && program.aggregates().iter().all(is_end)
}

/// The word of a text that states something about every moment.
fn never(text: &str, languages: Languages) -> Option<&'static str> {
    let lower = text.to_lowercase();
    let is_letter = |c: char| c.is_alphanumeric() && c.is_ascii() || "äöüßéàùáíóúèì".contains(c);
    languages.words_of(|language| language.never).find(|word| {
        lower.match_indices(*word).any(|(start, found)| {
            let before = lower.get(..start).and_then(|text| text.chars().next_back());
            let behind = lower.get(start + found.len()..).and_then(|text| text.chars().next());
            !before.is_some_and(is_letter) && !behind.is_some_and(is_letter)
        })
    })
}

#[cfg(test)]
mod tests {
    /// Whether the condition of a statement is reported: a ball falls on a soft floor, and comes to rest.
    fn is_reported(text: &str, condition: &str) -> bool {
        let xml = "<mujoco><worldbody><geom type='plane' size='1 1 .1'/><body pos='0 0 1'><freejoint/><geom size='.05'/></body></worldbody></mujoco>";
        let lab = serde_json::json!({"stopAt": 2, "xml": xml});
        let measure = serde_json::json!({"end": "final(data.qpos[2])", "least": "min(data.qpos[2])", "rise": "final(data.qpos[2]) - initial(data.qpos[2])"});
        let quiz = serde_json::json!({"id": "q", "questions": [{"q": text, "kind": "truefalse", "answer": true,
            "verify": {"lab": lab, "measure": measure, "options": [condition]}}]});
        let report = crate::Checker::new(|_: &str| None::<String>).check("q.json", &quiz.to_string());
        report.findings.iter().any(|finding| finding.code == "one-sample")
    }

    #[test]
    fn never_is_about_all_samples() {
        for (text, condition) in [
            ("It never sinks into the floor by more than 4 mm.", "end > 0.046"),
            ("It never rises above its start.", "rise < 0"),
            ("Es sinkt nie tief ein.", "end > 0.046"),
        ] {
            assert!(is_reported(text, condition), "{text}");
        }
        for (text, condition) in [
            ("It never sinks into the floor by more than 40 mm.", "least > 0.01"),
            ("It lies on the floor in the end.", "end < 0.06"),
            ("Die Dauer nimmt zu: Linie.", "end < 0.06"),
        ] {
            assert!(!is_reported(text, condition), "{text}");
        }
    }
}
