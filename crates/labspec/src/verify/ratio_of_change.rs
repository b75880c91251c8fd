//! Finds quotes such as "41 % longer" whose expression is the ratio of two measures instead of their relative difference.

use super::option_numbers::constant;
use super::quote::SMALLER;
use crate::finding::Finding;
use crate::rules;
use crate::source::Text;
use labspec_expr::ast::{BinaryOp, Expr, ExprKind};
use labspec_expr::{parse_expression, print};

const LARGER: [&str; 14] = [
    "more", "longer", "faster", "higher", "larger", "bigger", "greater", "heavier", "farther", "further",
    "deeper", "stronger", "later", "wider",
];

/// Reports a quote that states a change in percent, with an expression that is certainly a ratio. Returns the reason.
pub(super) fn check_ratio_of_change(
    quote: &Text,
    expr: &Text,
    findings: &mut Vec<Finding>,
) -> Option<String> {
    let word = word_of_change(quote.as_str())?;
    let [a, b] = ratio(&parse_expression(expr.as_str()).tree)?;
    let message = format!("the text says how much {word} it is, but the expression is the ratio of both");
    findings.push(
        Finding::error(rules::QUOTE_WRONG, quote.span(), message.clone())
            .why("a value that is 41 % of another one is 59 % smaller: the ratio is not the change")
            .help(if SMALLER.contains(&word.as_str()) {
                format!("write `100 * (1 - {a} / {b})` as the expression, and its value in the text")
            } else {
                format!("write `100 * ({a} / {b} - 1)` as the expression, and its value in the text")
            })
            .related(expr.span(), "the ratio"),
    );
    Some(message)
}

/// The comparative behind a number of percent: `41 % longer`.
fn word_of_change(quote: &str) -> Option<String> {
    let (_, behind) = ["%", "percent", "per cent"].into_iter().find_map(|unit| quote.split_once(unit))?;
    let word: String = behind.trim_start().chars().take_while(|c| c.is_alphabetic()).collect();
    let word = word.to_lowercase();
    (LARGER.contains(&word.as_str()) || SMALLER.contains(&word.as_str())).then_some(word)
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
        ] {
            assert!(is_reported(quote, expr), "{quote}: {expr}");
        }
        for (quote, expr) in [
            ("41 % longer", "100 * (earth.t / moon.t - 1)"),
            ("41 % of the time", "100 * earth.t / moon.t"),
            ("41 %", "100 * earth.t / moon.t"),
            ("41 % longer", "100 * a.gain / a.t"),
            ("41 % longer", "percent"),
        ] {
            assert!(!is_reported(quote, expr), "{quote}: {expr}");
        }
    }
}
