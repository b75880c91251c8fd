//! The third pass: what is allowed, but hardly ever meant. It looks at the text and at what is known of its parts, and changes
//! nothing.

mod angles;
mod compare;
mod idle;
mod numbers;
mod twice;

use super::Tree;
use super::types::{Typed, Want};
use crate::ast::{BinaryOp, Body, Element, Expr, ExprKind, Pattern, Property, Stmt, StmtKind};
use crate::schema::Schema;
use labspec_finding::{Finding, Span};

/// What the lints look at.
struct Look<'l> {
    schema: &'l dyn Schema,
    source: &'l str,
    typed: &'l Typed,
    found: Vec<Finding>,
}

/// Looks through a text.
pub(super) fn look(schema: &dyn Schema, source: &str, tree: Tree<'_>, typed: &Typed) -> Vec<Finding> {
    let mut look = Look { schema, source, typed, found: Vec::new() };
    match tree {
        Tree::Expression(expr) | Tree::Target(expr) => look.expr(expr),
        Tree::Statements(statements) => look.block(statements),
    }
    for (span, want, shape) in &typed.wants {
        match want {
            Want::Number(by) => look.text_for_number(*span, by, shape),
            Want::Angle(by) => look.angle(*span, by, shape),
            Want::Element(element) => {
                look.text_stored(*span, shape);
                look.degrees_stored(*span, *element, shape);
            }
        }
    }
    look.found
}

impl Look<'_> {
    fn text(&self, span: Span) -> &str {
        span.text(self.source)
    }

    fn expr(&mut self, expr: &Expr) {
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

    /// The parts of an expression.
    #[inline(never)]
    fn inside(&mut self, expr: &Expr) {
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

    fn block(&mut self, statements: &[Stmt]) {
        self.never_reached(statements);
        self.stored_twice(statements);
        statements.iter().for_each(|statement| self.statement(statement));
    }

    #[inline(never)]
    fn statement(&mut self, statement: &Stmt) {
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

    fn element(&mut self, element: &Element) {
        self.pattern(&element.target);
        element.default.iter().for_each(|default| self.expr(default));
    }

    /// The defaults of a pattern.
    fn pattern(&mut self, pattern: &Pattern) {
        match pattern {
            Pattern::Name(_) => {}
            Pattern::List { items, .. } => items.iter().flatten().for_each(|item| self.element(item)),
            Pattern::Record { entries, .. } => entries.iter().for_each(|(_, element)| self.element(element)),
        }
    }
}
