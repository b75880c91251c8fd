//! Statements, automatic semicolons, and where reading goes on after a mistake.

use super::{Attempt, Parser, Reported, refuse};
use crate::ast::{Declarator, Expr, ExprKind, Name, Stmt, StmtKind};
use crate::code;
use crate::diagnostic::{Diagnostic, Span};
use crate::lex::Tok;

impl Parser<'_> {
    /// All statements to the end of the text.
    pub(super) fn statements(&mut self) -> Vec<Stmt> {
        let mut statements = Vec::new();
        while !self.ended() {
            if self.eat(";").is_some() {
                continue;
            }
            let (first, span) = (self.at, self.span());
            let kind = self.statement().unwrap_or(StmtKind::Error);
            let failed = kind == StmtKind::Error;
            statements.push(Stmt { kind, span: span.to(self.last_span()) });
            // An opening word that was reported has been skipped with all that belongs to it.
            if failed && !self.at_boundary(first) {
                self.skip_statement(first);
            }
        }
        statements
    }

    /// Whether the reader stands where a statement ended.
    fn at_boundary(&self, first: usize) -> bool {
        self.at > first && (self.ended() || self.newline() || self.at_behind(";") || self.at_behind("}"))
    }

    /// Whether the token before is this symbol.
    fn at_behind(&self, symbol: &str) -> bool {
        let before = self.at.checked_sub(1).and_then(|i| self.tokens.get(i));
        before.is_some_and(|t| matches!(t.kind, Tok::Symbol(s) if s == symbol))
    }

    /// Skips what is left of a statement that started at token `first`: to behind its semicolon or to the next
    /// line. Takes at least one token.
    fn skip_statement(&mut self, first: usize) {
        while !self.ended() {
            if self.at > first && self.newline() {
                return;
            }
            if self.eat(";").is_some() {
                return;
            }
            self.skip_group();
        }
    }

    /// One statement with its end.
    fn statement(&mut self) -> Attempt<StmtKind> {
        if let Some(report) = self.statement_keyword() {
            let declares = ["const", "let", "var"].iter().any(|w| self.is_word(w));
            if !declares {
                self.diagnostics.push(report);
                let named = self.function_name();
                self.skip_construct();
                return named.ok_or(Reported);
            }
            return self.declaration();
        }
        if self.is("{") {
            let report = refuse::symbol("{", self.span());
            self.diagnostics.extend(report);
            self.skip_group();
            return Err(Reported);
        }
        let expr = self.assignment()?;
        self.end_of_statement(expr.span)?;
        Ok(StmtKind::Expr(expr))
    }

    /// The finding for a word that opens a statement, when an expression is wanted.
    pub(super) fn statement_keyword(&self) -> Option<Diagnostic> {
        let Tok::Word(word) = self.peek() else { return None };
        match word.as_str() {
            "const" | "let" | "var" => Some(
                Diagnostic::error(code::EXPRESSION_ONLY, self.span(), format!("`{word}` declares a name, but only one value is read here"))
                    .why("this text is an expression: it gives a value and changes nothing")
                    .help("write the expression in one piece, or compute the part in `controller` and keep it in `ctx`"),
            ),
            "if" | "for" | "while" | "do" | "switch" | "try" | "function" | "class" | "with" | "return" | "throw"
            | "break" | "continue" | "import" | "export" | "debugger" | "else" | "case" | "default" | "catch"
            | "finally" | "async" => refuse::word(word, self.span()),
            _ => None,
        }
    }

    /// Skips a refused statement with its header, its body and what hangs on it (`else`, `catch`).
    fn skip_construct(&mut self) {
        loop {
            let opener = match self.peek() {
                Tok::Word(word) => word.clone(),
                _ => return,
            };
            self.bump();
            match opener.as_str() {
                "function" | "class" | "async" => {
                    while !self.ended() && !self.is("{") && !self.is(";") {
                        self.skip_group();
                    }
                }
                "if" | "for" | "while" | "switch" | "with" | "catch" if self.is("(") => self.skip_group(),
                _ => {}
            }
            if self.statement_keyword().is_some() {
                continue;
            }
            if self.is("{") {
                self.skip_group();
            } else if !self.at_behind(";") {
                let first = self.at;
                if !self.ended() {
                    self.skip_statement(first);
                }
            }
            let hangs_on = ["else", "catch", "finally"].iter().any(|w| self.is_word(w));
            if !(hangs_on || opener == "do" && self.is_word("while")) {
                return;
            }
        }
    }

    /// The declaration that stands for `function name` or `class name`, so that uses of the name are not mistakes
    /// of their own.
    fn function_name(&self) -> Option<StmtKind> {
        let opener = self.is_word("function") || self.is_word("class");
        let (Tok::Word(text), true) = (self.peek_at(1), opener) else { return None };
        let span = self.tokens.get(self.at + 1)?.span;
        let value = Some(Expr { kind: ExprKind::Error, span });
        let declarators = vec![Declarator { name: Name { text: text.clone(), span }, value }];
        Some(StmtKind::Declare { constant: true, declarators })
    }

    /// `const a = 1, b = 2`
    fn declaration(&mut self) -> Attempt<StmtKind> {
        let first = self.at;
        let constant = self.is_word("const");
        if self.is_word("var") {
            let report = refuse::var(self.span());
            self.diagnostics.push(report);
        }
        let opener = self.bump();
        let mut declarators = Vec::new();
        loop {
            let declarator = self.declarator(constant, opener)?;
            let failed = matches!(&declarator.value, Some(e) if e.kind == ExprKind::Error);
            declarators.push(declarator);
            if failed && !self.is(",") {
                // The name is kept, so that its uses are not mistakes of their own.
                if !self.at_boundary(first) {
                    self.skip_statement(first);
                }
                return Ok(StmtKind::Declare { constant, declarators });
            }
            if self.eat(",").is_none() {
                break;
            }
        }
        let span = opener.to(self.last_span());
        self.end_of_statement(span)?;
        Ok(StmtKind::Declare { constant, declarators })
    }

    fn declarator(&mut self, constant: bool, opener: Span) -> Attempt<Declarator> {
        let span = self.span();
        let text = match self.peek() {
            Tok::Word(word) => word.clone(),
            Tok::Symbol("{" | "[") => return self.refuse(refuse::pattern(span)),
            Tok::Bad => return Err(Reported),
            _ => {
                let report = Diagnostic::error(
                    code::UNEXPECTED,
                    span,
                    format!("expected a name, found {}", self.shown()),
                )
                .why(format!("`{}` declares a name", opener.text(self.source)))
                .help("write `const angle = data.qpos[0]`");
                return self.refuse(report);
            }
        };
        let reserved = matches!(text.as_str(), "true" | "false" | "null" | "const" | "let" | "var");
        if reserved || refuse::word(&text, span).is_some() {
            let report = Diagnostic::error(
                code::NAME_TAKEN,
                span,
                format!("`{text}` is a word of the language, not a name"),
            )
            .help("choose another name");
            return self.refuse(report);
        }
        self.bump();
        let unread = Expr { kind: ExprKind::Error, span };
        let value = self.eat("=").map(|_| self.assignment().unwrap_or(unread));
        if constant && value.is_none() {
            let report = Diagnostic::error(
                code::UNEXPECTED,
                span,
                format!("`{text}` is declared with `const` but gets no value"),
            )
            .why("a `const` name never changes, so it needs its value at once")
            .help(format!("write `const {text} = …`, or `let {text}` when it gets its value later"));
            return self.refuse(report);
        }
        Ok(Declarator { name: Name { text, span }, value })
    }

    /// A semicolon, a line end or the end of the text.
    fn end_of_statement(&mut self, statement: Span) -> Attempt<()> {
        if self.eat(";").is_some() || self.ended() || self.newline() {
            return Ok(());
        }
        let report = self.unexpected_behind(statement);
        self.diagnostics.extend(report);
        Err(Reported)
    }

    /// The finding for whatever stands behind something complete; `None` when it is already reported.
    pub(super) fn unexpected_behind(&mut self, before: Span) -> Option<Diagnostic> {
        let span = self.span();
        let shown = self.shown();
        match self.peek() {
            Tok::Bad => None,
            Tok::Symbol(",") => {
                let decimal = self.decimal_comma();
                if let Some((number, _)) = &decimal {
                    // `02` behind the comma is not a number of its own.
                    self.diagnostics.retain(|d| d.span.start < number.start || d.span.end > number.end);
                }
                Some(refuse::comma(span, decimal))
            }
            Tok::Symbol(closer @ (")" | "]" | "}")) => Some(
                Diagnostic::error(code::UNEXPECTED, span, format!("`{closer}` closes nothing"))
                    .why("no bracket is open here")
                    .help("remove it, or write the bracket that it should close")
                    .fix(span, ""),
            ),
            Tok::Symbol(":") => Some(
                Diagnostic::error(code::UNEXPECTED, span, "`:` without a `?` before it")
                    .help("a choice is written `test ? a : b`"),
            ),
            Tok::Symbol(text) if refuse::symbol(text, span).is_some() && *text != "/" => {
                refuse::symbol(text, span)
            }
            Tok::Symbol(text) => Some(
                Diagnostic::error(code::UNEXPECTED, span, format!("`{text}` has no place here"))
                    .help("remove it"),
            ),
            Tok::Template => Some(refuse::template(span)),
            Tok::Word(word) if matches!(word.as_str(), "in" | "instanceof") => refuse::word(word, span),
            _ => {
                let left = shorten(before.text(self.source));
                Some(
                    Diagnostic::error(code::UNEXPECTED, span, format!("{shown} stands directly behind `{left}`"))
                        .why("there is no operator between them, so it is neither one expression nor two statements")
                        .help("write the operator, as `*` for a product, or a `;` or a line end between statements"),
                )
            }
        }
    }

    /// When the comma ahead stands between digits without a space, as in `0,5`: the place and the number meant.
    fn decimal_comma(&self) -> Option<(Span, String)> {
        let before = self.at.checked_sub(1).and_then(|i| self.tokens.get(i))?;
        let behind = self.tokens.get(self.at + 1)?;
        let numbers = matches!((&before.kind, &behind.kind), (Tok::Number(_), Tok::Number(_)));
        let whole = before.span.text(self.source);
        let fraction = behind.span.text(self.source);
        let plain = |s: &str| s.chars().all(|c| c.is_ascii_digit());
        let close = before.span.end + 1 == behind.span.start;
        (numbers && close && plain(whole) && plain(fraction))
            .then(|| (before.span.to(behind.span), format!("{whole}.{fraction}")))
    }
}

/// The last part of a long text.
fn shorten(text: &str) -> String {
    let count = text.chars().count();
    if count <= 30 {
        return text.to_owned();
    }
    let tail: String = text.chars().skip(count - 29).collect();
    format!("…{tail}")
}
