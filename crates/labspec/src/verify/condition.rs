//! A condition, taken apart: whether it holds, what it looked at, and how far it is from saying the opposite.

use labspec_expr::ast::{BinaryOp, Expr, ExprKind, LogicalOp, UnaryOp};
use labspec_expr::{Value, parse_expression, print};

/// What became of a condition.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Weighed {
    /// It holds.
    pub(super) holds: bool,
    /// How far the nearest comparison that decides it is from turning over, in the unit of what is compared: negative where it
    /// does not hold; `None` where nothing is compared.
    pub(super) margin: Option<f64>,
    /// A comparison that was decided by a side that is no number, as it is written.
    pub(super) without_number: Option<String>,
}

/// Whether an expression is nothing but a constant: `true`, `5`, `-NaN`, `!1`. It is evidence of nothing.
pub(super) fn is_bare_constant(text: &str) -> bool {
    fn bare(e: &Expr) -> bool {
        match &e.kind {
            ExprKind::Number(_) | ExprKind::String(_) | ExprKind::Boolean(_) | ExprKind::Null => true,
            ExprKind::Name(name) => matches!(name.as_str(), "NaN" | "Infinity" | "undefined"),
            ExprKind::Unary { operand, .. } => bare(operand),
            ExprKind::Template { values, .. } => values.is_empty(),
            _ => false,
        }
    }
    bare(&parse_expression(text).tree)
}

/// Takes a condition apart. `value` evaluates a part of it; `None` where that cannot be done.
pub(super) fn weigh(text: &str, holds: bool, value: &dyn Fn(&str) -> Option<Value>) -> Weighed {
    let tree = parse_expression(text).tree;
    let asks = asks_for_nan(&tree);
    let mut without_number = None;
    let margin = margin(&tree, value, &mut without_number).map(|(_, m)| m).filter(|m| m.is_finite());
    Weighed { holds, margin, without_number: without_number.filter(|_| !asks) }
}

/// Truth and margin of an expression. Parts that JavaScript would not evaluate are not looked at.
fn margin(e: &Expr, value: &dyn Fn(&str) -> Option<Value>, nan: &mut Option<String>) -> Option<(bool, f64)> {
    match &e.kind {
        ExprKind::Binary { op, left, right } => {
            let (a, b) = (value(&print(left))?, value(&print(right))?);
            let (Value::Number(_) | Value::Boolean(_), Value::Number(_) | Value::Boolean(_)) = (&a, &b)
            else {
                return None;
            };
            let (a, b) = (a.to_number(), b.to_number());
            let apart = (a - b).abs();
            let (holds, margin) = match op {
                BinaryOp::Less => (a < b, b - a),
                BinaryOp::LessEqual => (a <= b, b - a),
                BinaryOp::Greater => (a > b, a - b),
                BinaryOp::GreaterEqual => (a >= b, a - b),
                BinaryOp::Equal | BinaryOp::StrictEqual => (a == b, -apart),
                BinaryOp::NotEqual | BinaryOp::StrictNotEqual => (a != b, apart),
                _ => return leaf(e, value, nan),
            };
            if (a.is_nan() || b.is_nan()) && nan.is_none() {
                *nan = Some(print(e));
            }
            Some((holds, margin))
        }
        ExprKind::Logical { op, left, right } => {
            let l = margin(left, value, nan)?;
            match (op, l.0) {
                (LogicalOp::And, false) | (LogicalOp::Or, true) => {
                    // The other side could still turn it over together with this one; this one is what decides.
                    Some(l)
                }
                (LogicalOp::And, true) => {
                    let r = margin(right, value, nan)?;
                    Some(if r.0 { (true, l.1.min(r.1)) } else { r })
                }
                (LogicalOp::Or, false) => {
                    let r = margin(right, value, nan)?;
                    Some(if r.0 { r } else { (false, l.1.max(r.1)) })
                }
                _ => None,
            }
        }
        ExprKind::Unary { op: UnaryOp::Not, operand } => {
            margin(operand, value, nan).map(|(holds, m)| (!holds, -m))
        }
        ExprKind::Conditional { test, then, otherwise } => {
            let (holds, _) = margin(test, value, nan)?;
            margin(if holds { then } else { otherwise }, value, nan)
        }
        _ => leaf(e, value, nan),
    }
}

/// A part in which nothing is compared: it holds or not, and no change of a number is known to turn it over.
fn leaf(e: &Expr, value: &dyn Fn(&str) -> Option<Value>, nan: &mut Option<String>) -> Option<(bool, f64)> {
    let found = value(&print(e))?;
    if matches!(found, Value::Number(x) if x.is_nan()) && nan.is_none() {
        *nan = Some(print(e));
    }
    Some((found.truthy(), if found.truthy() { f64::INFINITY } else { f64::NEG_INFINITY }))
}

/// Whether an expression asks for NaN itself.
fn asks_for_nan(e: &Expr) -> bool {
    match &e.kind {
        ExprKind::Call { callee, args, .. } => {
            let named = match &callee.kind {
                ExprKind::Name(name) => name == "isNaN" || name == "isFinite",
                ExprKind::Member { name, .. } => matches!(name.text.as_str(), "isNaN" | "isFinite"),
                _ => false,
            };
            named || asks_for_nan(callee) || args.iter().any(asks_for_nan)
        }
        ExprKind::Binary { left, right, .. } | ExprKind::Logical { left, right, .. } => {
            asks_for_nan(left) || asks_for_nan(right)
        }
        ExprKind::Unary { operand, .. } => asks_for_nan(operand),
        ExprKind::Conditional { test, then, otherwise } => {
            asks_for_nan(test) || asks_for_nan(then) || asks_for_nan(otherwise)
        }
        _ => false,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Numbers are themselves, and `x` is what is given.
    fn weighed(text: &str, x: f64) -> (Option<f64>, Option<String>) {
        let value = |t: &str| match t {
            "x" => Some(Value::Number(x)),
            "-x" => Some(Value::Number(-x)),
            other => other.parse().ok().map(Value::Number),
        };
        let w = weigh(text, true, &value);
        (w.margin, w.without_number)
    }

    #[test]
    fn margins_are_the_distance_to_the_other_answer() {
        assert_eq!(weighed("x < 3", 1.0).0, Some(2.0));
        assert_eq!(weighed("x > 3", 1.0).0, Some(-2.0));
        assert_eq!(weighed("x > 0 && x < 3", 1.0).0, Some(1.0));
        assert_eq!(weighed("x > 0 && x < 3", 4.0).0, Some(-1.0));
        assert_eq!(weighed("x < 0 || x > 3", 1.0).0, Some(-1.0));
        assert_eq!(weighed("!(x < 3)", 1.0).0, Some(-2.0));
        assert_eq!(weighed("x === 3", 1.0).0, Some(-2.0));
        assert_eq!(weighed("x", 1.0).0, None);
    }

    #[test]
    fn a_comparison_with_what_is_no_number_is_named() {
        assert_eq!(weighed("x < 3", f64::NAN).1.as_deref(), Some("x < 3"));
        assert_eq!(weighed("1 > 0 && !(x < 3)", f64::NAN).1.as_deref(), Some("x < 3"));
        assert_eq!(weighed("1 < 0 && x < 3", f64::NAN).1, None, "it is never looked at");
        assert_eq!(weighed("!isNaN(x) && x < 3", f64::NAN).1, None, "it asks");
        assert_eq!(weighed("x < 3", 1.0).1, None);
    }

    #[test]
    fn bare_constants() {
        for text in ["true", "false", "5", "-5", "(true)", "!1", "NaN", "'yes'", "null"] {
            assert!(is_bare_constant(text), "{text}");
        }
        for text in ["0.5 * 9.81 * 0.004", "a", "1 < 2", "Math.PI", ""] {
            assert!(!is_bare_constant(text), "{text}");
        }
    }
}
