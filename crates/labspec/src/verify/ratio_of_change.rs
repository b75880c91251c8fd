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

/// Reports a quote that states a change in percent, with an expression that is certainly a ratio. Returns the reason.
pub(super) fn check_ratio_of_change(
    quote: &Text,
    expr: &Text,
    findings: &mut Vec<Finding>,
) -> Option<String> {
    let Change { message, is_smaller } = change(quote.as_str())?;
    let [a, b] = ratio(&parse_expression(expr.as_str()).tree)?;
    findings.push(
        Finding::error(rules::QUOTE_WRONG, quote.span(), message.clone())
            .why("a value that is 41 % of another one is 59 % smaller: the ratio is not the change")
            .help(if is_smaller {
                format!("write `100 * (1 - {a} / {b})` as the expression, and its value in the text")
            } else {
                format!("write `100 * ({a} / {b} - 1)` as the expression, and its value in the text")
            })
            .related(expr.span(), "the ratio"),
    );
    Some(message)
}

/// A change in percent that a quote states.
struct Change {
    message: String,
    is_smaller: bool,
}

/// The change that a quote states: a comparative behind the number of percent (`41 % longer`), or a verb before it (`falls by 41 %`).
fn change(quote: &str) -> Option<Change> {
    let lower = quote.to_lowercase();
    let (before, behind) =
        ["%", "percent", "per cent"].into_iter().find_map(|unit| lower.split_once(unit))?;
    let word: String = behind.trim_start().chars().take_while(|c| c.is_alphabetic()).collect();
    let is_smaller = SMALLER.contains(&word.as_str());
    if is_smaller || LARGER.contains(&word.as_str()) {
        let message = format!("the text says how much {word} it is, but the expression is the ratio of both");
        return Some(Change { message, is_smaller });
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
    let message = format!(
        "the text says by how much it changes (\"{verb} by\"), but the expression is the ratio of both"
    );
    Some(Change { message, is_smaller })
}

/// The two terms of an expression that is the ratio of one measure in two runs, perhaps times a number.
fn ratio(e: &Expr) -> Option<[String; 2]> {
    let ExprKind::Binary { op, left, right } = &e.kind else { return None };
    match op {
        BinaryOp::Multiply if constant(left).is_some() => ratio(right),
        BinaryOp::Multiply if constant(right).is_some() => ratio(left),
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
            (measure(left)? == measure(right)?).then(|| [print(left), print(right)])
        }
        _ => None,
    }
}

/// The name of the measure of `run.measure`.
fn measure(e: &Expr) -> Option<&str> {
    match &e.kind {
        ExprKind::Member { object, name, .. } if matches!(object.kind, ExprKind::Name(_)) => Some(&name.text),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn is_reported(quote: &str, expr: &str) -> bool {
        let [quote, expr] = [quote, expr].map(|text| Text::derived(text.to_string(), 0..1));
        check_ratio_of_change(&quote, &expr, &mut Vec::new()).is_some()
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
