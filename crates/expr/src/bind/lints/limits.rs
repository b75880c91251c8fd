//! Lints about limits that are exchanged, and loops that count away from their end.

use super::pass::LintPass;
use crate::ast::{BinaryOp, Expr, ExprKind, Stmt, StmtKind};
use crate::rules;
use labspec_finding::{Finding, Span};

/// Names of functions that limit a number: `clamp(x, low, high)`.
const CLAMPS: [&str; 3] = ["clamp", "clip", "limit"];

impl LintPass<'_> {
    /// The other argument and the constant of `Math.min(x, 2)`, if this is the function.
    fn bound<'e>(&self, function: &str, expr: &'e Expr) -> Option<(&'e Expr, &'e Expr, f64)> {
        let ExprKind::Call { callee, args, .. } = &expr.kind else { return None };
        if self.bare(callee.span)? != function {
            return None;
        }
        let [a, b] = args.as_slice() else { return None };
        match (self.literal(a), self.literal(b)) {
            (None, Some(x)) => Some((a, b, x)),
            (Some(x), None) => Some((b, a, x)),
            _ => None,
        }
    }

    /// Warns about `Math.min(Math.max(x, 2), -2)` and `clamp(x, 2, -2)`.
    #[inline(never)]
    pub(super) fn clamped(&mut self, expr: &Expr) {
        for (outer, inner) in [("Math.min", "Math.max"), ("Math.max", "Math.min")] {
            let Some((within, outer_limit, last)) = self.bound(outer, expr) else { continue };
            let Some((_, inner_limit, first)) = self.bound(inner, within) else { continue };
            let exchanged = if outer == "Math.min" { first > last } else { first < last };
            if exchanged {
                self.exchanged(expr.span, [inner_limit.span, outer_limit.span], last);
            }
        }
        let ExprKind::Call { callee, args, .. } = &expr.kind else { return };
        let name = match &callee.kind {
            ExprKind::Name(name) => name.as_str(),
            ExprKind::Member { name, .. } => name.text.as_str(),
            _ => return,
        };
        let [_, low, high] = args.as_slice() else { return };
        if let (Some(a), Some(b)) = (self.literal(low), self.literal(high))
            && CLAMPS.contains(&name)
            && a > b
        {
            self.exchanged(expr.span, [low.span, high.span], b);
        }
    }

    /// Reports two exchanged limits.
    fn exchanged(&mut self, span: Span, limits: [Span; 2], result: f64) {
        let [first, second] = if limits[0].start < limits[1].start { limits } else { [limits[1], limits[0]] };
        let pieces = [
            self.text(Span::new(span.start, first.start)),
            self.text(second),
            self.text(Span::new(first.end, second.start)),
            self.text(first),
            self.text(Span::new(second.end, span.end)),
        ];
        let meant = pieces.concat();
        let value = crate::number::to_text(result);
        self.found.push(
            Finding::warning(
                rules::CONSTANT_CLAMP,
                span,
                format!("this is always {value}: the two limits are swapped"),
            )
            .why("the lower limit is above the upper one")
            .help(format!("write `{meant}`"))
            .guess(span, meant),
        );
    }

    /// Warns about a loop that never runs: `for (let i = 0; i > n; i++)`.
    #[inline(never)]
    pub(super) fn counted_away(&mut self, init: Option<&Stmt>, test: Option<&Expr>, update: Option<&Expr>) {
        let (Some(init), Some(test), Some(update)) = (init, test, update) else { return };
        let ExprKind::Binary { op, left, right } = &test.kind else { return };
        let ExprKind::Name(name) = &left.kind else { return };
        let Some(up) = self.counts_up(name, update) else { return };
        let start = self.start_of(name, init);
        let away = match op {
            BinaryOp::Greater | BinaryOp::GreaterEqual => up,
            BinaryOp::Less | BinaryOp::LessEqual => !up,
            _ => return,
        };
        let ends = start.zip(self.literal(right));
        let never = ends.is_some_and(|(a, b)| match op {
            BinaryOp::Greater => a <= b,
            BinaryOp::GreaterEqual => a < b,
            BinaryOp::Less => a >= b,
            _ => a > b,
        });
        // An empty loop that counts towards its end may be a constant that the author sets to 0.
        if !(away || never && ends.is_some_and(|(a, b)| a != b)) {
            return;
        }
        let (symbol, word) = if up { ("<", "up") } else { (">", "down") };
        let symbol = if op.symbol().ends_with('=') { format!("{symbol}=") } else { symbol.to_owned() };
        let meant = format!("{name} {symbol} {}", self.text(right.span));
        let report = Finding::warning(
            rules::CONSTANT_CONDITION,
            test.span,
            "this loop does not count towards its end",
        )
        .why(format!("`{name}` counts {word}: the loop never runs, or does not end"));
        self.found.push(match away {
            true => report.help(format!("write `{meant}`")).guess(test.span, meant),
            false => {
                report.help("exchange the start and the end of the loop, or count in the other direction")
            }
        });
    }

    /// Whether the update counts this variable up or down.
    fn counts_up(&self, name: &str, update: &Expr) -> Option<bool> {
        let is_it = |e: &Expr| matches!(&e.kind, ExprKind::Name(n) if n == name);
        match &update.kind {
            ExprKind::Update { target, increment, .. } if is_it(target) => Some(*increment),
            ExprKind::Assign { target, op: Some(op), value, .. } if is_it(target) => {
                let step = self.literal(value).filter(|x| *x != 0.0)?;
                match op {
                    BinaryOp::Add => Some(step > 0.0),
                    BinaryOp::Subtract => Some(step < 0.0),
                    _ => None,
                }
            }
            _ => None,
        }
    }

    /// The constant at which a loop starts.
    fn start_of(&self, name: &str, init: &Stmt) -> Option<f64> {
        let StmtKind::Declare { declarators, .. } = &init.kind else { return None };
        let is_it =
            |d: &&crate::ast::Declarator| matches!(&d.target, crate::ast::Pattern::Name(n) if n.text == name);
        self.literal(declarators.iter().find(is_it)?.value.as_ref()?)
    }
}
