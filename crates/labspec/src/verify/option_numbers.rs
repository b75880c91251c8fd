//! Compares the number in the text of an option with its condition: "about 7 m" cannot be right if the condition requires
//! 1.23 m.

use super::bound::BoundVerify;
use super::format::significant;
use super::outcome::MeasuredRuns;
use super::quote::{OptionNumber, UnitMatch, conversion, hold, option_ratio, option_text};
use super::units;
use crate::finding::Finding;
use crate::rules;
use crate::source::Text;
use labspec_expr::ast::{BinaryOp, Expr, ExprKind, LogicalOp, UnaryOp};
use labspec_expr::{parse_expression, print};

/// Factor by which the number of an option may differ where its condition has one side only.
const NEAREST: f64 = 1.5;

/// The range that a condition requires of the one quantity that it compares with numbers.
#[derive(Clone, Debug, PartialEq)]
struct RequiredRange {
    quantity: String,
    /// The two measured quantities of which it is the ratio.
    ratio: Option<[String; 2]>,
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
        None if closed => return contradicted_ratio(bound, outcome, option, condition, &required),
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
    let text = Text::derived(required.quantity.clone(), condition.span());
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
fn contradicted_ratio(
    bound: &BoundVerify<'_>,
    outcome: &MeasuredRuns,
    option: &Text,
    condition: &Text,
    required: &RequiredRange,
) -> Option<String> {
    let [quantity, base] = required.ratio.as_ref()?;
    let stated = option_ratio(&option.value).filter(|stated| stated.side.is_none())?;
    let text = Text::derived(quantity.clone(), condition.span());
    let measured = units::of_claim(bound, outcome, &text);
    let mut may_be = stated.may_be.clone();
    if stated.names_another(measured.as_ref()) {
        may_be.extend(stated.of_another());
    }
    // An option compares a later run with an earlier one, unless the condition has the order of the words.
    if !is_later(outcome, quantity, base) {
        may_be.extend(stated.may_be.iter().map(|x| 1.0 / x).filter(|x| x.is_finite()));
    }
    let slack = 0.05 * required.low.abs().max(required.high.abs());
    let fits = |x: &f64| required.low - slack <= *x && *x <= required.high + slack;
    let none = !may_be.iter().any(fits);
    none.then(|| {
        format!("the option says {}, but its condition {}", stated.text, range(required.low, required.high))
    })
}

/// Whether a measure belongs to a run that is declared after that of another measure.
fn is_later(outcome: &MeasuredRuns, quantity: &str, base: &str) -> bool {
    let run = |text: &str| {
        outcome.runs.iter().position(|run| {
            let rest =
                text.strip_prefix(run.title().as_str()).or_else(|| text.strip_prefix(run.name.as_str()));
            rest.is_some_and(|rest| rest.starts_with(['.', '[']))
        })
    };
    run(quantity).zip(run(base)).is_some_and(|(a, b)| a > b)
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
                (None, None) => return times_another(*op, left, right),
                _ => return None,
            };
            let below = is_below(*op, flipped)?;
            if let Some(inner) = magnitude(quantity) {
                return if below { around(inner, number) } else { None };
            }
            let (low, high) = if below { (f64::NEG_INFINITY, number) } else { (number, f64::INFINITY) };
            single(quantity).then(|| RequiredRange {
                quantity: print(quantity),
                ratio: ratio_of(quantity),
                low,
                high,
            })
        }
        _ => None,
    }
}

/// Whether a comparison requires its left side, or its right one if `flipped`, to be smaller; `None` for an equality.
pub(super) fn is_below(op: BinaryOp, flipped: bool) -> Option<bool> {
    match op {
        BinaryOp::Less | BinaryOp::LessEqual => Some(!flipped),
        BinaryOp::Greater | BinaryOp::GreaterEqual => Some(flipped),
        _ => None,
    }
}

/// The range of the ratio of two measured quantities in a comparison with a multiple: `b.t > 1.9 * a.t`.
fn times_another(op: BinaryOp, left: &Expr, right: &Expr) -> Option<RequiredRange> {
    let (quantity, (number, base), flipped) = match (multiple(left), multiple(right)) {
        (None, Some(multiple)) => (left, multiple, false),
        (Some(multiple), None) => (right, multiple, true),
        _ => return None,
    };
    if !is_name(quantity) || !is_name(base) || number <= 0.0 {
        return None;
    }
    let (low, high) =
        if is_below(op, flipped)? { (f64::NEG_INFINITY, number) } else { (number, f64::INFINITY) };
    let [quantity, base] = [print(quantity), print(base)];
    Some(RequiredRange { quantity: format!("{quantity} / {base}"), ratio: Some([quantity, base]), low, high })
}

/// The number and the other factor of a product.
fn multiple(e: &Expr) -> Option<(f64, &Expr)> {
    let ExprKind::Binary { op: BinaryOp::Multiply, left, right } = &e.kind else { return None };
    match (constant(left), constant(right)) {
        (Some(number), None) => Some((number, right)),
        (None, Some(number)) => Some((number, left)),
        _ => None,
    }
}

/// The argument of `abs(…)`.
pub(super) fn magnitude(e: &Expr) -> Option<&Expr> {
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
    // A quotient beside 1 is a relative difference; beside another number it is a part, such as half a period.
    if let ExprKind::Binary { op: BinaryOp::Divide, left, right } = &quantity.kind
        && let Some(unit) = constant(right).filter(|c| *c > 0.0 && centre == 1.0)
    {
        return single(left).then(|| RequiredRange {
            quantity: print(left),
            ratio: ratio_of(left),
            low: unit * (centre - off),
            high: unit * (centre + off),
        });
    }
    single(quantity).then(|| RequiredRange {
        quantity: print(quantity),
        ratio: ratio_of(quantity),
        low: centre - off,
        high: centre + off,
    })
}

/// The value of an expression that contains only numbers.
pub(super) fn constant(e: &Expr) -> Option<f64> {
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

/// Whether an expression is the name of one measured quantity.
fn is_name(e: &Expr) -> bool {
    match &e.kind {
        ExprKind::Name(_) => true,
        ExprKind::Member { object, .. } => is_name(object),
        ExprKind::Index { object, index, .. } => is_name(object) && constant(index).is_some(),
        _ => false,
    }
}

/// The two measured quantities of which an expression is the ratio.
fn ratio_of(e: &Expr) -> Option<[String; 2]> {
    let ExprKind::Binary { op: BinaryOp::Divide, left, right } = &e.kind else { return None };
    (single(left) && single(right)).then(|| [print(left), print(right)])
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
            ("abs(m / 2 - 0.75) < 0.25", "m / 2", 0.5, 1.0),
            ("b.t > 1.9 * a.t && a.t * 2.1 > b.t", "b.t / a.t", 1.9, 2.1),
            ("b.t / a.t > 1.9 && b.t <= 2.1 * a.t", "b.t / a.t", 1.9, 2.1),
        ] {
            assert_eq!(required(text), Some((quantity.to_string(), low, high)), "{text}");
        }
        for text in [
            "a < b",
            "abs(a - b) < 1",
            "a > 1 && b < 2",
            "a - b > 1",
            "a > 1 || a < 0",
            "2 * a < 3 * b",
            "a > -2 * b",
            "true",
            "abs(m) > 1",
        ] {
            assert_eq!(required(text), None, "{text}");
        }
    }

    /// The messages about a question whose first option has a text and a condition: the fall from four times the height
    /// takes twice as long.
    fn messages(option: &str, condition: &str) -> Vec<String> {
        let control = serde_json::json!({"label": "height", "param": "h", "min": 1, "max": 4, "step": 1, "value": 1, "reset": true});
        let lab = serde_json::json!({"stopAt": 2, "setup": "data.qpos[2] = ctx.h", "controls": [control],
            "xml": "<mujoco><worldbody><body pos='0 0 1'><freejoint/><geom size='.05'/></body></worldbody></mujoco>"});
        let verify = serde_json::json!({"lab": lab, "runs": {"a": {"set": {"height": 1}}, "b": {"set": {"height": 4}}},
            "measure": {"t": "crossing(data.qpos[2])"}, "options": [condition, "b.t < 1.5 * a.t"]});
        let question = serde_json::json!({"q": "How long?", "options": [option, "shorter"], "answer": 0, "verify": verify});
        let quiz = serde_json::json!({"id": "q", "questions": [question]}).to_string();
        let report = crate::Checker::new(|_: &str| None::<String>).check("q.json", &quiz);
        report.findings.iter().map(|finding| finding.message.clone()).collect()
    }

    #[test]
    fn the_ratio_of_an_option_is_that_of_its_condition() {
        let conditions = ["abs(b.t / a.t - 2) < 0.1", "b.t > 1.9 * a.t && b.t < 2.1 * a.t"];
        for condition in conditions {
            for option in
                ["twice as long", "two times longer", "it doubles", "100 % longer", "four times the height"]
            {
                assert_eq!(messages(option, condition), [""; 0], "{option}: {condition}");
            }
            for option in [
                "half as long",
                "three times as long",
                "five times as long",
                "four times as long",
                "a third longer",
            ] {
                let all = messages(option, condition);
                assert!(
                    all.iter().any(|m| m.contains("its condition asks for 1.9 to 2.1")),
                    "{option}: {all:?}"
                );
            }
        }
        // The condition divides the earlier run by the later one: the words may compare in either order.
        for option in ["twice as long", "half as long"] {
            assert_eq!(messages(option, "abs(a.t / b.t - 0.5) < 0.02"), [""; 0], "{option}");
        }
    }
}
