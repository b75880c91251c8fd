//! The margin of a condition: how far its comparisons are from the opposite result.

use labspec_expr::ast::{Expr, ExprKind};
use labspec_expr::{Comparison, parse_expression};

/// The result of a condition.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct ConditionMargin {
    /// Whether it holds.
    pub(super) holds: bool,
    /// Distance of the nearest decisive comparison from the opposite result, in the unit of the compared values; negative
    /// where the condition does not hold, `None` where nothing is compared.
    pub(super) margin: Option<f64>,
    /// The source text of a comparison that was decided by a NaN.
    pub(super) without_number: Option<String>,
}

/// Whether an expression is only a constant: `true`, `5`, `-NaN`, `!1`. A constant is not evidence.
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

/// The number literals of a text, at most 20.
pub(super) fn numbers_in(text: &str) -> Vec<f64> {
    let mut found = Vec::new();
    let mut before = ' ';
    let mut end = 0;
    for (i, c) in text.char_indices() {
        let begins = c.is_ascii_digit() || c == '.';
        if begins && i >= end && !(before.is_alphanumeric() || "_.$".contains(before)) {
            let rest = text.get(i..).unwrap_or("");
            let length =
                rest.find(|c: char| !(c.is_ascii_digit() || ".eE+-".contains(c))).unwrap_or(rest.len());
            let number = (1..=length).rev().find_map(|n| Some((n, rest.get(..n)?.parse::<f64>().ok()?)));
            if let Some((n, x)) = number {
                found.push(x);
                end = i + n;
            }
        }
        before = c;
    }
    found.truncate(20);
    found
}

/// Maximum number of comparisons of a condition that are inverted to see whether they decide it.
const MAX_INVERTED: usize = 48;

/// The result of a condition and its margin. `decides` returns for each comparison whether it depends on measured values;
/// `turn` returns the truth of the condition if one comparison has the opposite result.
pub(super) fn evaluate(
    holds: bool,
    comparisons: &[Comparison],
    decides: &dyn Fn(usize) -> bool,
    turn: &mut dyn FnMut(usize) -> Option<bool>,
) -> ConditionMargin {
    let mut decisive: Option<f64> = None;
    let mut any: Option<f64> = None;
    let nearer = |best: &mut Option<f64>, size: f64| {
        *best = Some(best.map_or(size, |smallest: f64| smallest.min(size)))
    };
    for (i, comparison) in comparisons.iter().enumerate().take(MAX_INVERTED) {
        let size = comparison.margin.abs();
        if !size.is_finite() || !decides(i) {
            continue;
        }
        nearer(&mut any, size);
        if turn(i).is_some_and(|then| then != holds) {
            nearer(&mut decisive, size);
        }
    }
    let margin = decisive.or(any).map(|size| if holds { size } else { -size });
    ConditionMargin { holds, margin, without_number: None }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bare_constants() {
        for text in ["true", "false", "5", "-5", "(true)", "!1", "NaN", "'yes'", "null"] {
            assert!(is_bare_constant(text), "{text}");
        }
        for text in ["0.5 * 9.81 * 0.004", "a", "1 < 2", "Math.PI", ""] {
            assert!(!is_bare_constant(text), "{text}");
        }
    }

    #[test]
    fn numbers_of_a_text() {
        assert_eq!(numbers_in("abs(m2 - 1.23) < .5e-1"), [1.23, 0.05]);
    }
}
