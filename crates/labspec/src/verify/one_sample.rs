//! Finds texts that say that something never happens, with a condition that reads one sample of the run.

use super::aggregate::AggregateKind;
use super::bound::BoundVerify;
use super::layout::Slot;
use super::measures_another::measured_in_run;
use super::outcome::MeasuredRuns;
use crate::finding::Finding;
use crate::json::read::named;
use crate::language::Languages;
use crate::rules;
use crate::source::Text;
use labspec_expr::Program;

/// Reports an option or a statement whose condition holds at the end of its run, and not at all samples. A comparison of several runs may be
/// about all settings, not about all times, and a run that ends by its `stop` ends at an event.
pub(super) fn check_one_sample(
    bound: &BoundVerify<'_>,
    outcome: &MeasuredRuns,
    (stated, condition): (&Text, &Text),
    findings: &mut Vec<Finding>,
) {
    let Some(word) = never(stated.as_str(), bound.stage().languages()) else { return };
    let Some(claim) = bound.claim(condition) else { return };
    let mut read = Vec::new();
    for place in &claim.reads {
        let Some(Slot::Measure(run, measure)) = bound.layout().slots.get(*place) else { return };
        let Some(text) = bound.measure_at(*run, *measure).filter(|m| reads_one_sample(&m.program)) else {
            return;
        };
        read.push((*place, *run, &*text.text));
    }
    let is_of_text = claim.program.as_ref().is_some_and(reads_one_sample);
    let run = read.first().map_or(0, |(_, run, _)| *run);
    let stops = bound.runs.get(run).is_none_or(|run| run.stop.is_some());
    if stops || read.iter().any(|(_, other, _)| *other != run) || read.is_empty() && !is_of_text {
        return;
    }
    let fails = |extreme: &str| match is_of_text {
        true => !holds_with(bound, outcome, condition, extreme),
        false => {
            let values = read.iter().map(|(place, run, text)| {
                let text = Text::derived(with_extreme(text.as_str(), extreme), text.span());
                Some((*place, measured_in_run(bound, outcome, bound.runs.get(*run)?, text)?))
            });
            let Some(values) = values.collect::<Option<Vec<_>>>() else { return false };
            let mut inputs = claim.inputs(bound, outcome, Vec::new());
            values.into_iter().for_each(|(place, x)| inputs.set_value(place, x));
            let traced = claim.evaluate(bound, &inputs, None).and_then(Result::ok);
            traced.is_some_and(|traced| !traced.value.truthy())
        }
    };
    let Some(extreme) = ["min", "max"].into_iter().find(|extreme| fails(extreme)) else { return };
    let message = format!("the text says {}, but the condition reads only the end of the run", named(word));
    findings.push(
        Finding::new(rules::ONE_SAMPLE, condition.span(), message)
            .why(format!("with `{extreme}(…)` in place of `final(…)`, it does not hold"))
            .help("compare an extreme value (`max(…)`, `min(…)`), write `holds(…)`, or `isNaN(first(…))` for an event that does not happen")
            .related(stated.span(), "the text"),
    );
}

/// Whether a condition that contains its aggregates holds with another aggregate in place of `final`.
fn holds_with(bound: &BoundVerify<'_>, outcome: &MeasuredRuns, condition: &Text, extreme: &str) -> bool {
    let text = Text::derived(with_extreme(condition.as_str(), extreme), condition.span());
    bound.find(outcome, &text, &mut Vec::new()).is_none_or(|found| found.value.truthy())
}

/// A text with another aggregate in place of `final`.
fn with_extreme(text: &str, extreme: &str) -> String {
    let mut all = String::with_capacity(text.len());
    let mut rest = text;
    while let Some((before, behind)) = rest.split_once("final") {
        let is_part =
            |c: Option<char>| c.is_some_and(|c| c.is_alphanumeric() || matches!(c, '_' | '$' | '.'));
        let is_call = behind.trim_start().starts_with('(');
        let is_name = is_part(before.chars().next_back()) || !is_call;
        all.push_str(before);
        all.push_str(if is_name { "final" } else { extreme });
        rest = behind;
    }
    all.push_str(rest);
    all
}

/// Whether a program has aggregates, and all of them take the value of the first or of the last sample.
fn reads_one_sample(program: &Program) -> bool {
    let is_end = |aggregate: &labspec_expr::Aggregate| {
        matches!(AggregateKind::of_aggregate(aggregate), Some(AggregateKind::Initial | AggregateKind::Final))
            && aggregate.args.iter().all(|arg| arg.aggregates().is_empty())
    };
    !program.aggregates().is_empty() && program.aggregates().iter().all(is_end)
}

/// The word of a text, in its last sentence and outside of brackets, that states something about every moment.
fn never(text: &str, languages: Languages) -> Option<&'static str> {
    let sentences = text.trim().trim_end_matches(['.', '!', '?']);
    let last = sentences.rsplit(". ").next().unwrap_or(sentences);
    let outside = last
        .split('(')
        .enumerate()
        .map(|(i, part)| if i == 0 { part } else { part.split_once(')').map_or("", |(_, rest)| rest) });
    let lower = outside.collect::<String>().to_lowercase();
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
            ("It is never above 20 cm.", "final(data.qpos[2]) < 0.2"),
            ("Es sinkt nie tief ein.", "end > 0.046"),
        ] {
            assert!(is_reported(text, condition), "{text}");
        }
        for (text, condition) in [
            ("It never sinks into the floor by more than 40 mm.", "least > 0.01"),
            ("It lies on the floor in the end.", "end < 0.06"),
            ("It never falls through the floor.", "end > 0.01"),
            ("It never rises above its start.", "rise < 0.001"),
            ("Die Dauer nimmt zu: Linie.", "end < 0.06"),
        ] {
            assert!(!is_reported(text, condition), "{text}");
        }
    }
}
