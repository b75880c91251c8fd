//! A text that names the second or a later occurrence of an event whose first one is measured: "the second bounce" beside
//! `first(contact('ball', 'floor'))`.

use super::{Other, ReadMeasure, measured_in_run};
use crate::language::words::split_words;
use crate::source::Text;
use labspec_expr::ast::{Expr, ExprKind};
use labspec_expr::{parse_expression, print};

/// The value at the occurrence of the event that a text names, if the measure reads the first one.
pub(super) fn other(read: &ReadMeasure<'_, '_>, text: &str) -> Option<Other> {
    let (words, count) = named_occurrence(read, text)?;
    let tree = parse_expression(&read.text.value).tree;
    let (condition, inner) = event(&tree)?;
    let event = print(condition);
    // A condition on the time, or on earlier samples, may select a later occurrence.
    if ["data.time", "previous(", "first("].iter().any(|other| event.contains(other)) {
        return None;
    }
    let run = read.bound.runs.get(read.run)?;
    let time_of = |text: String| {
        let text = Text::derived(text, read.text.span());
        measured_in_run(read.bound, read.outcome, run, text)
    };
    let mut time = time_of(format!("first({event})"))?;
    for _ in 1..count {
        let end = time_of(format!("first(data.time > {time} && !({event}))"))?;
        time = time_of(format!("first(data.time > {end} && ({event}))"))?;
    }
    let replaced = match inner {
        Some(inner) => format!("at(data.time >= {time} - 1e-9, {})", print(inner)),
        None => format!("first(data.time >= {time} - 1e-9)"),
    };
    Some(Other {
        words,
        read: format!("the first time: `{}`", read.text.as_str()),
        with: format!("the occurrence at {time} s of the same run"),
        value: read.with_text(replaced)?,
    })
}

/// The only ordinal above the first that stands beside the name of an event, and the words of both.
fn named_occurrence(read: &ReadMeasure<'_, '_>, text: &str) -> Option<(String, usize)> {
    let words: Vec<&str> = split_words(text).collect();
    let ordinal = |word: &str| read.languages.ordinals().find(|(form, _)| *form == word).map(|(_, n)| n);
    let is_event = |word: &str| read.languages.comparisons(|c| c.events).any(|event| event == word);
    let mut named = words.windows(2).filter_map(|pair| {
        let [a, b] = pair else { return None };
        let count = ordinal(a).filter(|_| is_event(b)).or_else(|| ordinal(b).filter(|_| is_event(a)))?;
        Some((format!("{a} {b}"), count))
    });
    let (words, count) = named.next()?;
    (named.next().is_none() && count > 1).then_some((words, count))
}

/// The condition of `first(condition)`, or of `at(condition, x)` with x.
fn event(e: &Expr) -> Option<(&Expr, Option<&Expr>)> {
    let ExprKind::Call { callee, args, .. } = &e.kind else { return None };
    let ExprKind::Name(name) = &callee.kind else { return None };
    match (name.as_str(), args.as_slice()) {
        ("first", [condition]) => Some((condition, None)),
        ("at", [condition, inner]) => Some((condition, Some(inner))),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    /// How many times the text of a numeric question about a bouncing ball is found to name another bounce.
    fn found(question: &str, measure: &str, answer: f64) -> usize {
        let xml = "<mujoco><worldbody><geom name='floor' type='plane' size='5 5 1'/><body name='ball' pos='0 0 .6'><freejoint/>\
            <geom name='ball' size='.1' solref='-5000 -1'/></body></worldbody></mujoco>";
        let verify = serde_json::json!({"lab": {"stopAt": 2, "xml": xml}, "runs": {"r": {"until": 2}}, "measure": {"t": measure}, "value": "r.t"});
        let question = serde_json::json!({"kind": "numeric", "q": question, "answer": answer, "tol": 0.02, "unit": "s", "verify": verify});
        let quiz = serde_json::json!({"id": "q", "questions": [question]}).to_string();
        let report = crate::Checker::new(|_: &str| None::<String>).check("q.json", &quiz);
        assert!(report.findings.iter().all(|f| !f.is_error()), "{:?}", report.findings);
        report.findings.iter().filter(|finding| finding.code == "measures-another").count()
    }

    #[test]
    fn a_later_occurrence_is_found() {
        let first = "first(contact('ball', 'floor'))";
        for question in [
            "When does the ball hit the floor for the second time?",
            "At what time is the second bounce?",
            "Wann berührt der Ball den Boden zum zweiten Mal?",
            "Wann ist der zweite Aufprall?",
            "À quel instant le deuxième rebond a-t-il lieu ?",
            "¿Cuándo ocurre el segundo rebote?",
            "Quando avviene il secondo rimbalzo?",
        ] {
            assert_eq!(found(question, first, 0.32), 1, "{question}");
        }
        for question in [
            "When does the ball hit the floor for the first time?",
            "When is the first bounce, and not the second bounce?",
            "Within the first second: when does the ball hit the floor?",
            "What is the time of the hit, in seconds?",
            "When does the second ball hit the floor?",
        ] {
            assert_eq!(found(question, first, 0.32), 0, "{question}");
        }
        let second = "first(data.time > 0.5 && contact('ball', 'floor'))";
        assert_eq!(found("At what time is the second bounce?", second, 0.99), 0);
    }
}
