//! An expression that is being read, and the binding powers beyond those of the operators.

use crate::ast::{BinaryOp, Expr, ExprKind, LogicalOp};
use labspec_finding::Span;

/// Binding powers that no operator table holds, see [`crate::ast::BinaryOp::power`].
pub(super) const ASSIGNMENT: u8 = 1;
pub(super) const CHOICE: u8 = 2;
pub(super) const SIGN: u8 = 15;

/// An expression with what only the parser needs to know.
pub(super) struct ExprNode {
    pub(super) expr: Expr,
    pub(super) height: usize,
    /// It stands between parentheses.
    pub(super) closed: bool,
    /// A `?.` stands in the chain of members that it ends.
    pub(super) chain: bool,
}

impl ExprNode {
    /// Puts the mark of a chain around a finished one.
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

/// What stands between two operands.
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
