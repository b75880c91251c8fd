//! Lints about the comparison of a number that changes in small steps with one value.

use super::pass::LintPass;
use crate::ast::{BinaryOp, Expr, ExprKind, UnaryOp};
use crate::rules;
use labspec_finding::{Finding, Span};

/// The limit on the depth of an expression.
const MAX_DEPTH: usize = 8;

impl LintPass<'_> {
    /// Whether a number changes in small steps during a run: the time, the state, and sums and products of them.
    fn is_continuous(&self, expr: &Expr, depth: usize) -> bool {
        if depth == 0 {
            return false;
        }
        let expr = self.definition(expr);
        if let Some((field, index)) = self.typed.shape(expr.span).and_then(|shape| shape.element) {
            return self.schema.is_continuous(field, index);
        }
        match &expr.kind {
            ExprKind::Unary { op: UnaryOp::Minus | UnaryOp::Plus, operand } => {
                self.is_continuous(operand, depth - 1)
            }
            ExprKind::Binary { op, left, right } => {
                let arithmetic = [
                    BinaryOp::Add,
                    BinaryOp::Subtract,
                    BinaryOp::Multiply,
                    BinaryOp::Divide,
                    BinaryOp::Remainder,
                ];
                let by = |e: &Expr| self.literal(e).is_some();
                arithmetic.contains(op)
                    && (self.is_continuous(left, depth - 1)
                        && (by(right) || self.is_continuous(right, depth - 1))
                        || by(left) && self.is_continuous(right, depth - 1))
            }
            ExprKind::Call { callee, args, .. } => {
                let names = ["Math.abs", "lib.deg", "lib.rad", "Math.sin", "Math.cos", "Math.sqrt"];
                let is_known = self.bare(callee.span).is_some_and(|name| names.contains(&name.as_str()));
                is_known && args.first().is_some_and(|one| self.is_continuous(one, depth - 1))
            }
            _ => false,
        }
    }

    /// Whether an expression is the rest of a division.
    fn is_remainder(&self, expr: &Expr) -> bool {
        matches!(&self.definition(expr).kind, ExprKind::Binary { op: BinaryOp::Remainder, .. })
    }

    /// Warns about `data.time === 1`.
    #[inline(never)]
    pub(super) fn exact(&mut self, op: BinaryOp, left: &Expr, right: &Expr, span: Span) {
        // A comparison as a statement is reported as an assignment that was meant.
        if op.power() != 8 || self.typed.is_idle(span) {
            return;
        }
        let (number, value) = match (self.literal(left), self.literal(right)) {
            (None, Some(x)) => (left, x),
            (Some(x), None) => (right, x),
            _ => return,
        };
        // A state that starts at 0, or that a program sets to 0, equals it until it changes.
        if value.is_nan()
            || value == 0.0 && !self.is_remainder(number)
            || !self.is_continuous(number, MAX_DEPTH)
        {
            return;
        }
        let text = self.text(number.span).to_owned();
        let result = if matches!(op, BinaryOp::Equal | BinaryOp::StrictEqual) { "never" } else { "always" };
        let x = crate::number::to_text(value);
        let report = Finding::warning(
            rules::EXACT_COMPARISON,
            span,
            format!("this is almost {result} true: `{text}` changes in small steps"),
        );
        let report = report.why("each step is a rounded fraction, so the sum misses this number slightly");
        let flag = "a flag that is set once, as `if (!ctx.done && ";
        self.found.push(match self.is_remainder(number) {
            true => report.help("store the next time, as `if (data.time >= ctx.next) { ctx.next += 1; … }`, with `ctx.next = 1` at the start"),
            false => report.help(format!(
                "write `{text} >= {x}` with {flag}{text} >= {x}) {{ ctx.done = true; … }}`, or a tolerance, as `Math.abs({text} - {x}) < 0.001`"
            )),
        });
    }
}
