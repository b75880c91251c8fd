//! The assignments of a text, as lints about statements need them.

use crate::source::Text;
use labspec_expr::ast::{BinaryOp, Body, Expr, ExprKind, Stmt, StmtKind};
use labspec_expr::parse_statements;
use labspec_finding::Span;

/// An assignment of a text.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Assignment {
    /// The target without spaces.
    pub(crate) target: String,
    /// The span of the target.
    pub(crate) place: Span,
    /// The span of the whole assignment.
    pub(crate) span: Span,
    /// The operator of a compound assignment; `++` and `--` count as addition and subtraction.
    pub(crate) op: Option<BinaryOp>,
    /// The text of the value; empty for `++`.
    pub(crate) value: String,
}

impl Assignment {
    /// Whether the new value depends on the old one.
    pub(crate) fn is_cumulative(&self) -> bool {
        self.op.is_some() || contains_path(&without_spaces(&self.value), &self.target)
    }

    /// The number that is stored, if it is a literal.
    pub(crate) fn number(&self) -> Option<f64> {
        without_spaces(&self.value).parse().ok().filter(|_| self.op.is_none())
    }
}

pub(crate) fn without_spaces(text: &str) -> String {
    text.chars().filter(|c| !c.is_whitespace()).collect()
}

/// Whether a text without spaces contains a path, and not only a longer one that starts or ends like it.
pub(crate) fn contains_path(text: &str, path: &str) -> bool {
    let is_part = |c: char| c.is_alphanumeric() || c == '_' || c == '$';
    text.match_indices(path).any(|(at, _)| {
        let before = text.get(..at).unwrap_or("");
        let after = text.get(at + path.len()..).unwrap_or("");
        !before.ends_with(|c| is_part(c) || c == '.') && !after.starts_with(is_part)
    })
}

/// All assignments of a text, in order; those of `ctx ||= …`, which store a first value, are left out.
pub(crate) fn assignments(text: &Text) -> Vec<Assignment> {
    let mut all = Vec::new();
    let source = text.as_str();
    parse_statements(source).tree.iter().for_each(|statement| of_statement(statement, source, &mut all));
    all
}

fn of_statement(statement: &Stmt, source: &str, all: &mut Vec<Assignment>) {
    match &statement.kind {
        StmtKind::Expr(expr) => of_expr(expr, source, all),
        StmtKind::Function { function, .. } => {
            if let Body::Block(statements) = &function.body {
                statements.iter().for_each(|inner| of_statement(inner, source, all));
            }
        }
        StmtKind::If { then, otherwise, .. } => {
            of_statement(then, source, all);
            otherwise.iter().for_each(|inner| of_statement(inner, source, all));
        }
        StmtKind::For { body, .. }
        | StmtKind::ForOf { body, .. }
        | StmtKind::While { body, .. }
        | StmtKind::DoWhile { body, .. } => of_statement(body, source, all),
        StmtKind::Block(statements) => statements.iter().for_each(|inner| of_statement(inner, source, all)),
        _ => {}
    }
}

fn of_expr(expr: &Expr, source: &str, all: &mut Vec<Assignment>) {
    let text = |span: Span| span.text(source);
    match &expr.kind {
        ExprKind::Assign { target, op, value, .. } => all.push(Assignment {
            target: without_spaces(text(target.span)),
            place: target.span,
            span: target.span.to(value.span),
            op: *op,
            value: text(value.span).to_owned(),
        }),
        ExprKind::Update { target, increment, .. } => all.push(Assignment {
            target: without_spaces(text(target.span)),
            place: target.span,
            span: expr.span,
            op: Some(if *increment { BinaryOp::Add } else { BinaryOp::Subtract }),
            value: String::new(),
        }),
        ExprKind::Sequence(parts) => parts.iter().for_each(|part| of_expr(part, source, all)),
        ExprKind::Logical { right, .. } => of_expr(right, source, all),
        ExprKind::Conditional { then, otherwise, .. } => {
            of_expr(then, source, all);
            of_expr(otherwise, source, all);
        }
        _ => {}
    }
}
