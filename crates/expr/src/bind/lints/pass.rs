//! The traversal of a source text by the lints.

use crate::ast::{BinaryOp, Body, Element, Expr, ExprKind, Pattern, Property, Stmt, StmtKind};
use crate::bind::source::SourceTree;
use crate::bind::types::{Expectation, TypedText};
use crate::schema::Schema;
use labspec_finding::{Finding, Span};

/// The state of the traversal.
pub(super) struct LintPass<'l> {
    pub(super) schema: &'l dyn Schema,
    pub(super) source: &'l str,
    pub(super) typed: &'l TypedText,
    pub(super) found: Vec<Finding>,
}

/// Runs the lints on a source text.
pub(in crate::bind) fn lint(
    schema: &dyn Schema,
    source: &str,
    tree: SourceTree<'_>,
    typed: &TypedText,
) -> Vec<Finding> {
    let mut pass = LintPass { schema, source, typed, found: Vec::new() };
    match tree {
        SourceTree::Expression(expr) | SourceTree::Target(expr) => pass.expr(expr),
        SourceTree::Statements(statements) => pass.block(statements),
    }
    for (span, expectation, shape) in &typed.expectations {
        match expectation {
            Expectation::Number(by) => pass.text_for_number(*span, by, shape),
            Expectation::Angle(by) => pass.angle(*span, by, shape),
            Expectation::Element(element) => {
                pass.text_stored(*span, shape);
                pass.degrees_stored(*span, *element, shape);
            }
        }
    }
    pass.found
}

impl LintPass<'_> {
    pub(super) fn text(&self, span: Span) -> &str {
        span.text(self.source)
    }

    pub(super) fn expr(&mut self, expr: &Expr) {
        match &expr.kind {
            ExprKind::Unary { op, .. } => self.text_operand(*op, expr),
            ExprKind::Binary { op, left, right } => {
                self.compared_with_nan(*op, left, right, expr.span);
                self.chained(*op, left, expr.span);
                self.text_operands(*op, left, right);
                self.converted(*op, left, right);
                if *op == BinaryOp::BitXor {
                    self.power(left, right, expr.span);
                }
            }
            ExprKind::Logical { op, left, .. } => self.fallback(*op, left, expr.span),
            _ => {}
        }
        self.inside(expr);
    }

    /// Visits the parts of an expression.
    #[inline(never)]
    pub(super) fn inside(&mut self, expr: &Expr) {
        let mut all = |items: &[Expr]| items.iter().for_each(|item| self.expr(item));
        match &expr.kind {
            ExprKind::Array(items) | ExprKind::Sequence(items) | ExprKind::Template { values: items, .. } => {
                all(items);
            }
            ExprKind::Call { callee, args, .. } => {
                all(args);
                self.same_argument(callee, args);
                self.expr(callee);
            }
            ExprKind::Unary { operand: inner, .. }
            | ExprKind::Member { object: inner, .. }
            | ExprKind::Update { target: inner, .. }
            | ExprKind::Chain(inner)
            | ExprKind::Spread(inner) => self.expr(inner),
            ExprKind::Binary { left: a, right: b, .. }
            | ExprKind::Logical { left: a, right: b, .. }
            | ExprKind::Index { object: a, index: b, .. }
            | ExprKind::Assign { target: a, value: b, .. }
            | ExprKind::AssignLogical { target: a, value: b, .. } => {
                self.expr(a);
                self.expr(b);
            }
            ExprKind::Conditional { test, then, otherwise } => {
                [test, then, otherwise].into_iter().for_each(|part| self.expr(part));
            }
            ExprKind::Object(properties) => {
                for property in properties {
                    match property {
                        Property::Named { value, .. } | Property::Spread(value) => self.expr(value),
                        Property::Computed { key, value } => {
                            self.expr(key);
                            self.expr(value);
                        }
                    }
                }
            }
            ExprKind::Function(function) => {
                function.params.iter().for_each(|param| self.element(param));
                match &function.body {
                    Body::Value(value) => self.expr(value),
                    Body::Block(statements) => self.block(statements),
                }
            }
            ExprKind::Name(_)
            | ExprKind::Number(_)
            | ExprKind::String(_)
            | ExprKind::Boolean(_)
            | ExprKind::Null
            | ExprKind::Error => {}
        }
    }

    pub(super) fn block(&mut self, statements: &[Stmt]) {
        self.never_reached(statements);
        self.stored_twice(statements);
        statements.iter().for_each(|statement| self.statement(statement));
    }

    #[inline(never)]
    pub(super) fn statement(&mut self, statement: &Stmt) {
        match &statement.kind {
            StmtKind::Error | StmtKind::Empty | StmtKind::Break | StmtKind::Continue => {}
            StmtKind::Return(value) => value.iter().for_each(|value| self.expr(value)),
            StmtKind::Expr(expr) => {
                self.unused(expr);
                self.expr(expr);
            }
            StmtKind::Declare { declarators, .. } => {
                for declarator in declarators {
                    self.pattern(&declarator.target);
                    declarator.value.iter().for_each(|value| self.expr(value));
                }
            }
            StmtKind::Function { function, .. } => {
                function.params.iter().for_each(|param| self.element(param));
                if let Body::Block(statements) = &function.body {
                    self.block(statements);
                }
            }
            StmtKind::If { test, then, otherwise } => {
                self.expr(test);
                self.statement(then);
                otherwise.iter().for_each(|otherwise| self.statement(otherwise));
            }
            StmtKind::For { init, test, update, body } => {
                init.iter().for_each(|init| self.statement(init));
                test.iter().for_each(|test| self.expr(test));
                update.iter().for_each(|update| {
                    self.unused(update);
                    self.expr(update);
                });
                self.statement(body);
            }
            StmtKind::ForOf { target, items, body, .. } => {
                self.pattern(target);
                self.expr(items);
                self.statement(body);
            }
            StmtKind::While { test, body } | StmtKind::DoWhile { test, body } => {
                self.expr(test);
                self.statement(body);
            }
            StmtKind::Block(statements) => self.block(statements),
        }
    }

    pub(super) fn element(&mut self, element: &Element) {
        self.pattern(&element.target);
        element.default.iter().for_each(|default| self.expr(default));
    }

    /// Visits the defaults of a pattern.
    pub(super) fn pattern(&mut self, pattern: &Pattern) {
        match pattern {
            Pattern::Name(_) => {}
            Pattern::List { items, .. } => items.iter().flatten().for_each(|item| self.element(item)),
            Pattern::Record { entries, .. } => entries.iter().for_each(|(_, element)| self.element(element)),
        }
    }
}
