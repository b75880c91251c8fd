//! The traversal of a source text by the lints.

use super::constants::{Definitions, definitions};
use crate::ast::{BinaryOp, Body, Element, Expr, ExprKind, Pattern, Property, Stmt, StmtKind};
use crate::bind::source::SourceTree;
use crate::bind::types::{Expectation, TypedText};
use crate::schema::Schema;
use labspec_finding::{Finding, Span};
use std::collections::BTreeSet;

/// The state of the traversal.
pub(super) struct LintPass<'l> {
    pub(super) schema: &'l dyn Schema,
    pub(super) source: &'l str,
    pub(super) typed: &'l TypedText,
    pub(super) found: Vec<Finding>,
    /// The constants that the text declares.
    pub(super) definitions: Definitions<'l>,
    /// The variables of the blocks around the current one.
    pub(super) scopes: Vec<Vec<String>>,
    /// Parts of chains that were checked as a whole.
    pub(super) visited: BTreeSet<Span>,
}

/// Runs the lints on a source text.
pub(in crate::bind) fn lint<'l>(
    schema: &'l dyn Schema,
    source: &'l str,
    tree: SourceTree<'l>,
    typed: &'l TypedText,
) -> Vec<Finding> {
    let mut pass = LintPass {
        schema,
        source,
        typed,
        found: Vec::new(),
        definitions: definitions(tree),
        scopes: Vec::new(),
        visited: BTreeSet::new(),
    };
    match tree {
        SourceTree::Expression(expr) | SourceTree::Target(expr) => pass.expr(expr),
        SourceTree::Statements(statements) => pass.block(statements),
    }
    pass.comment_as_division();
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
            ExprKind::Binary { op, left, right } => self.binary(*op, left, right, expr),
            ExprKind::Logical { op, left, .. } => {
                self.fallback(*op, left, expr.span);
                self.limits(*op, expr);
            }
            ExprKind::Conditional { test, .. } => self.tested(test),
            ExprKind::Call { callee, args, .. } => {
                self.clamped(expr);
                self.converted_twice(expr);
                self.searched(callee, args, expr.span);
            }
            _ => {}
        }
        self.inside(expr);
    }

    /// Checks an operator between two operands.
    #[inline(never)]
    fn binary(&mut self, op: BinaryOp, left: &Expr, right: &Expr, expr: &Expr) {
        let span = expr.span;
        self.compared_with_nan(op, left, right, span);
        self.chained(op, left, span);
        self.negated_operand(op, left, right, span);
        self.power_of_quotient(op, left, right, span);
        self.joined_first(op, left, right, span);
        self.exact(op, left, right, span);
        self.outside_range(expr);
        self.angle_in_degrees(op, left, right);
        self.text_operands(op, left, right);
        self.converted(op, left, right);
        match op {
            BinaryOp::Add => self.same_term(expr),
            BinaryOp::Multiply | BinaryOp::Divide => self.degree_factor(expr),
            BinaryOp::BitXor => self.power(left, right, span),
            _ => {}
        }
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
        let names = self.lost_declarations(statements);
        self.scopes.push(names);
        statements.iter().for_each(|statement| self.statement(statement));
        self.scopes.pop();
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
                self.tested(test);
                self.expr(test);
                self.statement(then);
                otherwise.iter().for_each(|otherwise| self.statement(otherwise));
            }
            StmtKind::For { init, test, update, body } => {
                self.counted_away(init.as_deref(), test.as_ref(), update.as_ref());
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
                self.tested(test);
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
