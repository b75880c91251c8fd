//! Compares the number in the text of an option with its condition: "about 7 m" cannot be right if the condition requires
//! 1.23 m.

use super::bound::BoundVerify;
use super::format::significant;
use super::outcome::MeasuredRuns;
use super::quote::{OptionNumber, UnitMatch, conversion, hold, option_ratio, option_text};
use super::units;
use crate::finding::Finding;
use crate::rules;
use crate::source::{SourceMap, Text};
use labspec_expr::ast::{BinaryOp, Expr, ExprKind, LogicalOp, UnaryOp};
use labspec_expr::{parse_expression, print};

/// Factor by which the number of an option may differ where its condition has one side only.
const NEAREST: f64 = 1.5;

/// The range that a condition requires of the one quantity that it compares with numbers.
#[derive(Clone, Debug, PartialEq)]
struct RequiredRange {
    quantity: String,
    /// Whether the quantity is a ratio of two measured quantities.
    ratio: bool,
    low: f64,
    high: f64,
}

/// Compares the numbers of all options with their conditions. `held` contains which of them hold. Returns the reason if one
/// contradicts.
pub(super) fn check_option_numbers(
    bound: &BoundVerify<'_>,
    outcome: &MeasuredRuns,
    options: &[Text],
    conditions: &[Text],
    held: &[Option<bool>],
    findings: &mut Vec<Finding>,
) -> Option<String> {
    let mut reason = None;
    for ((option, condition), held) in options.iter().zip(conditions).zip(held) {
        let Some(message) = contradiction(bound, outcome, option, condition, *held == Some(true)) else {
            continue;
        };
        findings.push(
            Finding::error(rules::QUOTE_WRONG, option.span(), message.clone())
                .why("the option states one number, but its condition asks for another")
                .help("correct the number in the option, or its condition")
                .related(condition.span(), "the condition of this option"),
        );
        reason = reason.or(Some(message));
    }
    reason
}

fn contradiction(
    bound: &BoundVerify<'_>,
    outcome: &MeasuredRuns,
    option: &Text,
    condition: &Text,
    holds: bool,
) -> Option<String> {
    let required = required_range(&parse_expression(&condition.value).tree)?;
    let closed = required.low.is_finite() && required.high.is_finite();
    let stated = match option_text(&option.value, bound.stage().languages()) {
        Some(claimed) => claimed,
        None if closed && required.ratio => return contradicted_ratio(option, &required),
        None => return None,
    };
    // A condition with one side may bound another quantity than the option mentions: a height instead of a fall distance.
    if !closed && !stated.alone {
        return None;
    }
    // With a one-sided condition, an option with a somewhat different number may still be the nearest one.
    let slip = if closed { 1.0 } else { NEAREST };
    let widen = |x: f64, f: f64| if x > 0.0 { x * f } else { x / f };
    let stated =
        OptionNumber { low: widen(stated.low, 1.0 / slip), high: widen(stated.high, slip), ..stated };
    let text = Text {
        map: SourceMap::whole(required.quantity.len(), condition.span()),
        value: required.quantity.clone(),
    };
    let found = units::of_claim(bound, outcome, &text)?;
    let expected = stated.unit.dimension?;
    if !found.agrees(&expected) {
        return None;
    }
    let factor = match conversion(&expected, &found) {
        Some(factor) => factor,
        None if hold(&stated.unit, Some(&found)) == UnitMatch::Fits
            && (expected.factor / found.factor - 1.0).abs() < 1e-3 =>
        {
            1.0
        }
        None => return None,
    };
    let (low, high) = (required.low * factor, required.high * factor);
    let slack = 1e-9 * stated.low.abs().max(stated.high.abs()).min(f64::MAX);
    let slack = if slack.is_finite() { slack } else { 0.0 };
    if stated.high < low - slack || stated.low > high + slack {
        return Some(format!("the option says {}, but its condition {}", stated.text, range(low, high)));
    }
    // A number with which the condition itself compares is the number that the option means.
    let named = |x: f64| x.is_finite() && stated.low <= x && x <= stated.high;
    if !holds || named(low) || named(high) || !(stated.low.is_finite() && stated.high.is_finite()) {
        return None;
    }
    let x = bound.find(outcome, &text, &mut Vec::new())?.value.to_number() * factor;
    let off = x.is_finite() && (x < stated.low - slack || x > stated.high + slack);
    off.then(|| format!("the option says {}, but its condition compares {}", stated.text, significant(x)))
}

/// The contradiction between an option that states a ratio and a condition that requires another one.
fn contradicted_ratio(option: &Text, required: &RequiredRange) -> Option<String> {
    let stated = option_ratio(&option.value)?;
    let slack = 0.05 * required.low.abs().max(required.high.abs());
    let fits = |x: &f64| required.low - slack <= *x && *x <= required.high + slack;
    let none = !stated.may_be.iter().any(fits);
    none.then(|| {
        format!("the option says {}, but its condition {}", stated.text, range(required.low, required.high))
    })
}

/// `asks for 1.13 to 1.33`
fn range(low: f64, high: f64) -> String {
    format!("asks for {} to {}", significant(low), significant(high))
}

/// The range that a condition requires of one quantity; `None` where it is about several, or has another form.
fn required_range(e: &Expr) -> Option<RequiredRange> {
    match &e.kind {
        ExprKind::Logical { op: LogicalOp::And, left, right } => {
            let (a, b) = (required_range(left)?, required_range(right)?);
            let same = a.quantity == b.quantity;
            same.then(|| RequiredRange { low: a.low.max(b.low), high: a.high.min(b.high), ..a })
        }
        ExprKind::Binary { op, left, right } => {
            let (quantity, number, flipped) = match (constant(left), constant(right)) {
                (None, Some(number)) => (left, number, false),
                (Some(number), None) => (right, number, true),
                _ => return None,
            };
            let below = match op {
                BinaryOp::Less | BinaryOp::LessEqual => !flipped,
                BinaryOp::Greater | BinaryOp::GreaterEqual => flipped,
                _ => return None,
            };
            if let Some(inner) = magnitude(quantity) {
                return if below { around(inner, number) } else { None };
            }
            let ratio = is_ratio(quantity);
            let quantity = single(quantity).then(|| print(quantity))?;
            let (low, high) = if below { (f64::NEG_INFINITY, number) } else { (number, f64::INFINITY) };
            Some(RequiredRange { quantity, ratio, low, high })
        }
        _ => None,
    }
}

/// The argument of `abs(…)`.
fn magnitude(e: &Expr) -> Option<&Expr> {
    let ExprKind::Call { callee, args, .. } = &e.kind else { return None };
    let named = match &callee.kind {
        ExprKind::Name(name) => name == "abs",
        ExprKind::Member { object, name, .. } => {
            name.text == "abs" && matches!(&object.kind, ExprKind::Name(object) if object == "Math")
        }
        _ => false,
    };
    args.first().filter(|_| named && args.len() == 1)
}

/// The range of `abs(x - c) < d` or `abs(x / c - 1) < d`.
fn around(inner: &Expr, off: f64) -> Option<RequiredRange> {
    let ExprKind::Binary { op: BinaryOp::Subtract, left, right } = &inner.kind else { return None };
    let (quantity, centre) = match (constant(left), constant(right)) {
        (None, Some(centre)) => (left, centre),
        (Some(centre), None) => (right, centre),
        _ => return None,
    };
    if let ExprKind::Binary { op: BinaryOp::Divide, left, right } = &quantity.kind
        && let Some(unit) = constant(right).filter(|c| *c > 0.0)
    {
        return single(left).then(|| RequiredRange {
            quantity: print(left),
            ratio: is_ratio(left),
            low: unit * (centre - off),
            high: unit * (centre + off),
        });
    }
    let ratio = is_ratio(quantity);
    single(quantity).then(|| RequiredRange {
        quantity: print(quantity),
        ratio,
        low: centre - off,
        high: centre + off,
    })
}

/// The value of an expression that contains only numbers.
fn constant(e: &Expr) -> Option<f64> {
    match &e.kind {
        ExprKind::Number(x) => Some(*x),
        ExprKind::Unary { op: UnaryOp::Minus, operand } => constant(operand).map(|x| -x),
        ExprKind::Binary { op, left, right } => {
            let (a, b) = (constant(left)?, constant(right)?);
            match op {
                BinaryOp::Add => Some(a + b),
                BinaryOp::Subtract => Some(a - b),
                BinaryOp::Multiply => Some(a * b),
                BinaryOp::Divide => Some(a / b),
                _ => None,
            }
        }
        _ => None,
    }
}

/// Whether an expression is one measured quantity, possibly times a number.
fn single(e: &Expr) -> bool {
    match &e.kind {
        ExprKind::Name(_) => true,
        ExprKind::Member { object, .. } => single(object),
        ExprKind::Index { object, index, .. } => single(object) && constant(index).is_some(),
        ExprKind::Binary { op: BinaryOp::Multiply, left, right } => {
            constant(left).is_some() && single(right) || single(left) && constant(right).is_some()
        }
        ExprKind::Binary { op: BinaryOp::Divide, left, right } => {
            single(left) && (constant(right).is_some() || single(right))
        }
        _ => false,
    }
}

/// Whether an expression is the ratio of two measured quantities.
fn is_ratio(e: &Expr) -> bool {
    matches!(&e.kind, ExprKind::Binary { op: BinaryOp::Divide, left, right } if single(left) && single(right))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_requirement_of_a_condition_is_an_interval() {
        let required =
            |text: &str| required_range(&parse_expression(text).tree).map(|a| (a.quantity, a.low, a.high));
        for (text, quantity, low, high) in [
            ("abs(m - 1.25) < 0.25", "m", 1.0, 1.5),
            ("Math.abs(1.25 - fall.m) <= 0.25", "fall.m", 1.0, 1.5),
            ("m > 1 && m < 2", "m", 1.0, 2.0),
            ("1 < 1000 * m", "1000 * m", 1.0, f64::INFINITY),
            ("abs(m / 2 - 1) < 0.5", "m", 1.0, 3.0),
        ] {
            assert_eq!(required(text), Some((quantity.to_string(), low, high)), "{text}");
        }
        for text in
            ["a < b", "abs(a - b) < 1", "a > 1 && b < 2", "a - b > 1", "a > 1 || a < 0", "true", "abs(m) > 1"]
        {
            assert_eq!(required(text), None, "{text}");
        }
    }
}
