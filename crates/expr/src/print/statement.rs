//! Prints statements, declarations and functions.

use super::printer::{ASSIGNMENT, Printer};
use crate::ast::{Body, Declarator, Element, Expr, Function, Pattern, Stmt, StmtKind};

impl Printer<'_> {
    pub(super) fn lines(&mut self, statements: &[Stmt]) {
        for (i, statement) in statements.iter().enumerate() {
            if i > 0 {
                self.new_line();
            }
            self.statement(statement);
        }
    }

    pub(super) fn block(&mut self, statements: &[Stmt]) {
        if statements.is_empty() {
            return self.append("{}");
        }
        self.append("{");
        self.indent += 1;
        self.new_line();
        self.lines(statements);
        self.indent -= 1;
        self.new_line();
        self.append("}");
    }

    /// Prints the body of a condition or a loop, after its head.
    pub(super) fn body(&mut self, statement: &Stmt) {
        self.append(" ");
        self.statement(statement);
    }

    pub(super) fn statement(&mut self, statement: &Stmt) {
        match &statement.kind {
            StmtKind::Expr(expr) => self.expression_statement(expr),
            StmtKind::Declare { constant, declarators } => {
                self.declarators(*constant, declarators);
                self.append(";");
            }
            StmtKind::Function { name, function } => {
                self.append("function ");
                self.append(&name.text);
                self.params(&function.params);
                self.append(" ");
                match &function.body {
                    Body::Block(statements) => self.block(statements),
                    Body::Value(_) => self.append("{}"), // the parser never builds these
                }
            }
            StmtKind::If { test, then, otherwise } => self.condition(test, then, otherwise.as_deref()),
            StmtKind::For { init, test, update, body } => {
                self.for_head(init.as_deref(), test.as_ref(), update.as_ref());
                self.body(body);
            }
            StmtKind::ForOf { constant, target, items, body } => {
                self.append(if *constant { "for (const " } else { "for (let " });
                self.pattern(target);
                self.append(" of ");
                self.expr(items, ASSIGNMENT);
                self.append(")");
                self.body(body);
            }
            StmtKind::While { test, body } => {
                self.head("while", test);
                self.body(body);
            }
            StmtKind::DoWhile { body, test } => {
                self.append("do");
                self.body(body);
                self.append(" ");
                self.head("while", test);
                self.append(";");
            }
            StmtKind::Block(statements) => self.block(statements),
            StmtKind::Break => self.append("break;"),
            StmtKind::Continue => self.append("continue;"),
            StmtKind::Return(None) => self.append("return;"),
            StmtKind::Return(Some(value)) => {
                self.append("return ");
                self.expr(value, ASSIGNMENT);
                self.append(";");
            }
            StmtKind::Empty => self.append(";"),
            StmtKind::Error => self.append("<error>"),
        }
    }

    /// Prints an expression statement.
    fn expression_statement(&mut self, expr: &Expr) {
        // A statement that starts with `{` or `function` would be parsed as a block or a declaration.
        let start = self.out.len();
        self.expr(expr, 0);
        let text = self.out.get(start..).unwrap_or("");
        if text.starts_with('{') || text.starts_with("function") {
            self.out.insert(start, '(');
            self.append(")");
        }
        self.append(";");
    }

    /// Prints `if` and its `else`.
    fn condition(&mut self, test: &Expr, then: &Stmt, otherwise: Option<&Stmt>) {
        self.head("if", test);
        match otherwise {
            None => self.body(then),
            Some(otherwise) => {
                // Without braces, the `else` could belong to an inner `if`.
                if open_ended(then) {
                    self.append(" ");
                    self.block(std::slice::from_ref(then));
                } else {
                    self.body(then);
                }
                self.append(" else");
                self.body(otherwise);
            }
        }
    }

    /// Prints `for (init; test; update)`.
    fn for_head(&mut self, init: Option<&Stmt>, test: Option<&Expr>, update: Option<&Expr>) {
        self.append("for (");
        match init.map(|s| &s.kind) {
            Some(StmtKind::Declare { constant, declarators }) => {
                self.declarators(*constant, declarators);
            }
            Some(StmtKind::Expr(expr)) => self.expr(expr, 0),
            _ => {}
        }
        self.append(";");
        if let Some(test) = test {
            self.append(" ");
            self.expr(test, ASSIGNMENT);
        }
        self.append(";");
        if let Some(update) = update {
            self.append(" ");
            self.expr(update, 0);
        }
        self.append(")");
    }

    pub(super) fn head(&mut self, word: &str, test: &Expr) {
        self.append(word);
        self.append(" (");
        self.expr(test, ASSIGNMENT);
        self.append(")");
    }

    pub(super) fn declarators(&mut self, constant: bool, declarators: &[Declarator]) {
        self.append(if constant { "const " } else { "let " });
        for (i, declarator) in declarators.iter().enumerate() {
            if i > 0 {
                self.append(", ");
            }
            self.pattern(&declarator.target);
            if let Some(value) = &declarator.value {
                self.append(" = ");
                self.expr(value, ASSIGNMENT);
            }
        }
    }

    pub(super) fn pattern(&mut self, pattern: &Pattern) {
        match pattern {
            Pattern::Name(name) => self.append(&name.text),
            Pattern::List { items, .. } => {
                self.append("[");
                for (i, item) in items.iter().enumerate() {
                    if i > 0 {
                        self.append(", ");
                    }
                    match item {
                        Some(item) => self.element(item),
                        // A hole at the end needs an additional comma.
                        None if i + 1 == items.len() => self.append(","),
                        None => {}
                    }
                }
                self.append("]");
            }
            Pattern::Record { entries, .. } => {
                self.append("{");
                for (i, (key, element)) in entries.iter().enumerate() {
                    if i > 0 {
                        self.append(", ");
                    }
                    if !matches!(&element.target, Pattern::Name(name) if name.text == key.text) {
                        self.append(&key.text);
                        self.append(": ");
                    }
                    self.element(element);
                }
                self.append("}");
            }
        }
    }

    pub(super) fn element(&mut self, element: &Element) {
        self.pattern(&element.target);
        if let Some(default) = &element.default {
            self.append(" = ");
            self.expr(default, ASSIGNMENT);
        }
    }

    pub(super) fn params(&mut self, params: &[Element]) {
        self.append("(");
        for (i, param) in params.iter().enumerate() {
            if i > 0 {
                self.append(", ");
            }
            self.element(param);
        }
        self.append(")");
    }

    pub(super) fn function(&mut self, function: &Function) {
        // A function that calls itself by its name must keep the name.
        if let (Some(name), Body::Block(statements)) = (&function.name, &function.body) {
            self.append("function ");
            self.append(&name.text);
            self.params(&function.params);
            self.append(" ");
            return self.block(statements);
        }
        self.params(&function.params);
        self.append(" => ");
        match &function.body {
            Body::Block(statements) => self.block(statements),
            // `=> {` would start a block.
            Body::Value(value) => {
                let start = self.out.len();
                self.expr(value, ASSIGNMENT);
                if self.out.get(start..).is_some_and(|text| text.starts_with('{')) {
                    self.out.insert(start, '(');
                    self.append(")");
                }
            }
        }
    }
}

/// Whether an `else` after this statement would belong to an `if` inside it.
fn open_ended(statement: &Stmt) -> bool {
    match &statement.kind {
        StmtKind::If { otherwise: None, .. } => true,
        StmtKind::If { otherwise: Some(last), .. } => open_ended(last),
        StmtKind::For { body, .. } | StmtKind::ForOf { body, .. } | StmtKind::While { body, .. } => {
            open_ended(body)
        }
        _ => false,
    }
}
