//! Finds pairs of quotes whose runs are exchanged: "the small swing takes 1.65 s, the wide one 1.42 s" beside `wide.T` and `small.T`.

use super::bound::BoundVerify;
use super::layout::Slot;
use super::quote::QuotePlace;
use crate::finding::Finding;
use crate::json::read::named;
use crate::rules;
use crate::source::Text;
use std::collections::{BTreeMap, BTreeSet};

/// A quote in a clause that names another run than its expression reads.
pub(super) struct Misnamed<'t> {
    quote: &'t Text,
    expr: Text,
    /// The run that the clause names, and the one that the expression reads.
    named: String,
    read: String,
    place: std::ops::Range<usize>,
}

/// Reports pairs of quotes of which each names the run that the other one reads, with the same expression.
pub(super) fn check_exchanged_runs(quotes: &[Misnamed<'_>], findings: &mut Vec<Finding>) {
    let all: BTreeSet<(&str, &str, &str)> =
        quotes.iter().map(|one| (one.named.as_str(), one.read.as_str(), one.expr.as_str())).collect();
    for one in quotes {
        let of_other = one.expr.as_str().replace(&format!("{}.", one.read), &format!("{}.", one.named));
        if !all.contains(&(one.read.as_str(), one.named.as_str(), of_other.as_str())) {
            continue;
        }
        let [run, read] = [&one.named, &one.read].map(|name| named(name));
        let message = format!(
            "the text is about the run {run}, but the expression of \"{}\" reads {read}",
            one.quote.as_str()
        );
        findings.push(
            Finding::new(rules::QUOTE_OF_ANOTHER_RUN, one.place.clone(), message)
                .help(format!("swap the two numbers in the text, or make the sentence about {read}"))
                .related(one.expr.span(), "the expression"),
        );
    }
}

/// Words before the name of a run in a sentence: `the small swing`, `on earth`.
const BEFORE_NAME: [&str; 27] = [
    "the", "a", "an", "on", "with", "without", "for", "in", "at", "from", "der", "die", "das", "den", "dem",
    "auf", "mit", "bei", "le", "la", "les", "sur", "avec", "el", "en", "il", "su",
];
/// Names that are usually other words of a sentence.
const COMMON: [&str; 16] = [
    "first", "second", "third", "one", "two", "three", "run", "start", "end", "rest", "fall", "drop", "time",
    "other", "same", "last",
];

/// A quote of which every place is in a clause that names another run, and not the one that its expression reads.
pub(super) fn misnamed<'t>(
    bound: &BoundVerify<'_>,
    quote: &'t Text,
    expr: &Text,
    places: &[QuotePlace],
) -> Option<Misnamed<'t>> {
    let claim = bound.claim(expr)?;
    let slots = claim.reads.iter().filter_map(|place| bound.layout().slots.get(*place));
    let runs: BTreeSet<usize> = slots
        .filter_map(|slot| match slot {
            Slot::Measure(run, _) | Slot::Warnings(run) | Slot::Swept(run, _) => Some(*run),
            _ => None,
        })
        .collect();
    let [run] = runs.iter().copied().collect::<Vec<_>>()[..] else { return None };
    let name = bound.runs.get(run)?.name;
    let others = bound.runs.iter().map(|run| run.name).filter(|other| *other != name && is_telling(other));
    let others: BTreeMap<String, &str> = others.map(|other| (other.to_lowercase(), other)).collect();
    let read = name.to_lowercase();
    let named_in = |place: &QuotePlace| {
        let clause = &place.clause;
        let named_by = |text: &str| {
            let is_own = words_of(text).contains(&read);
            let named = named_words(text).into_iter().find_map(|word| others.get(&word).copied());
            named.filter(|_| !is_own).ok_or(is_own)
        };
        // The words before the comma count where the clause names no run: `On the moon, it takes 1 s`.
        named_by(&clause.text)
            .or_else(|is_own| if is_own { Err(true) } else { named_by(&clause.introduction) })
            .ok()
    };
    let other = named_in(places.first()?)?;
    let is_everywhere = places.iter().all(|place| named_in(place) == Some(other));
    is_everywhere.then(|| Misnamed {
        quote,
        expr: expr.clone(),
        named: other.to_string(),
        read: name.to_string(),
        place: places.first().map_or(quote.span(), |place| place.span.clone()),
    })
}

/// Whether the name of a run is certainly the run where a text contains it.
fn is_telling(name: &str) -> bool {
    name.chars().count() > 2 && !COMMON.contains(&name.to_lowercase().as_str())
}

/// The words of a clause in lower case.
fn words_of(clause: &str) -> Vec<String> {
    let words = clause.split(|c: char| !(c.is_alphanumeric() || c == '_'));
    words.filter(|word| !word.is_empty()).map(str::to_lowercase).collect()
}

/// The words of a clause behind an article or a preposition, or a word that stands alone.
fn named_words(clause: &str) -> Vec<String> {
    let words = words_of(clause);
    if words.len() == 1 {
        return words;
    }
    let pairs = words.windows(2).filter_map(|pair| match pair {
        [before, word] if BEFORE_NAME.contains(&before.as_str()) => Some(word.clone()),
        _ => None,
    });
    pairs.collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn runs_are_named_behind_articles() {
        let names_small = |clause: &str| named_words(clause).contains(&"small".to_string());
        for clause in ["the small swing takes", "on small ones", "small"] {
            assert!(names_small(clause), "{clause}");
        }
        for clause in ["as small as", "it is small", "the smaller swing takes"] {
            assert!(!names_small(clause), "{clause}");
        }
    }

    /// The messages about quotes in a text: a small swing takes 1.42 s, a wide one 1.65 s.
    fn messages(text: &str, says: serde_json::Value) -> Vec<String> {
        let xml = "<mujoco><worldbody><body><joint name='j' axis='0 1 0'/><geom size='.05' pos='0 0 -.5'/></body></worldbody></mujoco>";
        let control = serde_json::json!({"label": "start (rad)", "param": "q", "min": 0, "max": 2, "step": 0.1, "value": 0.1, "reset": true});
        let lab = serde_json::json!({"stopAt": 6, "xml": xml, "controls": [control], "setup": "data.qpos[0] = ctx.q",
            "readouts": [{"label": "angle (rad)", "expr": "data.qpos[0]"}],
            "verify": {"runs": {"small": {"set": {"start (rad)": 0.1}}, "wide": {"set": {"start (rad)": 1.5}}},
                "measure": {"T": "period(data.qpos[0])"}, "says": says}});
        let lesson = format!("# Swings\n\n{text}\n\n```lab\n{lab}\n```\n");
        let report = crate::Checker::new(|_: &str| None::<String>).check("lesson.md", &lesson);
        let found = report.findings.iter().filter(|f| f.code == "quote-of-another-run");
        found.map(|f| f.message.clone()).collect()
    }

    #[test]
    fn exchanged_runs_are_found() {
        let exchanged = serde_json::json!([["1.65 s", "wide.T"], ["1.42 s", "small.T"]]);
        for text in [
            "The small swing takes 1.65 s, the wide one 1.42 s.",
            "It takes 1.65 s for the small swing and 1.42 s for the wide one.",
            "| swing | period |\n|---|---|\n| small | 1.65 s |\n| wide | 1.42 s |",
            "For the small swing, the period is 1.65 s, for the wide one 1.42 s.",
            "- small: 1.65 s\n- wide: 1.42 s",
        ] {
            assert_eq!(messages(text, exchanged.clone()).len(), 2, "{text}");
        }
        for text in [
            "The wide swing takes 1.65 s, the small one 1.42 s.",
            "The period is 1.65 s, and not the 1.42 s of a small swing.",
            "The wide swing takes 1.65 s against the small one's 1.42 s.",
            "It takes 1.65 s, or 1.42 s.",
            "For the wide swing, the period is 1.65 s, for the small one 1.42 s.",
            "- wide: 1.65 s\n- small: 1.42 s",
            "| swing | period |\n|---|---|\n| wide | 1.65 s |\n| small | 1.42 s |",
        ] {
            assert_eq!(messages(text, exchanged.clone()), [""; 0], "{text}");
        }
    }
}
