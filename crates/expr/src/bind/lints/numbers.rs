//! Lints about strings in places where numbers are expected.

use super::pass::LintPass;
use crate::ast::{BinaryOp, Expr, ExprKind, UnaryOp};
use crate::bind::types::ExpressionShape;
use crate::rules;
use crate::types::Type;
use crate::value::Value;
use labspec_finding::{Finding, Span};

impl LintPass<'_> {
    /// Checks the operand of `-` and `~`.
    #[inline(never)]
    pub(super) fn text_operand(&mut self, op: UnaryOp, expr: &Expr) {
        let ExprKind::Unary { operand, .. } = &expr.kind else { return };
        if matches!(op, UnaryOp::Minus | UnaryOp::BitNot) {
            self.needs_number(operand, op.symbol());
        }
    }

    /// Checks the operands of arithmetic operators such as `*`.
    #[inline(never)]
    pub(super) fn text_operands(&mut self, op: BinaryOp, left: &Expr, right: &Expr) {
        if !op.is_comparison() && op != BinaryOp::Add {
            self.needs_number(left, op.symbol());
            self.needs_number(right, op.symbol());
        }
    }

    fn needs_number(&mut self, operand: &Expr, symbol: &str) {
        let Some(shape) = self.typed.shape(operand.span).filter(|shape| shape.ty == Type::String) else {
            return;
        };
        let message = format!("`{symbol}` needs a number, but this is a string");
        self.found.push(instead(
            Finding::warning(rules::STRING_AS_NUMBER, operand.span, message),
            shape,
            [
                "JavaScript converts it to NaN",
                "JavaScript reads the number in it",
                "JavaScript reads the number in it, or gives NaN when there is none",
            ],
        ));
    }

    /// Warns about a string that is stored where numbers are expected.
    pub(super) fn text_stored(&mut self, span: Span, shape: &ExpressionShape) {
        if shape.ty != Type::String {
            return;
        }
        let message = "a string is stored where a number is needed";
        self.found.push(instead(
            Finding::warning(rules::STRING_AS_NUMBER, span, message),
            shape,
            [
                "JavaScript stores NaN, and every computation with it gives NaN",
                "JavaScript stores the number in it",
                "JavaScript stores the number in it, or NaN when there is none",
            ],
        ));
    }

    /// Warns about a string that is passed to a function of numbers.
    pub(super) fn text_for_number(&mut self, span: Span, by: &str, shape: &ExpressionShape) {
        if shape.ty == Type::String {
            let message = format!("`{by}` needs a number, but this is a string");
            self.found.push(
                Finding::warning(rules::STRING_AS_NUMBER, span, message)
                    .why("JavaScript reads the number in it, or gives NaN when there is none")
                    .help("write the number"),
            );
        }
    }
}

/// Adds to the finding what to write instead of a string; the reasons apply to a string without a number, one with a
/// number, and an unknown string.
fn instead(report: Finding, shape: &ExpressionShape, [none, number, unknown]: [&str; 3]) -> Finding {
    let span = Span::from(report.span.clone());
    match shape.constant.as_ref().map(Value::to_number) {
        Some(x) if x.is_nan() => report.why(none).help("write the number"),
        Some(x) => {
            let meant = crate::number::to_text(x);
            report.why(number).help(format!("write `{meant}`")).fix(span, meant)
        }
        None => report.why(unknown).help("write `+text` to convert it deliberately"),
    }
}
