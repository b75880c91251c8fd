//! Lints about results that are not used, fallbacks that are never taken and statements that are never executed.

use super::pass::LintPass;
use crate::ast::{BinaryOp, Expr, ExprKind, LogicalOp, Stmt, StmtKind};
use crate::rules;
use crate::types::Type;
use crate::value::Value;
use labspec_finding::{Finding, Span};

impl LintPass<'_> {
    /// Warns about a statement without an effect.
    #[inline(never)]
    pub(super) fn unused(&mut self, expr: &Expr) {
        match &expr.kind {
            ExprKind::Sequence(parts) => return parts.iter().for_each(|part| self.unused(part)),
            ExprKind::Logical { right, .. } => return self.unused(right),
            ExprKind::Conditional { then, otherwise, .. } => {
                self.unused(then);
                return self.unused(otherwise);
            }
            // The operands may have effects, but the result of the operator is not used.
            ExprKind::Binary { .. } if !self.typed.is_idle(expr.span) => {
                self.found.push(
                    Finding::warning(
                        rules::UNUSED_RESULT,
                        expr.span,
                        "the value of this statement is discarded",
                    )
                    .why("nothing uses the computed value")
                    .help("assign it; `==` before a `?` may be meant as `=`"),
                );
                return;
            }
            _ if !self.typed.is_idle(expr.span) => return,
            _ => {}
        }
        let report = Finding::warning(rules::UNUSED_RESULT, expr.span, "this statement changes nothing")
            .why("its value is computed and discarded");
        let equality = |op: &BinaryOp| matches!(op, BinaryOp::Equal | BinaryOp::StrictEqual);
        self.found.push(match &expr.kind {
            ExprKind::Binary { op, left, right } if equality(op) => {
                let meant = format!("{} = {}", self.text(left.span), self.text(right.span));
                report.help(format!("to assign, write `{meant}`")).guess(expr.span, meant)
            }
            _ => report.help(format!("assign it, as `ctx.x = {}`, or remove it", self.text(expr.span))),
        });
    }

    /// Warns about a fallback that can never be taken.
    #[inline(never)]
    pub(super) fn fallback(&mut self, op: LogicalOp, left: &Expr, span: Span) {
        let Some(shape) = self.typed.shape(left.span).filter(|shape| shape.constant.is_none()) else {
            return;
        };
        if op != LogicalOp::Nullish || !matches!(shape.ty, Type::Number | Type::Boolean | Type::String) {
            return;
        }
        let text = self.text(left.span);
        self.found.push(
            Finding::warning(rules::UNUSED_RESULT, span, "the value after `??` is never used")
                .why(format!("`{text}` is {}, never `undefined` or `null`", shape.ty.describe()))
                .help(format!("write `{text}` alone")),
        );
    }

    /// Warns about the first statement after a `return` or a jump.
    pub(super) fn never_reached(&mut self, statements: &[Stmt]) {
        let runs = |s: &&Stmt| !matches!(s.kind, StmtKind::Function { .. } | StmtKind::Empty);
        let Some(index) = statements.iter().position(|statement| self.leaves(statement)) else { return };
        if let Some(dead) = statements.iter().skip(index + 1).find(runs) {
            self.found.push(
                Finding::warning(rules::UNREACHABLE, dead.span, "this is never reached")
                    .why("the statement before it always leaves")
                    .help("remove it, or put what comes before under a condition"),
            );
        }
    }

    /// Whether no statement after this one is executed.
    fn leaves(&self, statement: &Stmt) -> bool {
        match &statement.kind {
            StmtKind::Return(_) | StmtKind::Break | StmtKind::Continue => true,
            StmtKind::Block(statements) => statements.iter().any(|inner| self.leaves(inner)),
            StmtKind::If { test, then, otherwise } => {
                let constant = self.typed.shape(test.span).and_then(|shape| shape.constant.as_ref());
                let otherwise = otherwise.as_ref().is_some_and(|otherwise| self.leaves(otherwise));
                match constant.map(Value::truthy) {
                    Some(true) => self.leaves(then),
                    Some(false) => otherwise,
                    None => otherwise && self.leaves(then),
                }
            }
            _ => false,
        }
    }
}
