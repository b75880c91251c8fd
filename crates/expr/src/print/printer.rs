//! The output of the printer, and the binding powers of trees.

use crate::ast::{Expr, ExprKind};

/// Binding powers beyond those of the operators, see [`crate::ast::BinaryOp::power`].
pub(super) const ASSIGNMENT: u8 = 1;
pub(super) const CHOICE: u8 = 2;
pub(super) const SIGN: u8 = 15;
pub(super) const UPDATE: u8 = 16;
pub(super) const MEMBER: u8 = 17;
/// The binding power of a name or a literal, which has no operands.
pub(super) const ATOM: u8 = 18;

/// The binding power of the outermost operator of a tree.
pub(super) fn power(expr: &Expr) -> u8 {
    match &expr.kind {
        ExprKind::Sequence(_) => 0,
        ExprKind::Assign { .. } | ExprKind::AssignLogical { .. } | ExprKind::Function(_) => ASSIGNMENT,
        ExprKind::Conditional { .. } => CHOICE,
        ExprKind::Logical { op, .. } => op.power(),
        ExprKind::Binary { op, .. } => op.power(),
        ExprKind::Unary { .. } => SIGN,
        ExprKind::Update { .. } => UPDATE,
        // If a member follows a chain, the chain needs parentheses, so that the member does not become part of it.
        ExprKind::Chain(_) => MEMBER - 1,
        ExprKind::Member { .. } | ExprKind::Index { .. } | ExprKind::Call { .. } => MEMBER,
        _ => ATOM,
    }
}

#[derive(Default)]
pub(super) struct Printer<'s> {
    pub(super) out: String,
    pub(super) indent: usize,
    /// Whether to print everything on one line.
    pub(super) line: bool,
    /// The source of the tree, for the spelling of numbers; empty if that is irrelevant.
    pub(super) source: &'s str,
}

impl Printer<'_> {
    pub(super) fn append(&mut self, text: &str) {
        self.out.push_str(text);
    }

    pub(super) fn new_line(&mut self) {
        if self.line {
            return self.append(" ");
        }
        self.out.push('\n');
        for _ in 0..self.indent {
            self.out.push_str("  ");
        }
    }
}
