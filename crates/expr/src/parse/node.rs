//! A partially parsed expression, and the binding powers that are not those of binary operators.

use crate::ast::{BinaryOp, Expr, ExprKind, LogicalOp};
use labspec_finding::Span;

/// Binding powers that are not in the tables of operators, see [`crate::ast::BinaryOp::power`].
pub(super) const ASSIGNMENT: u8 = 1;
pub(super) const CHOICE: u8 = 2;
pub(super) const SIGN: u8 = 15;

/// An expression with properties that only the parser needs.
pub(super) struct ExprNode {
    pub(super) expr: Expr,
    pub(super) height: usize,
    /// Whether it is enclosed in parentheses.
    pub(super) closed: bool,
    /// Whether it ends a chain of members that contains `?.`.
    pub(super) chain: bool,
}

impl ExprNode {
    /// Wraps a completed chain in [`ExprKind::Chain`].
    pub(super) fn whole_chain(self) -> ExprNode {
        if !self.chain {
            return self;
        }
        let span = self.expr.span;
        let kind = ExprKind::Chain(Box::new(self.expr));
        ExprNode { expr: Expr { kind, span }, height: self.height + 1, chain: false, ..self }
    }
}

pub(super) fn error_node(span: Span) -> ExprNode {
    ExprNode { expr: Expr { kind: ExprKind::Error, span }, height: 1, closed: true, chain: false }
}

/// An operator between two operands.
pub(super) enum Infix {
    Binary(BinaryOp),
    Logical(LogicalOp),
}

pub(super) fn infix(symbol: &str) -> Option<(Infix, u8)> {
    if let Some(op) = BinaryOp::ALL.into_iter().find(|op| op.symbol() == symbol) {
        return Some((Infix::Binary(op), op.power()));
    }
    let op = LogicalOp::ALL.into_iter().find(|op| op.symbol() == symbol)?;
    Some((Infix::Logical(op), op.power()))
}
