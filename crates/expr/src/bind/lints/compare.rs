//! Lints about comparisons that do not mean what they appear to mean, and about `^`.

use super::pass::LintPass;
use crate::ast::{BinaryOp, Expr, ExprKind};
use crate::rules;
use labspec_finding::{Finding, Span};

impl LintPass<'_> {
    /// Warns about a comparison with the literal NaN.
    #[inline(never)]
    pub(super) fn compared_with_nan(&mut self, op: BinaryOp, left: &Expr, right: &Expr, span: Span) {
        let is_nan = |e: &Expr| matches!(&e.kind, ExprKind::Name(n) if n == "NaN");
        if !op.is_comparison() || !(is_nan(left) || is_nan(right)) {
            return;
        }
        let other = self.text(if is_nan(right) { left.span } else { right.span }).to_owned();
        let negated = matches!(op, BinaryOp::NotEqual | BinaryOp::StrictNotEqual);
        let result = if negated { "true" } else { "false" };
        let meant = format!("{}isNaN({other})", if negated { "!" } else { "" });
        let report =
            Finding::warning(rules::COMPARE_NAN, span, format!("this comparison is always {result}"))
                .why("NaN is not equal to anything, not even to itself, and neither smaller nor larger");
        self.found.push(match op.power() {
            8 => report.help(format!("write `{meant}`")).guess(span, meant),
            _ => report.help("compare with a number"),
        });
    }

    /// Warns about `a < b < c`.
    #[inline(never)]
    pub(super) fn chained(&mut self, op: BinaryOp, left: &Expr, span: Span) {
        let ExprKind::Binary { op: inner, right: middle, left: first } = &left.kind else { return };
        let orders = |op: BinaryOp| op.power() == 9;
        let text = self.text(left.span);
        // The parentheses of `(a < b) < c` show that it is intended.
        let enclosed =
            left.span.start < first.span.start && text.starts_with('(') && left.span.end > middle.span.end;
        if !(orders(op) && orders(*inner)) || enclosed {
            return;
        }
        let middle = self.text(middle.span);
        let last = self.text(Span::new(left.span.end, span.end)).trim_start();
        let meant = format!("{text} && {middle} {last}");
        self.found.push(
            Finding::warning(rules::CHAINED_COMPARISON, span, "comparisons do not chain")
                .why(format!("`{text}` is true or false, and the next comparison uses that as 1 or 0"))
                .help(format!("write `{meant}`"))
                .guess(span, meant),
        );
    }

    /// Warns about `^`.
    #[inline(never)]
    pub(super) fn power(&mut self, left: &Expr, right: &Expr, span: Span) {
        let meant = format!("{} ** {}", self.text(left.span), self.text(right.span));
        self.found.push(
            Finding::warning(rules::XOR_AS_POWER, span, "`^` is not a power")
                .why("in JavaScript it is the bitwise exclusive or: `3 ^ 2` is 1")
                .help(format!("write `{meant}`"))
                .guess(span, meant),
        );
    }
}
