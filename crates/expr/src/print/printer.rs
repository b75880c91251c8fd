//! The text that is being made, and how tightly the parts of a tree bind.

use crate::ast::{Expr, ExprKind};

/// Binding powers beyond those of the operators, see [`crate::ast::BinaryOp::power`].
pub(super) const ASSIGNMENT: u8 = 1;
pub(super) const CHOICE: u8 = 2;
pub(super) const SIGN: u8 = 15;
pub(super) const UPDATE: u8 = 16;
pub(super) const MEMBER: u8 = 17;
/// Of a name or a literal, which nothing can take apart.
pub(super) const ATOM: u8 = 18;

/// How tightly the outermost operator of a tree binds.
pub(super) fn power(expr: &Expr) -> u8 {
    match &expr.kind {
        ExprKind::Sequence(_) => 0,
        ExprKind::Assign { .. } | ExprKind::AssignLogical { .. } | ExprKind::Function(_) => ASSIGNMENT,
        ExprKind::Conditional { .. } => CHOICE,
        ExprKind::Logical { op, .. } => op.power(),
        ExprKind::Binary { op, .. } => op.power(),
        ExprKind::Unary { .. } => SIGN,
        ExprKind::Update { .. } => UPDATE,
        // A chain that goes on must not swallow what was outside of it.
        ExprKind::Chain(_) => MEMBER - 1,
        ExprKind::Member { .. } | ExprKind::Index { .. } | ExprKind::Call { .. } => MEMBER,
        _ => ATOM,
    }
}

#[derive(Default)]
pub(super) struct Printer<'s> {
    pub(super) out: String,
    pub(super) indent: usize,
    /// All on one line.
    pub(super) line: bool,
    /// Where the tree was read from, for numbers as they are written; empty when that does not matter.
    pub(super) source: &'s str,
}

impl Printer<'_> {
    pub(super) fn put(&mut self, text: &str) {
        self.out.push_str(text);
    }

    pub(super) fn new_line(&mut self) {
        if self.line {
            return self.put(" ");
        }
        self.out.push('\n');
        for _ in 0..self.indent {
            self.out.push_str("  ");
        }
    }
}
