//! Statements, automatic semicolons, and recovery after errors.

use super::parser::{Attempt, MAX_DEPTH, Parser, Reported};
use super::refuse;
use crate::ast::{Expr, ExprKind, Pattern, Stmt, StmtKind};
use crate::lex::TokenKind;
use crate::rules;
use labspec_finding::{Finding, Span};

impl Parser<'_> {
    /// Parses all statements to the end of the text.
    pub(super) fn statements(&mut self) -> Vec<Stmt> {
        let mut statements = self.statements_up_to("");
        while !self.ended() {
            // An unmatched closing bracket is reported and skipped.
            statements.extend(self.statements_up_to(""));
        }
        statements
    }

    /// Parses statements up to a closing symbol, which is not consumed, or to the end of the text.
    pub(super) fn statements_up_to(&mut self, closer: &str) -> Vec<Stmt> {
        let mut statements = Vec::new();
        while !self.ended() && !self.is(closer) {
            if self.consume(";").is_some() {
                continue;
            }
            statements.push(self.recovered(closer));
        }
        statements
    }

    /// Parses one statement and its end.
    pub(super) fn statement(&mut self) -> Attempt<StmtKind> {
        if self.depth >= MAX_DEPTH {
            let span = self.span();
            return self.too_deep(span);
        }
        self.depth += 1;
        let (kind, height) = self.measured(Self::statement_inside);
        self.depth -= 1;
        self.tallest = self.tallest.max(height + 1);
        if self.tallest > MAX_DEPTH {
            let span = self.last_span();
            return self.too_deep(span);
        }
        kind
    }

    fn statement_inside(&mut self) -> Attempt<StmtKind> {
        let word = match self.peek() {
            TokenKind::Word(word) => *word,
            TokenKind::Symbol("{") => return self.block().map(StmtKind::Block),
            TokenKind::Symbol(")" | "]" | "}") => {
                let report = self.unexpected_after(Span::default());
                self.diagnostics.extend(report);
                return Err(Reported);
            }
            _ => return self.expression_statement(),
        };
        match word {
            "const" | "let" | "var" => self.declaration(),
            _ if self.reports_misspelt_declaration() => self.declaration(),
            "if" => self.condition(),
            "for" => self.for_loop(),
            "while" => self.while_loop(),
            "do" => self.do_loop(),
            "break" | "continue" => self.loop_exit(word == "break"),
            "return" => self.return_statement(),
            "function" => self.function_declaration(),
            _ if *self.peek_at(1) == TokenKind::Symbol(":") => {
                let report = refuse::label(self.span());
                self.diagnostics.push(report);
                self.bump();
                self.bump();
                self.statement()
            }
            _ => match self.statement_keyword() {
                Some(report) => {
                    self.diagnostics.push(report);
                    let named = self.class_name();
                    self.skip_construct();
                    named.ok_or(Reported)
                }
                None => self.expression_statement(),
            },
        }
    }

    fn while_loop(&mut self) -> Attempt<StmtKind> {
        self.bump();
        let test = self.head("while")?;
        let body = Box::new(self.body("while")?);
        Ok(StmtKind::While { test, body })
    }

    fn do_loop(&mut self) -> Attempt<StmtKind> {
        self.bump();
        let body = Box::new(self.body("do")?);
        if !self.is_word("while") {
            let report = Finding::error(rules::DO_WITHOUT_WHILE, self.span(), "a `do` loop has no `while`")
                .help("write `do { … } while (test)`");
            return self.refuse(report);
        }
        self.bump();
        let test = self.head("while")?;
        self.consume(";");
        Ok(StmtKind::DoWhile { body, test })
    }

    /// Parses `break` or `continue`.
    fn loop_exit(&mut self, breaks: bool) -> Attempt<StmtKind> {
        let span = self.bump();
        if !self.newline() && matches!(self.peek(), TokenKind::Word(_)) {
            let report = refuse::label(self.span());
            return self.refuse(report);
        }
        self.end_of_statement(span)?;
        Ok(if breaks { StmtKind::Break } else { StmtKind::Continue })
    }

    fn return_statement(&mut self) -> Attempt<StmtKind> {
        let span = self.bump();
        let bare = self.newline() || self.ended() || self.is(";") || self.is("}");
        let value = if bare { None } else { Some(self.assignment()?) };
        self.end_of_statement(span.to(self.last_span()))?;
        Ok(StmtKind::Return(value))
    }

    /// Parses an expression statement, or several expressions joined by commas.
    fn expression_statement(&mut self) -> Attempt<StmtKind> {
        let expr = self.sequence()?;
        self.end_of_statement(expr.span)?;
        Ok(StmtKind::Expr(expr))
    }

    pub(super) fn sequence(&mut self) -> Attempt<Expr> {
        let first = self.assignment()?;
        if !self.is(",") || self.decimal_comma().is_some() {
            return Ok(first);
        }
        let mut parts = vec![first];
        while self.consume(",").is_some() {
            parts.push(self.assignment()?);
        }
        let span = parts.iter().map(|part| part.span).reduce(Span::to).unwrap_or_default();
        Ok(Expr { kind: ExprKind::Sequence(parts), span })
    }

    /// Parses `(test)` after `if` or `while`.
    fn head(&mut self, word: &str) -> Attempt<Expr> {
        let Some(opener) = self.consume("(") else {
            let report = Finding::error(
                rules::MISSING_BRACKET,
                self.span(),
                format!("expected `(` after `{word}`, found {}", self.describe_token()),
            )
            .help(format!(
                "write the condition in parentheses, as `{word} ({} > 1)`",
                self.host_terms.number
            ));
            return self.refuse(report);
        };
        Ok(self.enclosed(opener, ")", 1)?.0.expr)
    }

    /// Parses the body of a condition or a loop.
    fn body(&mut self, word: &str) -> Attempt<Stmt> {
        let span = self.span();
        if self.consume(";").is_some() {
            let report = Finding::warning(
                rules::EMPTY_BODY,
                span,
                format!("this `;` is the whole body of the `{word}`"),
            )
            .why("the statement after it always runs, and only once")
            .help("remove the `;`")
            .guess(span, "");
            self.diagnostics.push(report);
            return Ok(Stmt { kind: StmtKind::Empty, span });
        }
        if self.ended() || self.is("}") {
            let report = Finding::error(
                rules::MISSING_STATEMENT,
                span,
                format!("expected a statement after `{word}`, found {}", self.describe_token()),
            )
            .help("write the statement to run, or several statements in braces");
            return self.refuse(report);
        }
        let declares = ["const", "let", "function"].iter().any(|w| self.is_word(w));
        if declares {
            let report = Finding::error(
                rules::LONE_DECLARATION,
                span,
                format!("a declaration is the only statement after `{word}`"),
            )
            .why("the name would disappear at once; JavaScript rejects it")
            .help("put the statements in braces");
            self.diagnostics.push(report);
        }
        let kind = self.statement()?;
        Ok(Stmt { kind, span: span.to(self.last_span()) })
    }

    fn condition(&mut self) -> Attempt<StmtKind> {
        self.bump();
        let test = self.head("if")?;
        let then = Box::new(self.body("if")?);
        let otherwise = if self.is_word("else") {
            self.bump();
            Some(Box::new(self.body("else")?))
        } else {
            None
        };
        Ok(StmtKind::If { test, then, otherwise })
    }

    fn for_loop(&mut self) -> Attempt<StmtKind> {
        self.bump();
        let Some(opener) = self.consume("(") else {
            let report = Finding::error(
                rules::MISSING_BRACKET,
                self.span(),
                format!("expected `(` after `for`, found {}", self.describe_token()),
            )
            .help("write `for (let i = 0; i < n; i++) { … }`");
            return self.refuse(report);
        };
        if let Some((constant, target)) = self.for_of_head()? {
            let items = self.enclosed(opener, ")", 1)?.0.expr;
            let body = Box::new(self.body("for")?);
            return Ok(StmtKind::ForOf { constant, target, items, body });
        }
        let init = match self.peek() {
            TokenKind::Symbol(";") => None,
            _ => {
                let span = self.span();
                let declares = ["const", "let", "var"].iter().any(|w| self.is_word(w))
                    || self.reports_misspelt_declaration();
                let kind = if declares { self.declarators()?.0 } else { StmtKind::Expr(self.sequence()?) };
                Some(Box::new(Stmt { kind, span: span.to(self.last_span()) }))
            }
        };
        self.separator()?;
        let test = if self.is(";") { None } else { Some(self.assignment()?) };
        self.separator()?;
        let update = if self.is(")") { None } else { Some(self.sequence()?) };
        if self.consume(")").is_none() {
            let last = self.last_span();
            let report = self.unclosed(opener, ")", last);
            self.diagnostics.extend(report);
            return Err(Reported);
        }
        let body = Box::new(self.body("for")?);
        Ok(StmtKind::For { init, test, update, body })
    }

    /// Parses `const name of` if it follows `for (`.
    fn for_of_head(&mut self) -> Attempt<Option<(bool, Pattern)>> {
        let declares = ["const", "let", "var"].iter().any(|w| self.is_word(w));
        let constant = self.is_word("const");
        let behind = self.after_group(usize::from(declares));
        let is_word = |word: &str| matches!(self.peek_at(behind), TokenKind::Word(w) if *w == word);
        if !is_word("of") && !is_word("in") {
            return Ok(None);
        }
        if declares {
            self.bump();
        }
        let target = self.pattern("a name")?;
        if self.is_word("in") {
            let report = refuse::for_in(self.span());
            return self.refuse(report);
        }
        if !declares {
            let span = target.span();
            let report = Finding::error(
                rules::LOOP_WITHOUT_CONST,
                span,
                "the name of a `for … of` loop needs `const`",
            )
            .help(format!("write `for (const {} of …)`", span.text(self.source)))
            .fix(Span::new(span.start, span.start), "const ");
            self.diagnostics.push(report);
        }
        self.bump();
        Ok(Some((constant || !declares, target)))
    }

    /// Parses a `;` in the head of a `for`.
    fn separator(&mut self) -> Attempt<()> {
        if self.consume(";").is_some() {
            return Ok(());
        }
        let report = Finding::error(
            rules::LOOP_HEAD,
            self.span(),
            format!("expected `;`, found {}", self.describe_token()),
        )
        .why("the head of a `for` has three parts: start, condition, step")
        .help("write `for (let i = 0; i < n; i++) { … }`");
        self.refuse(report)
    }

    /// Parses a semicolon, a line end or the end of the text.
    pub(super) fn end_of_statement(&mut self, statement: Span) -> Attempt<()> {
        if self.consume(";").is_some() || self.ended() || self.newline() || self.is("}") {
            return Ok(());
        }
        let report = self.unexpected_after(statement);
        self.diagnostics.extend(report);
        Err(Reported)
    }
}
