//! Finds tolerances that act on one side only: `a.t - b.t < 0.01` holds for any `a.t` below `b.t`, and `a.v > b.v - 0.01` for equal values.

use super::bound::BoundVerify;
use super::format::significant;
use super::option_numbers::{constant, is_below, magnitude};
use super::outcome::MeasuredRuns;
use super::value_of::{states_number, value_of};
use crate::finding::Finding;
use crate::language::words::find;
use crate::language::{ComparisonWords, Languages};
use crate::rules;
use crate::source::Text;
use labspec_expr::ast::{BinaryOp, Expr, ExprKind, LogicalOp, UnaryOp};
use labspec_expr::{parse_expression, print};

/// The largest relative tolerance: a larger factor is a bound of its own (`b.t < 1.5 * a.t`).
const MAX_RELATIVE: f64 = 0.05;
/// A tolerance does not act if the difference is this many times as large, and this fraction of the larger value.
const FAR: f64 = 5.0;
const FAR_FRACTION: f64 = 0.02;
/// A comparison of two terms: `smaller < larger + tolerance`
struct OneSided<'e> {
    smaller: &'e Expr,
    larger: &'e Expr,
    tolerance: Tolerance,
}

/// The tolerance that a comparison states; `None` if it has none, or states by how much one term is at least larger.
#[derive(Clone, Copy)]
enum Tolerance {
    None,
    Absolute(f64),
    /// A fraction of the larger term.
    Relative(f64),
}

/// Reports comparisons in a condition that holds, beside the option or the statement that it belongs to.
pub(super) fn check_one_sided(
    bound: &BoundVerify<'_>,
    outcome: &MeasuredRuns,
    (stated, condition): (&Text, &Text),
    findings: &mut Vec<Finding>,
) {
    let tree = parse_expression(&condition.value).tree;
    if let Some(inner) = compared_magnitude(&tree) {
        findings.push(
            Finding::new(
                rules::ONE_SIDED_TOLERANCE,
                condition.span(),
                format!("`abs` gets the comparison `{}`, not a difference", print(inner)),
            )
            .why("the magnitude of true is 1: the condition is the comparison, which has one side only")
            .help("close the parenthesis before the comparison: `abs(a - b) < 0.01`"),
        );
    }
    let mut all = Vec::new();
    one_sided(&tree, &mut all);
    let names = |e: &Expr, other: &Expr| (print(e), print(other));
    let pairs: Vec<(String, String)> = all.iter().map(|c| names(c.smaller, c.larger)).collect();
    all.retain(|comparison| !matches!(comparison.tolerance, Tolerance::None));
    if states_bound(stated.as_str(), bound.stage().languages()) {
        return;
    }
    for OneSided { smaller, larger, tolerance } in all {
        // With the opposite comparison beside it, it has two sides.
        let is_stated = || states_number(bound, outcome, smaller, (stated, condition));
        if !are_of_two_runs(smaller, larger) || pairs.contains(&names(larger, smaller)) || is_stated() {
            continue;
        }
        let [x, y] = [smaller, larger].map(|e| value_of(bound, outcome, e, condition));
        let (Some(x), Some(y)) = (x, y) else { continue };
        let tolerance = match tolerance {
            Tolerance::None => continue,
            Tolerance::Absolute(tolerance) => tolerance,
            Tolerance::Relative(fraction) => fraction * y.abs(),
        };
        let [a, b] = [print(smaller), print(larger)];
        let is_far = y - x > FAR * tolerance && y - x > FAR_FRACTION * x.abs().max(y.abs());
        let is_near = (x - y).abs() < tolerance;
        let why = match (is_far, is_near) {
            (true, _) => "the tolerance acts on one side only: every smaller value is accepted, too",
            (_, true) => {
                "the condition holds because of its tolerance: it holds for equal values, and for both orders of these values"
            }
            _ => continue,
        };
        let values = format!(
            "`{a}` is {} and `{b}` is {}, and the condition accepts any value of `{a}` up to {} above `{b}`",
            significant(x),
            significant(y),
            significant(tolerance)
        );
        findings.push(
            Finding::new(rules::ONE_SIDED_TOLERANCE, condition.span(), values).why(why).help(format!(
                "write `abs({a} - {b}) < {}` if they are equal, and `{a} < {b}` or a larger difference if one is smaller",
                significant(tolerance)
            )),
        );
    }
}

/// Whether two terms are one measure in two runs. Two measures of one run are a duration or a loss, whose order is usually certain.
fn are_of_two_runs(a: &Expr, b: &Expr) -> bool {
    let parts = |e: &Expr| match &e.kind {
        ExprKind::Member { object, name, .. } => Some((print(object), name.text.clone())),
        _ => None,
    };
    parts(a).zip(parts(b)).is_some_and(|(a, b)| a.0 != b.0 && a.1 == b.1)
}

/// The comparison in `abs(a - b < 0.01)`.
fn compared_magnitude(e: &Expr) -> Option<&Expr> {
    match &e.kind {
        ExprKind::Logical { left, right, .. } => {
            compared_magnitude(left).or_else(|| compared_magnitude(right))
        }
        ExprKind::Unary { operand, .. } => compared_magnitude(operand),
        _ => magnitude(e).filter(
            |inner| matches!(&inner.kind, ExprKind::Binary { op, .. } if is_below(*op, false).is_some()),
        ),
    }
}

/// Whether a text states a bound: `not slower`, `at least as fast`.
fn states_bound(text: &str, languages: Languages) -> bool {
    let lists: [ComparisonWords; 3] = [|c| c.negations, |c| c.negative_articles, |c| c.limits];
    let lower = text.to_lowercase();
    let mut phrases = lists.iter().flat_map(|list| languages.comparisons(list));
    phrases.any(|phrase| find(&lower, phrase).is_some()) || lower.contains("n't") || lower.contains("n’t")
}

/// Appends the comparisons of two terms.
fn one_sided<'e>(e: &'e Expr, found: &mut Vec<OneSided<'e>>) {
    match &e.kind {
        ExprKind::Logical { op: LogicalOp::And, left, right } => {
            one_sided(left, found);
            one_sided(right, found);
        }
        ExprKind::Binary { op, left, right } => {
            let (smaller, larger) = match is_below(*op, false) {
                Some(true) => (left, right),
                Some(false) => (right, left),
                None => return,
            };
            let (mut terms, mut number) = (Vec::new(), 0.0);
            add_terms(smaller, 1.0, &mut terms, &mut number);
            add_terms(larger, -1.0, &mut terms, &mut number);
            found.extend(of_terms(&terms, number));
        }
        _ => {}
    }
}

/// The comparison of two terms, given as a sum with a number that is below 0.
fn of_terms<'e>(terms: &[(f64, &'e Expr)], number: f64) -> Option<OneSided<'e>> {
    let is_small = |fraction: f64| 0.0 < fraction && fraction <= MAX_RELATIVE + 1e-12;
    match *terms {
        [(f, a), (g, b)] if f * g < 0.0 => {
            let (factor, smaller, base, larger) = if f > 0.0 { (f, a, -g, b) } else { (g, b, -f, a) };
            let (tolerance, fraction) = (-number / factor, base / factor - 1.0);
            let tolerance = match () {
                () if fraction.abs() < 1e-12 && tolerance > 0.0 => Tolerance::Absolute(tolerance),
                () if number == 0.0 && is_small(fraction) => Tolerance::Relative(fraction),
                () => Tolerance::None,
            };
            Some(OneSided { smaller, larger, tolerance })
        }
        // `a / b < 1.01`, and `a / b > 0.99`.
        [(f, quotient)] => {
            let quotient = magnitude(quotient).unwrap_or(quotient);
            let ExprKind::Binary { op: BinaryOp::Divide, left, right } = &quotient.kind else { return None };
            if constant(left).is_some() || constant(right).is_some() {
                return None;
            }
            let level = -number / f;
            let (smaller, larger, fraction) =
                if f > 0.0 { (left, right, level - 1.0) } else { (right, left, 1.0 - level) };
            let tolerance = if is_small(fraction) { Tolerance::Relative(fraction) } else { Tolerance::None };
            Some(OneSided { smaller, larger, tolerance })
        }
        _ => None,
    }
}

/// Appends the terms of a sum with their factors, and adds its numbers.
fn add_terms<'e>(e: &'e Expr, factor: f64, terms: &mut Vec<(f64, &'e Expr)>, number: &mut f64) {
    if let Some(x) = constant(e) {
        *number += factor * x;
        return;
    }
    match &e.kind {
        ExprKind::Binary { op: op @ (BinaryOp::Add | BinaryOp::Subtract), left, right } => {
            let sign = if *op == BinaryOp::Add { 1.0 } else { -1.0 };
            add_terms(left, factor, terms, number);
            add_terms(right, sign * factor, terms, number);
        }
        ExprKind::Binary { op: BinaryOp::Multiply, left, right } => match (constant(left), constant(right)) {
            (Some(x), None) => add_terms(right, factor * x, terms, number),
            (None, Some(x)) => add_terms(left, factor * x, terms, number),
            _ => terms.push((factor, e)),
        },
        ExprKind::Unary { op: UnaryOp::Minus, operand } => add_terms(operand, -factor, terms, number),
        _ => terms.push((factor, e)),
    }
}

#[cfg(test)]
mod tests {
    use super::super::loose_tolerance::tests::found;

    #[test]
    fn a_tolerance_has_two_sides() {
        let is_found =
            |option: &str, condition: &str| found(option, condition, "one-sided-tolerance").len() == 1;
        for condition in [
            "small.T - wide.T < 0.01",
            "small.T < wide.T + 0.01",
            "small.T / wide.T - 1 < 0.01",
            "abs(small.T / wide.T) - 1 < 0.01",
            "small.T < 1.01 * wide.T",
            "wide.T > small.T - 0.01",
            "wide.T / small.T > 0.99",
            "abs(small.T - wide.T < 0.01)",
        ] {
            assert!(is_found("stays the same", condition), "{condition}");
        }
        assert!(is_found("becomes longer", "small.T > wide.T - 0.5"));
        for (option, condition) in [
            ("becomes longer", "wide.T > small.T"),
            ("becomes longer", "wide.T > small.T + 0.1"),
            ("becomes longer", "wide.T > 1.1 * small.T"),
            ("is no shorter", "small.T - wide.T < 0.01"),
            ("grows by less than a second", "wide.T - small.T < 1"),
            ("is at most 0.5 s longer", "wide.T < small.T + 0.5"),
            ("is about the same", "wide.T - small.T < 0.3 && small.T - wide.T < 0.3"),
            ("is about the same", "abs(wide.T - small.T) < 0.3"),
            ("becomes a little longer", "wide.T > small.T + 0.1 && wide.T < small.T + 0.5"),
            ("becomes a little longer", "wide.T > 1.1 * small.T && wide.T < small.T + 0.5"),
        ] {
            assert!(!is_found(option, condition), "{option}: {condition}");
        }
    }
}
