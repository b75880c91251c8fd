//! Finds numeric questions for a ratio whose expression is its inverse: "How many times as long does it take on the moon as on the earth?"
//! beside `earth.t / moon.t`.

use super::bound::BoundVerify;
use super::option_numbers::constant;
use super::outcome::MeasuredRuns;
use super::{quote, units};
use crate::finding::Finding;
use crate::json::read::named;
use crate::rules;
use crate::source::Text;
use labspec_expr::ast::{BinaryOp, Expr, ExprKind};
use labspec_expr::dimension::Dimension;
use labspec_expr::{parse_expression, print};

/// Reports a question whose expression is the inverse of the ratio that it asks for. Returns the reason.
pub(super) fn check_ratio_order(
    bound: &BoundVerify<'_>,
    outcome: &MeasuredRuns,
    question: &Text,
    expr: &Text,
    findings: &mut Vec<Finding>,
) -> Option<String> {
    let runs: Vec<&str> = bound.runs.iter().map(|run| run.name).collect();
    let Order { first, second, quantity } = asked_order(question.as_str(), &runs)?;
    let tree = parse_expression(expr.as_str()).tree;
    let (above, below) = ratio_of_runs(&tree)?;
    if (run_of(above), run_of(below)) != (Some(second), Some(first)) {
        return None;
    }
    let [a, b] = [above, below].map(print);
    // "How many times as fast" asks for the inverse of a ratio of times.
    let measured = units::of_claim(bound, outcome, &Text::derived(a.clone(), expr.span()))?;
    if !measured.is_exact() || !quantity.iter().any(|dimension| dimension.agrees(&measured)) {
        return None;
    }
    let message = format!(
        "the question asks how many times as large it is in {} as in {}, but the expression is `{a} / {b}`",
        named(first),
        named(second)
    );
    findings.push(
        Finding::error(rules::QUOTE_WRONG, question.span(), message.clone())
            .why("a student who computes the ratio that the question asks for is graded as wrong")
            .help(format!("write `{b} / {a}`, and its value as the answer"))
            .related(expr.span(), "the expression"),
    );
    Some(message)
}

/// The two runs of a question for a ratio, and the dimensions that its adjective names.
struct Order<'r> {
    first: &'r str,
    second: &'r str,
    quantity: Vec<Dimension>,
}

/// The two runs of `how many times as … FIRST as … SECOND`, and of `how many times longer … FIRST than … SECOND`.
fn asked_order<'r>(question: &str, runs: &[&'r str]) -> Option<Order<'r>> {
    let lower = question.to_lowercase();
    let (_, asked) = lower.split_once("how many times ")?;
    let asked = asked.split(['?', ';']).next().unwrap_or(asked);
    let asked = asked.split(". ").next().unwrap_or(asked);
    let (one, other) = match asked.strip_prefix("as ") {
        Some(rest) => rest.split_once(" as ")?,
        None => asked.split_once(" than ")?,
    };
    let only = |text: &str| -> Option<&'r str> {
        let words: Vec<&str> = text.split(|c: char| !(c.is_alphanumeric() || c == '_')).collect();
        let mut found = runs.iter().filter(|run| words.contains(&run.to_lowercase().as_str()));
        let first = found.next()?;
        found.next().is_none().then_some(*first)
    };
    let (first, second) = (only(one)?, only(other)?);
    let adjective = asked.strip_prefix("as ").unwrap_or(asked).split(|c: char| !c.is_alphabetic()).next()?;
    let is_large = !["short", "shorter", "slow", "slower", "earlier"].contains(&adjective);
    (first != second && is_large).then(|| Order {
        first,
        second,
        quantity: quote::named_quantities(adjective),
    })
}

/// The two terms of a quotient of one measure in two runs.
fn ratio_of_runs(e: &Expr) -> Option<(&Expr, &Expr)> {
    let ExprKind::Binary { op, left, right } = &e.kind else { return None };
    match op {
        BinaryOp::Multiply if constant(left).is_some() => ratio_of_runs(right),
        BinaryOp::Multiply if constant(right).is_some() => ratio_of_runs(left),
        BinaryOp::Divide => (measure_of(left)? == measure_of(right)?).then_some((left, right)),
        _ => None,
    }
}

/// The run of `run.measure`.
pub(super) fn run_of(e: &Expr) -> Option<&str> {
    let ExprKind::Member { object, .. } = &e.kind else { return None };
    let ExprKind::Name(name) = &object.kind else { return None };
    Some(name)
}

/// The measure of `run.measure`.
pub(super) fn measure_of(e: &Expr) -> Option<&str> {
    let ExprKind::Member { name, .. } = &e.kind else { return None };
    run_of(e).map(|_| name.text.as_str())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_question_names_two_runs_in_their_order() {
        let order =
            |text: &str| asked_order(text, &["earth", "moon"]).map(|order| (order.first, order.second));
        for text in [
            "How many times as long does it fall on the moon as on the earth?",
            "How many times as long is it on the moon (1.62 m/s²) as on the earth?",
            "On both, how many times longer is it on the Moon than on the Earth?",
        ] {
            assert_eq!(order(text), Some(("moon", "earth")), "{text}");
        }
        for text in [
            "How many times does it bounce on the moon?",
            "Compared with the earth, how many times as long does it take on the moon?",
            "How many times as long as on the earth does it take on the moon?",
        ] {
            assert_eq!(order(text), None, "{text}");
        }
        let tree = parse_expression("100 * earth.t / moon.t").tree;
        assert!(ratio_of_runs(&tree).is_none());
        let tree = parse_expression("100 * (earth.t / moon.t)").tree;
        assert_eq!(
            ratio_of_runs(&tree).map(|(a, b)| (run_of(a), run_of(b))),
            Some((Some("earth"), Some("moon")))
        );
    }
}
