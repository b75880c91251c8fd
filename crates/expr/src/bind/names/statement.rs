//! Name resolution in statements: which names they declare, and in which order these names get their values.

use super::language::{is_language, report_redeclared};
use super::walk::{NameWalk, WHOLE};
use crate::ast::{Declarator, Element, Expr, ExprKind, Name, Pattern, Stmt, StmtKind};
use crate::schema::Schema;

impl<'a> NameWalk<'a, '_> {
    /// Statements with their own scope.
    pub(in crate::bind) fn block(&mut self, statements: &'a [Stmt]) {
        let reach = self.reach.len();
        self.hoist(statements);
        for statement in statements {
            self.statement(statement);
        }
        self.leave(reach);
    }

    /// Closes the scope of a block, after visiting the functions that no name referred to.
    pub(super) fn leave(&mut self, reach: usize) {
        let block = self.reach.get(reach..).unwrap_or(&[]);
        let held: Vec<usize> = block.iter().filter_map(|byte| self.names.declared.get(byte)?.holds).collect();
        held.into_iter().for_each(|function| self.visit(function));
        self.reach.truncate(reach);
    }

    /// Declares the names of a block before its statements: they are in scope in the whole block, and functions can be
    /// called from its start.
    fn hoist(&mut self, statements: &'a [Stmt]) {
        let first = self.reach.len();
        for statement in statements {
            match &statement.kind {
                StmtKind::Declare { constant, declarators } => {
                    for Declarator { target, .. } in declarators {
                        self.hoist_pattern(target, *constant, first);
                    }
                }
                StmtKind::Function { name, .. } => self.hoist_name(name, true, first),
                _ => {}
            }
        }
        for statement in statements {
            if let StmtKind::Function { name, function } = &statement.kind {
                self.define(function);
                match self.names.declared.get_mut(&name.span.start) {
                    Some(declared) => (declared.ready, declared.holds) = (true, Some(function.span.start)),
                    None => self.visit(function.span.start), // a name that could not be declared
                }
            }
        }
    }

    fn hoist_pattern(&mut self, pattern: &'a Pattern, constant: bool, first: usize) {
        names_of(pattern, &mut |name| self.hoist_name(name, constant, first));
    }

    fn hoist_name(&mut self, name: &Name, constant: bool, first: usize) {
        let is = |byte: &usize| self.names.declared.get(byte).is_some_and(|d| d.name == name.text);
        let is_declared = self.reach.iter().skip(first).any(is);
        // In JavaScript, the names of the lab are parameters of the function whose body is the text, so the top level
        // cannot redeclare them.
        let top = first == 0 && self.function == WHOLE;
        let host = |schema: &dyn Schema| schema.root(&name.text).is_some();
        let outer = top && (is_language(&name.text) || self.around.schema.is_some_and(host));
        if is_declared || outer {
            self.found.push(report_redeclared(name, is_declared));
            return;
        }
        self.declare(name, constant, false);
    }

    /// Declares the names of a parameter.
    pub(super) fn parameter(&mut self, target: &'a Pattern, first: usize) {
        match target {
            Pattern::Name(name) => self.declare(name, false, true),
            pattern => self.hoist_pattern(pattern, false, first),
        }
    }

    /// Resolves an element of a pattern: its default first, then its target.
    pub(super) fn element(&mut self, element: &'a Element) {
        if let Some(default) = &element.default {
            self.value(default);
        }
        self.mark_initialized(&element.target);
    }

    /// Marks the names of a pattern as initialized.
    fn mark_initialized(&mut self, pattern: &'a Pattern) {
        match pattern {
            Pattern::Name(name) => {
                if let Some(declared) = self.names.declared.get_mut(&name.span.start) {
                    declared.ready = true;
                }
            }
            Pattern::List { items, .. } => items.iter().flatten().for_each(|e| self.element(e)),
            Pattern::Record { entries, .. } => entries.iter().for_each(|(_, e)| self.element(e)),
        }
    }

    fn statement(&mut self, statement: &'a Stmt) {
        self.levels += 1;
        match &statement.kind {
            StmtKind::Error
            | StmtKind::Empty
            | StmtKind::Function { .. }
            | StmtKind::Break
            | StmtKind::Continue
            | StmtKind::Return(None) => {}
            StmtKind::Return(Some(value)) => self.value(value),
            StmtKind::Expr(expr) => self.effect(expr),
            StmtKind::Declare { constant, declarators } => {
                declarators.iter().for_each(|declarator| self.declarator(*constant, declarator));
            }
            StmtKind::If { test, then, otherwise } => {
                self.test(test);
                self.scoped(then);
                otherwise.iter().for_each(|otherwise| self.scoped(otherwise));
            }
            StmtKind::For { init, test, update, body } => {
                let reach = self.reach.len();
                if let Some(init) = init {
                    if let StmtKind::Declare { constant, declarators } = &init.kind {
                        for Declarator { target, .. } in declarators {
                            self.hoist_pattern(target, *constant, reach);
                        }
                    }
                    self.statement(init);
                }
                test.iter().for_each(|test| self.test(test));
                self.scoped(body);
                update.iter().for_each(|update| self.effect(update));
                self.leave(reach);
            }
            StmtKind::ForOf { constant, target, items, body } => {
                self.value(items);
                let reach = self.reach.len();
                self.hoist_pattern(target, *constant, reach);
                self.mark_initialized(target);
                self.scoped(body);
                self.leave(reach);
            }
            StmtKind::While { test, body } => {
                self.test(test);
                self.scoped(body);
            }
            StmtKind::DoWhile { test, body } => {
                self.test(test);
                self.scoped(body);
            }
            StmtKind::Block(statements) => self.block(statements),
        }
        self.levels -= 1;
    }

    /// A statement with its own scope.
    fn scoped(&mut self, statement: &'a Stmt) {
        match &statement.kind {
            StmtKind::Block(statements) => self.block(statements),
            _ => self.block(std::slice::from_ref(statement)),
        }
    }

    fn declarator(&mut self, constant: bool, declarator: &'a Declarator) {
        match (&declarator.target, &declarator.value) {
            // A named function is visited where it is first used.
            (Pattern::Name(name), Some(Expr { kind: ExprKind::Function(function), .. })) if constant => {
                self.define(function);
                match self.names.declared.get_mut(&name.span.start) {
                    Some(declared) => declared.holds = Some(function.span.start),
                    None => self.visit(function.span.start),
                }
            }
            (Pattern::Name(_), Some(value)) => self.change(value),
            (_, Some(value)) => self.value(value),
            (_, None) => {}
        }
        self.mark_initialized(&declarator.target);
    }

    /// An expression used as a statement.
    fn effect(&mut self, expr: &'a Expr) {
        match &expr.kind {
            ExprKind::Sequence(parts) => parts.iter().for_each(|part| self.effect(part)),
            ExprKind::Logical { left, right, .. } => {
                self.value(left);
                self.effect(right);
            }
            ExprKind::Conditional { test, then, otherwise } => {
                self.test(test);
                self.effect(then);
                self.effect(otherwise);
            }
            _ => self.change(expr),
        }
    }
}

/// Calls `work` for every name of a pattern.
pub(in crate::bind) fn names_of<'p>(pattern: &'p Pattern, work: &mut dyn FnMut(&'p Name)) {
    match pattern {
        Pattern::Name(name) => work(name),
        Pattern::List { items, .. } => items.iter().flatten().for_each(|e| names_of(&e.target, work)),
        Pattern::Record { entries, .. } => entries.iter().for_each(|(_, e)| names_of(&e.target, work)),
    }
}
