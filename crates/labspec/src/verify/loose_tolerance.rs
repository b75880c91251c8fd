//! Finds conditions that call two measured values equal within a tolerance that is larger than the values.

use super::bound::BoundVerify;
use super::format::significant;
use super::option_numbers::{constant, is_below, magnitude};
use super::outcome::MeasuredRuns;
use crate::finding::Finding;
use crate::rules;
use crate::source::Text;
use labspec_expr::ast::{BinaryOp, Expr, ExprKind, LogicalOp};
use labspec_expr::{parse_expression, print};

/// The fraction of the larger value that a tolerance may have, and the fraction of the tolerance by which the values must differ:
/// two values that are noise beside the tolerance are equal.
const MAX_FRACTION: f64 = 0.5;
const MIN_DIFFERENCE: f64 = 0.2;

/// Reports comparisons in a condition that holds.
pub(super) fn check_tolerance(
    bound: &BoundVerify<'_>,
    outcome: &MeasuredRuns,
    condition: &Text,
    findings: &mut Vec<Finding>,
) {
    let value = |e: &Expr| {
        let text = Text::derived(print(e), condition.span());
        let found = bound.find(outcome, &text, &mut Vec::new())?.value.to_number();
        Some(found).filter(|x| x.is_finite())
    };
    for (a, b, tolerance) in equalities(&parse_expression(&condition.value).tree) {
        let (Some(x), Some(y)) = (value(&a), value(&b)) else { continue };
        let (size, difference) = (x.abs().max(y.abs()), (x - y).abs());
        if tolerance <= MAX_FRACTION * size || difference <= MIN_DIFFERENCE * tolerance {
            continue;
        }
        let message = format!(
            "`{}` and `{}` are {} and {}, and the condition accepts a difference of {}",
            print(&a),
            print(&b),
            significant(x),
            significant(y),
            significant(tolerance)
        );
        findings.push(
            Finding::new(rules::LOOSE_TOLERANCE, condition.span(), message)
                .why("so large a tolerance accepts nearly any result of the runs")
                .help(format!(
                    "compare with at most {}, a tenth of the larger value",
                    significant(0.1 * size)
                )),
        );
    }
}

/// The comparisons `abs(a - b) < number` in a condition.
fn equalities(e: &Expr) -> Vec<(Expr, Expr, f64)> {
    match &e.kind {
        ExprKind::Logical { op: LogicalOp::And, left, right } => {
            [equalities(left), equalities(right)].concat()
        }
        ExprKind::Binary { op, left, right } => {
            let (distance, tolerance, below) = match (constant(left), constant(right)) {
                (None, Some(number)) => (left, number, is_below(*op, false)),
                (Some(number), None) => (right, number, is_below(*op, true)),
                _ => return Vec::new(),
            };
            let of = magnitude(distance).filter(|_| below == Some(true));
            match of.map(|inner| &inner.kind) {
                Some(ExprKind::Binary { op: BinaryOp::Subtract, left, right })
                    if constant(left).is_none() && constant(right).is_none() =>
                {
                    vec![((**left).clone(), (**right).clone(), tolerance)]
                }
                _ => Vec::new(),
            }
        }
        _ => Vec::new(),
    }
}
