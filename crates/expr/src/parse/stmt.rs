//! Statements, automatic semicolons, and where reading goes on after a mistake.

use super::parser::{Attempt, MAX_DEPTH, Parser, Reported};
use super::refuse;
use crate::ast::{Declarator, Expr, ExprKind, Name, Pattern, Stmt, StmtKind};
use crate::lex::Tok;
use crate::rules;
use labspec_finding::{Finding, Span};

impl Parser<'_> {
    /// All statements to the end of the text.
    pub(super) fn statements(&mut self) -> Vec<Stmt> {
        let mut statements = self.statements_up_to("");
        while !self.ended() {
            // A closing bracket that nothing opened: reported, and passed over.
            statements.extend(self.statements_up_to(""));
        }
        statements
    }

    /// Statements up to a closing symbol, which is left, or to the end of the text.
    pub(super) fn statements_up_to(&mut self, closer: &str) -> Vec<Stmt> {
        let mut statements = Vec::new();
        while !self.ended() && !self.is(closer) {
            if self.eat(";").is_some() {
                continue;
            }
            statements.push(self.recovered(closer));
        }
        statements
    }

    /// A statement, or the mark of one that could not be read and has been skipped.
    fn recovered(&mut self, closer: &str) -> Stmt {
        let (first, span) = (self.at, self.span());
        let kind = self.statement().unwrap_or(StmtKind::Error);
        let failed = kind == StmtKind::Error;
        let stmt = Stmt { kind, span: span.to(self.last_span()) };
        // An opening word that was reported has been skipped with all that belongs to it.
        if failed && !self.at_boundary(first) {
            self.skip_statement(first, closer);
        }
        stmt
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

    /// Skips what is left of a statement that started at token `first`: to behind its semicolon, to the next
    /// line, or to the end of the block. Takes at least one token, except there.
    fn skip_statement(&mut self, first: usize, closer: &str) {
        while !self.ended() && !self.is(closer) {
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
            Tok::Word(word) => *word,
            Tok::Symbol("{") => return self.block().map(StmtKind::Block),
            Tok::Symbol(")" | "]" | "}") => {
                let report = self.unexpected_behind(Span::default());
                self.diagnostics.extend(report);
                return Err(Reported);
            }
            _ => return self.expression_statement(),
        };
        match word {
            "const" | "let" | "var" => self.declaration(),
            "if" => self.condition(),
            "for" => self.for_loop(),
            "while" => {
                self.bump();
                let test = self.head("while")?;
                let body = Box::new(self.body("while")?);
                Ok(StmtKind::While { test, body })
            }
            "do" => {
                self.bump();
                let body = Box::new(self.body("do")?);
                if !self.is_word("while") {
                    let report =
                        Finding::error(rules::DO_WITHOUT_WHILE, self.span(), "a `do` loop has no `while`")
                            .help("write `do { … } while (test)`");
                    return self.refuse(report);
                }
                self.bump();
                let test = self.head("while")?;
                self.eat(";");
                Ok(StmtKind::DoWhile { body, test })
            }
            "break" | "continue" => {
                let span = self.bump();
                if !self.newline() && matches!(self.peek(), Tok::Word(_)) {
                    let report = refuse::label(self.span());
                    return self.refuse(report);
                }
                self.end_of_statement(span)?;
                Ok(if word == "break" { StmtKind::Break } else { StmtKind::Continue })
            }
            "return" => {
                let span = self.bump();
                let bare = self.newline() || self.ended() || self.is(";") || self.is("}");
                let value = if bare { None } else { Some(self.assignment()?) };
                self.end_of_statement(span.to(self.last_span()))?;
                Ok(StmtKind::Return(value))
            }
            "function" => self.function_declaration(),
            _ if *self.peek_at(1) == Tok::Symbol(":") => {
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

    /// An expression for its effect, or several joined by commas.
    fn expression_statement(&mut self) -> Attempt<StmtKind> {
        let expr = self.sequence()?;
        self.end_of_statement(expr.span)?;
        Ok(StmtKind::Expr(expr))
    }

    fn sequence(&mut self) -> Attempt<Expr> {
        let first = self.assignment()?;
        if !self.is(",") || self.decimal_comma().is_some() {
            return Ok(first);
        }
        let mut parts = vec![first];
        while self.eat(",").is_some() {
            parts.push(self.assignment()?);
        }
        let span = parts.iter().map(|part| part.span).reduce(Span::to).unwrap_or_default();
        Ok(Expr { kind: ExprKind::Sequence(parts), span })
    }

    /// `(test)` behind `if` or `while`.
    fn head(&mut self, word: &str) -> Attempt<Expr> {
        let Some(opener) = self.eat("(") else {
            let report = Finding::error(
                rules::MISSING_BRACKET,
                self.span(),
                format!("expected `(` after `{word}`, found {}", self.shown()),
            )
            .help(format!("write the condition in parentheses, as `{word} ({} > 1)`", self.words.number));
            return self.refuse(report);
        };
        Ok(self.enclosed(opener, ")", 1)?.0.expr)
    }

    /// The statement that belongs to a condition or a loop.
    fn body(&mut self, word: &str) -> Attempt<Stmt> {
        let span = self.span();
        if self.eat(";").is_some() {
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
                format!("expected a statement after `{word}`, found {}", self.shown()),
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
        let Some(opener) = self.eat("(") else {
            let report = Finding::error(
                rules::MISSING_BRACKET,
                self.span(),
                format!("expected `(` after `for`, found {}", self.shown()),
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
            Tok::Symbol(";") => None,
            _ => {
                let span = self.span();
                let declares = ["const", "let", "var"].iter().any(|w| self.is_word(w));
                let kind = if declares { self.declarators()?.0 } else { StmtKind::Expr(self.sequence()?) };
                Some(Box::new(Stmt { kind, span: span.to(self.last_span()) }))
            }
        };
        self.separator()?;
        let test = if self.is(";") { None } else { Some(self.assignment()?) };
        self.separator()?;
        let update = if self.is(")") { None } else { Some(self.sequence()?) };
        if self.eat(")").is_none() {
            let last = self.last_span();
            let report = self.unclosed(opener, ")", last);
            self.diagnostics.extend(report);
            return Err(Reported);
        }
        let body = Box::new(self.body("for")?);
        Ok(StmtKind::For { init, test, update, body })
    }

    /// `const name of`, when that is what stands behind `for (`.
    fn for_of_head(&mut self) -> Attempt<Option<(bool, Pattern)>> {
        let declares = ["const", "let", "var"].iter().any(|w| self.is_word(w));
        let constant = self.is_word("const");
        let behind = self.behind_group(usize::from(declares));
        let of = |word: &str| matches!(self.peek_at(behind), Tok::Word(w) if *w == word);
        if !of("of") && !of("in") {
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

    /// A `;` in the head of a `for`.
    fn separator(&mut self) -> Attempt<()> {
        if self.eat(";").is_some() {
            return Ok(());
        }
        let report =
            Finding::error(rules::LOOP_HEAD, self.span(), format!("expected `;`, found {}", self.shown()))
                .why("the head of a `for` has three parts: start, condition, step")
                .help("write `for (let i = 0; i < n; i++) { … }`");
        self.refuse(report)
    }

    /// The finding for a word that opens a statement, when an expression is wanted.
    pub(super) fn statement_keyword(&self) -> Option<Finding> {
        let Tok::Word(word) = self.peek() else { return None };
        match *word {
            "const" | "let" | "var" => Some(
                Finding::error(
                    rules::EXPRESSION_ONLY,
                    self.span(),
                    format!("`{word}` declares a name, but only one value is read here"),
                )
                .why("this text is an expression, which returns a value and changes nothing")
                .help(format!(
                    "write a single expression, or compute the part in {} and store it in `ctx`",
                    self.words.keeper
                )),
            ),
            "if" | "for" | "while" | "do" | "return" | "break" | "continue" => Some(
                Finding::error(
                    rules::EXPRESSION_ONLY,
                    self.span(),
                    format!("`{word}` starts a statement, but only one value is read here"),
                )
                .why("this text is an expression, which returns a value and changes nothing")
                .help(format!(
                    "choose a value with `test ? a : b`, or compute it in {} and store it in `ctx`",
                    self.words.keeper
                )),
            ),
            "switch" | "try" | "class" | "with" | "throw" | "import" | "export" | "debugger" | "else"
            | "case" | "default" | "catch" | "finally" | "async" => {
                refuse::word(word, self.span(), self.words)
            }
            _ => None,
        }
    }

    /// Skips a refused statement with its header, its body and what hangs on it (`else`, `catch`).
    fn skip_construct(&mut self) {
        loop {
            let opener = match self.peek() {
                Tok::Word(word) => *word,
                _ => return,
            };
            self.bump();
            match opener {
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
                    self.skip_statement(first, "}");
                }
            }
            let hangs_on = ["else", "catch", "finally"].iter().any(|w| self.is_word(w));
            if !(hangs_on || opener == "do" && self.is_word("while")) {
                return;
            }
        }
    }

    /// The declaration that stands for `class name`, so that uses of the name are not mistakes of their own.
    fn class_name(&self) -> Option<StmtKind> {
        let (Tok::Word(text), true) = (self.peek_at(1), self.is_word("class")) else { return None };
        let span = self.tokens.get(self.at + 1)?.span;
        let value = Some(Expr { kind: ExprKind::Error, span });
        let target = Pattern::Name(Name { text: (*text).to_owned(), span });
        Some(StmtKind::Declare { constant: true, declarators: vec![Declarator { target, value }] })
    }

    /// `const a = 1, b = 2` with its end.
    fn declaration(&mut self) -> Attempt<StmtKind> {
        let (first, opener) = (self.at, self.span());
        let (kind, failed) = self.declarators()?;
        if failed {
            // The names are kept, so that their uses are not mistakes of their own.
            if !self.at_boundary(first) {
                self.skip_statement(first, "}");
            }
            return Ok(kind);
        }
        let span = opener.to(self.last_span());
        self.end_of_statement(span)?;
        Ok(kind)
    }

    /// `const a = 1, b = 2`, and whether the last value could not be read.
    fn declarators(&mut self) -> Attempt<(StmtKind, bool)> {
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
                return Ok((StmtKind::Declare { constant, declarators }, true));
            }
            if !self.is(",") || self.decimal_comma().is_some() {
                return Ok((StmtKind::Declare { constant, declarators }, false));
            }
            self.bump();
        }
    }

    fn declarator(&mut self, constant: bool, opener: Span) -> Attempt<Declarator> {
        let span = self.span();
        if !matches!(self.peek(), Tok::Word(_) | Tok::Bad | Tok::Symbol("[" | "{")) {
            let report =
                Finding::error(rules::MISSING_NAME, span, format!("expected a name, found {}", self.shown()))
                    .why(format!("`{}` declares a name", opener.text(self.source)))
                    .help(format!("write `const angle = {}[0]`", self.words.array));
            return self.refuse(report);
        }
        let target = self.pattern("a name")?;
        let unread = Expr { kind: ExprKind::Error, span };
        let value = self.eat("=").map(|_| self.assignment().unwrap_or(unread));
        if value.is_none() && (constant || !matches!(target, Pattern::Name(_))) {
            let text = target.span().text(self.source).to_owned();
            let word = opener.text(self.source);
            let report = Finding::error(
                rules::DECLARED_WITHOUT_VALUE,
                span,
                format!("`{text}` is declared with `{word}` but has no value"),
            );
            return self.refuse(match target {
                Pattern::Name(_) => report
                    .why("a `const` name can never change, so it needs its value at once")
                    .help(format!("write `const {text} = …`, or `let {text}` if it gets its value later")),
                _ => report
                    .why("there is nothing to take the parts from")
                    .help(format!("write `{word} {text} = …`")),
            });
        }
        Ok(Declarator { target, value })
    }

    /// A semicolon, a line end or the end of the text.
    fn end_of_statement(&mut self, statement: Span) -> Attempt<()> {
        if self.eat(";").is_some() || self.ended() || self.newline() || self.is("}") {
            return Ok(());
        }
        let report = self.unexpected_behind(statement);
        self.diagnostics.extend(report);
        Err(Reported)
    }

    /// The finding for whatever stands behind something complete; `None` when it is already reported.
    pub(super) fn unexpected_behind(&mut self, before: Span) -> Option<Finding> {
        let span = self.span();
        let shown = self.shown();
        match self.peek() {
            Tok::Bad => None,
            Tok::Symbol(",") => {
                let decimal = self.decimal_comma();
                Some(refuse::comma(span, decimal))
            }
            Tok::Symbol(closer @ (")" | "]" | "}")) => Some(
                Finding::error(rules::UNOPENED, span, format!("`{closer}` closes nothing"))
                    .why("no bracket is open here")
                    .help("remove it, or write the bracket that it should close")
                    .guess(span, ""),
            ),
            Tok::Symbol(":") => Some(
                Finding::error(rules::HALF_CHOICE, span, "this `:` has no `?` before it")
                    .help("write a conditional expression as `test ? a : b`"),
            ),
            Tok::Symbol(text) if refuse::symbol(text, span, self.words).is_some() && *text != "/" => {
                refuse::symbol(text, span, self.words)
            }
            Tok::Symbol(text) => Some(
                Finding::error(rules::MISPLACED, span, format!("`{text}` is not allowed here"))
                    .help("remove it"),
            ),
            Tok::Word(word) if matches!(*word, "in" | "instanceof") => refuse::word(word, span, self.words),
            _ => {
                let left = shorten(before.text(self.source));
                Some(
                    Finding::error(rules::MISSING_OPERATOR, span, format!("{shown} directly follows `{left}` without an operator"))
                        .why("the operation between them is unknown")
                        .help("add the missing part: an operator, as `*` for a product, a comma in a list, or `;` between statements"),
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
