//! Finds quotes such as "41 % longer" and "falls by 41 %" whose expression is the ratio of two measures instead of their relative
//! difference.

use super::option_numbers::constant;
use super::quote::{DECREASES, INCREASES, SMALLER};
use crate::finding::Finding;
use crate::rules;
use crate::source::Text;
use labspec_expr::ast::{BinaryOp, Expr, ExprKind};
use labspec_expr::{parse_expression, print};

const LARGER: [&str; 14] = [
    "more", "longer", "faster", "higher", "larger", "bigger", "greater", "heavier", "farther", "further",
    "deeper", "stronger", "later", "wider",
];

/// A verb is at most this number of words before `by`: `grows in length by`.
const VERB_WORDS: usize = 4;
/// And the number at most this number of words behind it: `by about`.
const ADVERBS: usize = 1;

/// Verbs of a loss, before the number: `loses 35 %`. And those of what remains: `keeps 65 %`.
const LOSES: [&str; 5] = ["lose", "loses", "lost", "losing", "dissipates"];
const KEEPS: [&str; 6] = ["keep", "keeps", "kept", "retains", "retain", "retained"];
/// Behind the number: `65 % is left`. They are at most this number of words behind it.
const REMAINS: [&str; 6] = ["left", "remain", "remains", "remaining", "survive", "survives"];
const REMAINS_WORDS: usize = 6;
/// Questions for a part or a change in percent.
const ASKED: [&str; 6] = [
    "how many percent",
    "how many per cent",
    "how many %",
    "what percentage",
    "which percentage",
    "what percent",
];

/// The text of a measure by its name.
pub(super) type MeasureTexts<'t> = &'t dyn Fn(&str) -> Option<String>;

/// Reports a quote that states a change in percent, with an expression that is certainly a ratio, or what remains, with one that is a
/// loss. `clause` is the text around the quote. Returns the reason.
pub(super) fn check_ratio_of_change(
    quote: &Text,
    clause: Option<&str>,
    expr: &Text,
    texts: MeasureTexts<'_>,
    findings: &mut Vec<Finding>,
) -> Option<String> {
    let in_text = |text: &str| change(text).or_else(|| loss_or_rest(text));
    let stated = in_text(quote.as_str()).or_else(|| in_text(clause?))?;
    report(quote, &stated, expr, texts, findings)
}

/// The same for the text of a numeric question: `By how many percent does the period grow?`
pub(super) fn check_asked_change(
    question: &Text,
    expr: &Text,
    texts: MeasureTexts<'_>,
    findings: &mut Vec<Finding>,
) -> Option<String> {
    report(question, &asked_change(question.as_str())?, expr, texts, findings)
}

/// Reports an expression that is a ratio where a text states a change, and the reverse.
fn report(
    text: &Text,
    stated: &Change,
    expr: &Text,
    texts: MeasureTexts<'_>,
    findings: &mut Vec<Finding>,
) -> Option<String> {
    let tree = parse_expression(expr.as_str()).tree;
    let (ratio, help) = match stated.part {
        Part::Rest => {
            let [a, b] = loss(&tree)?;
            (format!("`1 - {a} / {b}`, what is lost"), format!("write `100 * {a} / {b}`"))
        }
        part => {
            let [a, b] = ratio(&tree, part == Part::Loss, texts)?;
            let help = match part {
                Part::Larger => format!("write `100 * ({a} / {b} - 1)`"),
                _ => format!("write `100 * (1 - {a} / {b})`"),
            };
            ("the ratio of both".to_string(), help)
        }
    };
    let message = format!("{}, but the expression is {ratio}", stated.message);
    findings.push(
        Finding::error(rules::QUOTE_WRONG, text.span(), message.clone())
            .why("a value that is 41 % of another one is 59 % smaller: the ratio is not the change")
            .help(format!("{help} as the expression, and correct the number"))
            .related(expr.span(), "the expression"),
    );
    Some(message)
}

/// What a number of percent is.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Part {
    /// By how much something is smaller, or larger.
    Smaller,
    Larger,
    /// What is lost, and what remains.
    Loss,
    Rest,
}

/// A change in percent that a text states.
struct Change {
    /// What the text says.
    message: String,
    part: Part,
}

/// What a quote says is lost (`loses 35 %`), or remains (`keeps 65 %`, `65 % is left`).
fn loss_or_rest(quote: &str) -> Option<Change> {
    let lower = quote.to_lowercase();
    let (before, behind) =
        ["%", "percent", "per cent"].into_iter().find_map(|unit| lower.split_once(unit))?;
    let words = |text: &str| -> Vec<String> {
        let words = text.split(|c: char| !c.is_alphabetic()).filter(|word| !word.is_empty());
        words.map(str::to_owned).collect()
    };
    let (before, behind) = (words(before), words(behind));
    let near: Vec<&str> = before.iter().rev().take(ADVERBS + 1).map(String::as_str).collect();
    let change = |word: &str, part: Part| {
        let what = if part == Part::Loss { "what is lost" } else { "what remains" };
        Some(Change { message: format!("the text says {what} (\"{word}\")"), part })
    };
    if let Some(word) = near.iter().find(|word| LOSES.contains(word)) {
        return change(word, Part::Loss);
    }
    if let Some(word) = near.iter().find(|word| KEEPS.contains(word)) {
        return change(word, Part::Rest);
    }
    let word = behind.iter().take(REMAINS_WORDS).find(|word| REMAINS.contains(&word.as_str()))?;
    change(word, Part::Rest)
}

/// The change in percent that a question asks for: `By how many percent does it grow?`, `How many percent longer is it?`, `What percentage
/// of it is lost?`
fn asked_change(question: &str) -> Option<Change> {
    let lower = question.to_lowercase();
    let (start, phrase) = ASKED.iter().find_map(|phrase| Some((lower.find(phrase)?, *phrase)))?;
    let is_by = lower.get(..start)?.trim_end().ends_with("by");
    let rest = lower.get(start + phrase.len()..)?;
    let rest = rest.split(['?', '.', ';']).next().unwrap_or(rest);
    let words: Vec<&str> = rest.split(|c: char| !c.is_alphabetic()).filter(|word| !word.is_empty()).collect();
    let change = |word: &str, part| {
        Some(Change { message: format!("the question asks for a change (\"{word}\")"), part })
    };
    if let Some(word) = words.iter().find(|word| LOSES.contains(word)) {
        return change(word, Part::Loss);
    }
    let near = if is_by { words.len() } else { 1 };
    let compared = words.iter().take(near).find_map(|word| match word {
        word if SMALLER.contains(word) => Some((*word, Part::Smaller)),
        word if LARGER.contains(word) => Some((*word, Part::Larger)),
        _ => None,
    });
    if let Some((word, part)) = compared {
        return change(word, part);
    }
    let verb = |stems: &[&str]| words.iter().find(|word| stems.iter().any(|stem| word.starts_with(stem)));
    match (verb(&DECREASES), verb(&INCREASES)) {
        (Some(word), None) if is_by => change(word, Part::Smaller),
        (None, Some(word)) if is_by => change(word, Part::Larger),
        _ => None,
    }
}

/// The change that a quote states: a comparative behind the number of percent (`41 % longer`), or a verb before it (`falls by 41 %`).
fn change(quote: &str) -> Option<Change> {
    let lower = quote.to_lowercase();
    let (before, behind) =
        ["%", "percent", "per cent"].into_iter().find_map(|unit| lower.split_once(unit))?;
    let word: String = behind.trim_start().chars().take_while(|c| c.is_alphabetic()).collect();
    let is_smaller = SMALLER.contains(&word.as_str());
    let part = |is_smaller: bool| if is_smaller { Part::Smaller } else { Part::Larger };
    if is_smaller || LARGER.contains(&word.as_str()) {
        return Some(Change {
            message: format!("the text says how much {word} it is"),
            part: part(is_smaller),
        });
    }
    // `by 41 % of the first rise` is a part of something.
    if word == "of" {
        return None;
    }
    let mut words = before.rsplit(|c: char| !c.is_alphabetic()).filter(|word| !word.is_empty());
    // `to` before the number would name what remains. An adverb may be between: `by about 41 %`.
    let near: Vec<&str> = words.by_ref().take(ADVERBS + 1).take_while(|word| *word != "by").collect();
    if near.len() > ADVERBS {
        return None;
    }
    let others: Vec<&str> = words.take(VERB_WORDS).collect();
    let verb = |stems: &[&str]| others.iter().find(|word| stems.iter().any(|stem| word.starts_with(stem)));
    let (verb, is_smaller) = match (verb(&DECREASES), verb(&INCREASES)) {
        (Some(verb), None) => (verb, true),
        (None, Some(verb)) => (verb, false),
        _ => return None,
    };
    let message = format!("the text says by how much it changes (\"{verb} by\")");
    Some(Change { message, part: part(is_smaller) })
}

/// The two terms of an expression that is the ratio of one measure in two runs, perhaps times a number; with `any`, of any two measures
/// that are no differences.
fn ratio(e: &Expr, any: bool, texts: MeasureTexts<'_>) -> Option<[String; 2]> {
    let ExprKind::Binary { op, left, right } = &e.kind else { return None };
    match op {
        BinaryOp::Multiply if constant(left).is_some() => ratio(right, any, texts),
        BinaryOp::Multiply if constant(right).is_some() => ratio(left, any, texts),
        BinaryOp::Divide => {
            // `100 * a.t / b.t` is `(100 * a.t) / b.t`.
            let left = match &left.kind {
                ExprKind::Binary { op: BinaryOp::Multiply, left: x, right: y } => {
                    match (constant(x), constant(y)) {
                        (Some(_), None) => y,
                        (None, Some(_)) => x,
                        _ => return None,
                    }
                }
                _ => left,
            };
            let [a, b] = [measure(left, any)?, measure(right, any)?];
            let is_whole = |name: &str| texts(name).is_some_and(|text| !text.contains('-'));
            let is_ratio = a == b || any && is_whole(a) && is_whole(b);
            is_ratio.then(|| [print(left), print(right)])
        }
        _ => None,
    }
}

/// The two measures of `1 - a / b`, perhaps times a number.
fn loss(e: &Expr) -> Option<[String; 2]> {
    let ExprKind::Binary { op, left, right } = &e.kind else { return None };
    match (op, constant(left), constant(right)) {
        (BinaryOp::Multiply, Some(_), _) => loss(right),
        (BinaryOp::Multiply, _, Some(_)) => loss(left),
        (BinaryOp::Subtract, Some(1.0), None) => {
            let ExprKind::Binary { op: BinaryOp::Divide, left: a, right: b } = &right.kind else {
                return None;
            };
            (measure(a, true).is_some() && (measure(b, true).is_some() || constant(b).is_some()))
                .then(|| [print(a), print(b)])
        }
        _ => None,
    }
}

/// The name of the measure of `run.measure`; with `bare`, of `measure` as well.
fn measure(e: &Expr, bare: bool) -> Option<&str> {
    match &e.kind {
        ExprKind::Name(name) if bare => Some(name),
        ExprKind::Member { object, name, .. } if matches!(object.kind, ExprKind::Name(_)) => Some(&name.text),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn is_reported(quote: &str, expr: &str) -> bool {
        let [quote, expr] = [quote, expr].map(|text| Text::derived(text.to_string(), 0..1));
        check_ratio_of_change(&quote, None, &expr, &text_of, &mut Vec::new()).is_some()
    }

    fn text_of(name: &str) -> Option<String> {
        let text = match name {
            "lost" => "initial(lib.energy().total) - final(lib.energy().total)",
            _ => "max(data.qpos[2])",
        };
        Some(text.to_string())
    }

    #[test]
    fn what_is_lost_does_not_remain() {
        for (quote, expr) in [
            ("loses 35 % of its height", "100 * a.apex / a.z"),
            ("loses about 35 %", "100 * apex / z"),
            ("91 % of the energy is left", "100 * (1 - e1 / e0)"),
            ("keeps 91 %", "1 - a.e1 / a.e0"),
            ("91 % is left", "100 * (1 - a.e1 / 0.36)"),
        ] {
            assert!(is_reported(quote, expr), "{quote}: {expr}");
        }
        for (quote, expr) in [
            ("loses 35 % of its height", "100 * (1 - a.apex / a.z)"),
            ("loses 35 % of its energy", "100 * a.lost / a.z"),
            ("91 % of the energy is left", "100 * e1 / e0"),
            ("35 % of its height", "100 * a.apex / a.z"),
        ] {
            assert!(!is_reported(quote, expr), "{quote}: {expr}");
        }
    }

    #[test]
    fn a_question_for_a_change_is_not_answered_by_a_ratio() {
        let is_reported = |question: &str, expr: &str| {
            let [question, expr] = [question, expr].map(|text| Text::derived(text.to_string(), 0..1));
            check_asked_change(&question, &expr, &text_of, &mut Vec::new()).is_some()
        };
        for question in [
            "By how many percent does the period grow?",
            "By what percentage is it longer?",
            "How many percent longer is the wide swing?",
        ] {
            assert!(is_reported(question, "100 * wide.T / small.T"), "{question}");
            assert!(!is_reported(question, "100 * (wide.T / small.T - 1)"), "{question}");
        }
        assert!(is_reported("What percentage of its energy does it lose?", "100 * e1 / e0"));
        for question in
            ["What percentage of its energy is left?", "How many percent of the height does it reach?"]
        {
            assert!(!is_reported(question, "100 * e1 / e0"), "{question}");
        }
    }

    #[test]
    fn a_change_is_no_ratio() {
        for (quote, expr) in [
            ("41 % longer", "100 * earth.t / moon.t"),
            ("41 % shorter", "100 * (earth.t / moon.t)"),
            ("41 percent more", "earth.t / moon.t"),
            ("falls by 41 %", "100 * earth.t / moon.t"),
            ("is reduced by about 41 %", "100 * earth.t / moon.t"),
            ("The time grows by 41 %", "100 * earth.t / moon.t"),
        ] {
            assert!(is_reported(quote, expr), "{quote}: {expr}");
        }
        for (quote, expr) in [
            ("41 % longer", "100 * (earth.t / moon.t - 1)"),
            ("41 % of the time", "100 * earth.t / moon.t"),
            ("41 %", "100 * earth.t / moon.t"),
            ("falls to 41 %", "100 * earth.t / moon.t"),
            ("rises by 41 % of the first rise", "100 * second.rise / first.rise"),
            ("differs by 41 %", "100 * earth.t / moon.t"),
            ("divided by 41 %", "100 * earth.t / moon.t"),
            ("falls by 41 %", "100 * (1 - earth.t / moon.t)"),
            ("41 % longer", "100 * a.gain / a.t"),
            ("41 % longer", "percent"),
        ] {
            assert!(!is_reported(quote, expr), "{quote}: {expr}");
        }
    }
}
