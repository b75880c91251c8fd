//! Finds quotes such as "41 % longer" and "falls by 41 %" whose expression is the ratio of two measures instead of their relative
//! difference, or their difference relative to the wrong one.

use super::option_numbers::constant;
use crate::finding::Finding;
use crate::language::words::{ends_with, find, split_words, starts_with};
use crate::language::{ComparisonWords, Languages};
use crate::rules;
use crate::source::Text;
use labspec_expr::ast::{BinaryOp, Expr, ExprKind};
use labspec_expr::{parse_expression, print};

/// A verb is at most this number of words before `by`: `grows in length by`.
const VERB_WORDS: usize = 4;
/// And the number at most this number of words behind it: `by about`.
const ADVERBS: usize = 1;
/// `left` is at most this number of words behind a number.
const REMAINS_WORDS: usize = 6;
/// They make a phrase behind a number one about something else: `5 % of what is lost`.
const RELATIVE_PRONOUNS: [&str; 6] = ["that", "which", "what", "qui", "que", "che"];
/// The part of a change by which the same change relative to the other value must differ: smaller differences may be rounded.
const LEAST_DIFFERENCE: f64 = 0.05;

/// The text of a measure by its name.
pub(super) type MeasureTexts<'t> = &'t dyn Fn(&str) -> Option<String>;

/// The expression beside a text.
#[derive(Clone, Copy)]
pub(super) struct StatedExpr<'t> {
    pub(super) text: &'t Text,
    /// Its value, if it is a number.
    pub(super) value: Option<f64>,
    pub(super) measures: MeasureTexts<'t>,
    pub(super) languages: Languages,
}

/// Reports a quote that states a change in percent, with an expression that is another one, or no change. `clause` is the text around the
/// quote. Returns the reason.
pub(super) fn check_ratio_of_change(
    quote: &Text,
    clause: Option<&str>,
    expr: StatedExpr<'_>,
    findings: &mut Vec<Finding>,
) -> Option<String> {
    let in_text = |text: &str| change(text, expr.languages).or_else(|| loss_or_rest(text, expr.languages));
    let stated = in_text(quote.as_str()).or_else(|| in_text(clause?))?;
    report(quote, &stated, expr, findings)
}

/// The same for the text of a numeric question: `By how many percent does the period grow?`
pub(super) fn check_asked_change(
    question: &Text,
    expr: StatedExpr<'_>,
    findings: &mut Vec<Finding>,
) -> Option<String> {
    report(question, &asked_change(question.as_str(), expr.languages)?, expr, findings)
}

/// Reports an expression that is not the change that a text states.
fn report(text: &Text, stated: &Change, expr: StatedExpr<'_>, findings: &mut Vec<Finding>) -> Option<String> {
    let tree = parse_expression(expr.text.as_str()).tree;
    let part = stated.part;
    let Mismatch { is, why, help } = match part {
        Part::Rest => loss_for_rest(&tree)?,
        _ => ratio_for_change(&tree, part, expr.measures).or_else(|| wrong_base(&tree, part, expr.value))?,
    };
    let message = format!("{}, but the expression is {is}", stated.message);
    findings.push(
        Finding::error(rules::QUOTE_WRONG, text.span(), message.clone())
            .why(why)
            .help(format!("write `{help}` as the expression, and correct the number"))
            .related(expr.text.span(), "the expression"),
    );
    Some(message)
}

/// What an expression is instead of the change that a text states.
struct Mismatch {
    is: String,
    why: &'static str,
    /// The expression to write.
    help: String,
}

const RATIO_IS_NO_CHANGE: &str =
    "a value that is 41 % of another one is 59 % smaller: the ratio is not the change";

/// A loss where the text states what remains.
fn loss_for_rest(tree: &Expr) -> Option<Mismatch> {
    let [a, b] = loss(tree)?;
    let is = format!("`1 - {a} / {b}`, what is lost");
    Some(Mismatch { is, why: RATIO_IS_NO_CHANGE, help: format!("100 * {a} / {b}") })
}

/// A ratio where the text states a change.
fn ratio_for_change(tree: &Expr, part: Part, measures: MeasureTexts<'_>) -> Option<Mismatch> {
    let [a, b] = ratio(tree, part == Part::Loss, measures)?;
    let help = match part {
        Part::Larger => format!("100 * ({a} / {b} - 1)"),
        _ => format!("100 * (1 - {a} / {b})"),
    };
    Some(Mismatch { is: "the ratio of both".to_string(), why: RATIO_IS_NO_CHANGE, help })
}

/// By how much one value is larger, where the text states how much smaller the other one is, or the reverse. Not if both have nearly the
/// same digits.
fn wrong_base(tree: &Expr, part: Part, value: Option<f64>) -> Option<Mismatch> {
    let RelativeChange { a, b, unit } = relative_change(tree)?;
    let fraction = value? / unit;
    let is_larger = fraction > 0.0;
    let is_wrong = match part {
        Part::Larger => !is_larger,
        Part::Smaller => is_larger,
        Part::Loss | Part::Rest => false,
    };
    let relative_to_other = fraction / (1.0 + fraction);
    let differs = (relative_to_other / fraction - 1.0).abs() > LEAST_DIFFERENCE;
    if !is_wrong || !differs {
        return None;
    }
    let (word, opposite, help) = match is_larger {
        true => ("larger", "smaller", format!("100 * (1 - {b} / {a})")),
        false => ("smaller", "larger", format!("100 * ({b} / {a} - 1)")),
    };
    Some(Mismatch {
        is: format!("by how much `{a}` is {word} than `{b}`, not by how much `{b}` is {opposite} than `{a}`"),
        why: "a value that is 100 % larger than another one is twice as large, and the other one is 50 % smaller",
        help,
    })
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

/// A text in lower case before and behind its first unit of percent.
fn around_percent(lower: &str, languages: Languages) -> Option<(&str, &str)> {
    let units = ["%"].into_iter().chain(languages.comparisons(|c| c.percent));
    let places = units.filter_map(|unit| {
        let start = if unit == "%" { lower.find(unit) } else { find(lower, unit) };
        Some((start?, unit.len()))
    });
    let (start, length) = places.min()?;
    Some((lower.get(..start)?, lower.get(start + length..)?))
}

/// The first of some phrases close behind a number. Behind a relative pronoun, it is about something else.
fn phrase_behind(behind: &str, words: ComparisonWords, languages: Languages) -> Option<&'static str> {
    let places = languages.comparisons(words).filter_map(|phrase| Some((find(behind, phrase)?, phrase)));
    let is_near = |(start, _): &(usize, &str)| {
        let between: Vec<&str> = split_words(behind.get(..*start).unwrap_or("")).collect();
        between.len() < REMAINS_WORDS && !between.iter().any(|word| RELATIVE_PRONOUNS.contains(word))
    };
    places.filter(is_near).min().map(|(_, phrase)| phrase)
}

/// What a quote says is lost (`loses 35 %`, `35 % is lost`), or remains (`keeps 65 %`, `65 % is left`).
fn loss_or_rest(quote: &str, languages: Languages) -> Option<Change> {
    let lower = quote.to_lowercase();
    let (before, behind) = around_percent(&lower, languages)?;
    let is_word = |word: &&str| word.chars().all(char::is_alphabetic);
    let near: Vec<&str> = split_words(before).filter(is_word).rev().take(ADVERBS + 1).collect();
    let verb = |words: ComparisonWords| {
        near.iter().copied().find(|word| languages.comparisons(words).any(|w| w == *word))
    };
    let behind = |words: ComparisonWords| phrase_behind(behind, words, languages);
    let lost = || behind(|c| c.is_lost).or_else(|| verb(|c| c.loses));
    let remaining = || verb(|c| c.keeps).or_else(|| behind(|c| c.remains));
    let (word, part) =
        lost().map(|word| (word, Part::Loss)).or_else(|| remaining().map(|word| (word, Part::Rest)))?;
    let what = if part == Part::Loss { "what is lost" } else { "what remains" };
    Some(Change { message: format!("the text says {what} (\"{word}\")"), part })
}

/// The change in percent that a question asks for: `By how many percent does it grow?`, `How many percent longer is it?`, `What percentage
/// of it is lost?`
fn asked_change(question: &str, languages: Languages) -> Option<Change> {
    let lower = question.to_lowercase();
    let mut phrases = languages.comparisons(|c| c.asks_percent);
    let (start, phrase) = phrases.find_map(|phrase| Some((lower.find(phrase)?, phrase)))?;
    let before = lower.get(..start)?.trim_end();
    let is_by = languages.comparisons(|c| c.by).any(|by| ends_with(before, by));
    let rest = lower.get(start + phrase.len()..)?.split(['?', '.', ';']).next()?;
    let words: Vec<&str> = split_words(rest).collect();
    let message = |word: &str| format!("the question asks for a change (\"{word}\")");
    let change = |word: &str, part| Some(Change { message: message(word), part });
    let is = |word: &str, list: ComparisonWords| languages.comparisons(list).any(|w| w == word);
    if let Some(word) = words.iter().find(|word| is(word, |c| c.loses)) {
        return change(word, Part::Loss);
    }
    // With the words behind it: `plus lente`. A comparative behind an article names a thing: `the lower speed`.
    let near = if is_by { words.len() } else { 1 };
    let mut end = 0;
    for (i, word) in words.iter().enumerate().take(near) {
        let start = end + rest.get(end..)?.find(word)?;
        end = start + word.len();
        let of_thing = i.checked_sub(1).and_then(|before| words.get(before)) == Some(&"the");
        if let Some(part) = comparative(rest.get(start..)?, languages).filter(|_| !of_thing) {
            return change(word, part);
        }
    }
    let (verb, part) = verb_of_change(&words, languages).filter(|_| is_by)?;
    change(verb, part)
}

/// What a text beginning with a comparative compares: `longer`.
fn comparative(text: &str, languages: Languages) -> Option<Part> {
    let begins = |words: ComparisonWords| languages.comparisons(words).any(|word| starts_with(text, word));
    match () {
        () if begins(|c| c.smaller) => Some(Part::Smaller),
        () if begins(|c| c.larger) => Some(Part::Larger),
        () => None,
    }
}

/// The verb of a decrease or of an increase among some words; `None` if there are both.
fn verb_of_change<'w>(words: &[&'w str], languages: Languages) -> Option<(&'w str, Part)> {
    let verb = |list: ComparisonWords| {
        let is_listed = |word: &&str| languages.comparisons(list).any(|stem| word.starts_with(stem));
        words.iter().copied().find(is_listed)
    };
    match (verb(|c| c.decreases), verb(|c| c.increases)) {
        (Some(verb), None) => Some((verb, Part::Smaller)),
        (None, Some(verb)) => Some((verb, Part::Larger)),
        _ => None,
    }
}

/// The change that a quote states: a comparative behind the number of percent (`41 % longer`), or a verb before it (`falls by 41 %`) or
/// behind it (`um 41 % sinkt`).
fn change(quote: &str, languages: Languages) -> Option<Change> {
    let lower = quote.to_lowercase();
    let (before, behind) = around_percent(&lower, languages)?;
    let behind = behind.trim_start();
    if let Some(part) = comparative(behind, languages) {
        let word = split_words(behind).next().unwrap_or("");
        return Some(Change { message: format!("the text says how much {word} it is"), part });
    }
    // `by 41 % of the first rise` is a part of something.
    if languages.words_of(|l| l.of).any(|of| starts_with(behind, of)) {
        return None;
    }
    let is_word = |word: &&str| word.chars().all(char::is_alphabetic);
    let words: Vec<&str> = split_words(before).filter(is_word).rev().collect();
    // `to` before the number would name what remains. An adverb may be between: `by about 41 %`.
    let is_by = |word: &&str| languages.comparisons(|c| c.by).any(|by| by == *word);
    let by = words.iter().take(ADVERBS + 1).position(is_by)?;
    let before: Vec<&str> = words.into_iter().skip(by + 1).take(VERB_WORDS).collect();
    let next: Vec<&str> =
        split_words(behind.split([',', '.', ';', ':']).next().unwrap_or("")).take(1).collect();
    let (verb, part) = verb_of_change(&before, languages).or_else(|| verb_of_change(&next, languages))?;
    Some(Change { message: format!("the text says by how much it changes (\"{verb}\")"), part })
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
            let (left, _) = without_factor(left);
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

/// `100 * (a / b - 1)`, or `100 * (1 - a / b)`.
struct RelativeChange {
    a: String,
    b: String,
    /// The value of the expression if `a` is larger than `b` by its whole value: 100, or -100.
    unit: f64,
}

/// The relative difference of one measure in two runs, perhaps times a number.
fn relative_change(e: &Expr) -> Option<RelativeChange> {
    let ExprKind::Binary { op, left, right } = &e.kind else { return None };
    let quotient = |e: &Expr, unit: f64| {
        let ExprKind::Binary { op: BinaryOp::Divide, left: a, right: b } = &e.kind else { return None };
        (measure(a, false)? == measure(b, false)?).then(|| RelativeChange { a: print(a), b: print(b), unit })
    };
    let scaled = |e: &Expr, factor: f64| {
        let change = relative_change(e)?;
        Some(RelativeChange { unit: factor * change.unit, ..change })
    };
    match (op, constant(left), constant(right)) {
        (BinaryOp::Multiply, Some(factor), None) => scaled(right, factor),
        (BinaryOp::Multiply, None, Some(factor)) => scaled(left, factor),
        (BinaryOp::Subtract, None, Some(1.0)) => quotient(left, 1.0),
        (BinaryOp::Subtract, Some(1.0), None) => quotient(right, -1.0),
        (BinaryOp::Divide, None, None) => {
            let (difference, factor) = without_factor(left);
            let ExprKind::Binary { op: BinaryOp::Subtract, left: a, right: b } = &difference.kind else {
                return None;
            };
            let is_change = measure(a, false)? == measure(b, false)?;
            let [a, b, base] = [a, b, right].map(|e| print(e));
            match () {
                // `(a - b) / b`, and `(a - b) / a`.
                () if is_change && base == b => Some(RelativeChange { a, b, unit: factor }),
                () if is_change && base == a => Some(RelativeChange { a: b, b: a, unit: -factor }),
                () => None,
            }
        }
        _ => None,
    }
}

/// An expression without a constant factor, and the factor.
fn without_factor(e: &Expr) -> (&Expr, f64) {
    let ExprKind::Binary { op: BinaryOp::Multiply, left, right } = &e.kind else { return (e, 1.0) };
    match (constant(left), constant(right)) {
        (Some(factor), None) => (right, factor),
        (None, Some(factor)) => (left, factor),
        _ => (e, 1.0),
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
        check_ratio_of_change(&quote, None, beside(&expr, None), &mut Vec::new()).is_some()
    }

    fn beside(text: &Text, value: Option<f64>) -> StatedExpr<'_> {
        StatedExpr { text, value, measures: &text_of, languages: Languages::ALL }
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
            ("35 % of the energy is lost", "100 * a.apex / a.z"),
            ("35 % der Energie gehen verloren", "100 * a.apex / a.z"),
            ("verliert etwa 35 %", "100 * a.apex / a.z"),
            ("garde 91 %", "100 * (1 - e1 / e0)"),
            ("91 % bleiben übrig", "100 * (1 - e1 / e0)"),
        ] {
            assert!(is_reported(quote, expr), "{quote}: {expr}");
        }
        for (quote, expr) in [
            ("loses 35 % of its height", "100 * (1 - a.apex / a.z)"),
            ("loses 35 % of its energy", "100 * a.lost / a.z"),
            ("91 % of the energy is left", "100 * e1 / e0"),
            ("35 % of its height", "100 * a.apex / a.z"),
            ("35 % of the energy that is lost", "100 * a.apex / a.z"),
            ("the remaining 35 % is lost", "100 * (1 - a.apex / a.z)"),
        ] {
            assert!(!is_reported(quote, expr), "{quote}: {expr}");
        }
    }

    #[test]
    fn a_question_for_a_change_is_not_answered_by_a_ratio() {
        let is_reported = |question: &str, expr: &str| {
            let [question, expr] = [question, expr].map(|text| Text::derived(text.to_string(), 0..1));
            check_asked_change(&question, beside(&expr, None), &mut Vec::new()).is_some()
        };
        for question in [
            "By how many percent does the period grow?",
            "By what percentage is it longer?",
            "How many percent longer is the wide swing?",
            "Um wie viel Prozent wächst die Periode?",
            "Um wie viel Prozent ist sie länger?",
            "De quel pourcentage augmente-t-elle ?",
            "¿En qué porcentaje aumenta?",
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
            ("41 % länger", "100 * earth.t / moon.t"),
            ("sinkt um etwa 41 Prozent", "100 * earth.t / moon.t"),
            ("dass sie um 41 % sinkt", "100 * earth.t / moon.t"),
            ("41 % plus long", "100 * earth.t / moon.t"),
            ("diminue de 41 %", "100 * earth.t / moon.t"),
        ] {
            assert!(is_reported(quote, expr), "{quote}: {expr}");
        }
        for (quote, expr) in [
            ("41 % longer", "100 * (earth.t / moon.t - 1)"),
            ("41 % of the time", "100 * earth.t / moon.t"),
            ("sinkt auf 41 %", "100 * earth.t / moon.t"),
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

    #[test]
    fn the_other_value_changes_by_another_part() {
        let is_reported = |quote: &str, expr: &str, value: f64| {
            let [quote, expr] = [quote, expr].map(|text| Text::derived(text.to_string(), 0..1));
            check_ratio_of_change(&quote, None, beside(&expr, Some(value)), &mut Vec::new()).is_some()
        };
        for (quote, expr, value) in [
            ("16 % shorter", "100 * (wide.T / small.T - 1)", 16.0),
            ("16 % shorter", "100 * (wide.T - small.T) / small.T", 16.0),
            ("14 % longer", "100 * (1 - small.T / wide.T)", 14.0),
            ("falls by 16 %", "100 * (wide.T / small.T - 1)", 16.0),
        ] {
            assert!(is_reported(quote, expr, value), "{quote}: {expr}");
        }
        for (quote, expr, value) in [
            ("16 % longer", "100 * (wide.T / small.T - 1)", 16.0),
            ("14 % shorter", "100 * (1 - small.T / wide.T)", 14.0),
            ("14 % shorter", "100 * (small.T / wide.T - 1)", -14.0),
            ("14 % shorter", "100 * (small.T - wide.T) / wide.T", -14.0),
            ("0.5 % shorter", "100 * (wide.T / small.T - 1)", 0.5),
            ("16 % shorter", "100 * (1 - small.apex / wide.z)", -16.0),
        ] {
            assert!(!is_reported(quote, expr, value), "{quote}: {expr}");
        }
    }
}
