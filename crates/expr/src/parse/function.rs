//! Functions of a source text, and destructuring patterns.

use super::node::{ASSIGNMENT, ExprNode};
use super::parser::{Attempt, MAX_DEPTH, Parser, Reported};
use super::refuse;
use crate::ast::{Body, Element, ExprKind, Function, Name, Pattern, Stmt, StmtKind};
use crate::lex::TokenKind;
use crate::rules;
use labspec_finding::{Finding, Span};

/// The maximum number of parameters of a function.
const MAX_PARAMS: usize = 16;

impl Parser<'_> {
    /// Whether the following parentheses contain the parameters of an arrow function: `=>` comes after them.
    pub(super) fn is_arrow_function(&self) -> bool {
        *self.peek_at(self.after_group(0)) == TokenKind::Symbol("=>")
    }

    /// The number of tokens up to the one that follows token `n`, or that follows the whole bracket that token `n` opens.
    pub(super) fn after_group(&self, n: usize) -> usize {
        let mut open = 0usize;
        // An unlimited search from every bracket of a malicious text would take quadratic time. No list of
        // parameters is this long.
        for n in n..n + 200 {
            match self.peek_at(n) {
                TokenKind::Symbol("(" | "[" | "{") => open += 1,
                TokenKind::Symbol(")" | "]" | "}") => open = open.saturating_sub(1),
                TokenKind::End => break,
                _ => {}
            }
            if open == 0 {
                return n + 1;
            }
        }
        usize::MAX / 2
    }

    /// Parses `x => …` or `(x, y) => …`.
    pub(super) fn arrow(&mut self) -> Attempt<ExprNode> {
        let start = self.span();
        let (function, height) = self.measured(|p| {
            let params = match p.consume("(") {
                Some(opener) => p.parameters(opener)?,
                None => vec![Element { target: Pattern::Name(p.new_name("a parameter")?), default: None }],
            };
            p.consume("=>");
            let body = if p.is("{") { Body::Block(p.block()?) } else { Body::Value(p.assignment()?) };
            Ok(Function { name: None, params, body, span: start.to(p.last_span()) })
        });
        self.function_node(function?, height)
    }

    /// Parses `function (x) { … }` as a value.
    pub(super) fn function_expression(&mut self) -> Attempt<ExprNode> {
        let (function, height) = self.measured(|p| {
            let (name, function) = p.function()?;
            Ok(Function { name, ..function })
        });
        self.function_node(function?, height)
    }

    fn function_node(&mut self, function: Function, height: usize) -> Attempt<ExprNode> {
        let span = function.span;
        self.node(ExprKind::Function(Box::new(function)), span, height)
    }

    /// Parses `function name(x) { … }` as a declaration.
    pub(super) fn function_declaration(&mut self) -> Attempt<StmtKind> {
        let place = self.span();
        let (name, function) = self.function()?;
        let Some(name) = name else {
            let report = Finding::error(rules::MISSING_NAME, place, "this function has no name")
                .why("a function declaration can only be called by its name")
                .help("write `function name(x) { … }`, or `const name = (x) => …`");
            return self.refuse(report);
        };
        Ok(StmtKind::Function { name, function: Box::new(function) })
    }

    /// Parses a function, from `function` to the end of its body.
    fn function(&mut self) -> Attempt<(Option<Name>, Function)> {
        let start = self.bump();
        if self.is("*") {
            let span = self.span();
            return self.refuse(refuse::member_function(span));
        }
        let name = match self.peek() {
            TokenKind::Word(_) => Some(self.new_name("the name of the function")?),
            _ => None,
        };
        let Some(opener) = self.consume("(") else {
            let report = Finding::error(
                rules::MISSING_BRACKET,
                self.span(),
                format!("expected `(`, found {}", self.describe_token()),
            )
            .help("write the parameters in parentheses, as `function f(x) { … }`");
            return self.refuse(report);
        };
        let params = self.parameters(opener)?;
        if !self.is("{") {
            let report = Finding::error(
                rules::MISSING_BRACKET,
                self.span(),
                format!("expected `{{`, found {}", self.describe_token()),
            )
            .help("write what the function does in braces, as `function f(x) { return 2 * x }`");
            return self.refuse(report);
        }
        let body = Body::Block(self.block()?);
        Ok((name, Function { name: None, params, body, span: start.to(self.last_span()) }))
    }

    /// Parses parameters after their opening parenthesis, including the closing one.
    fn parameters(&mut self, opener: Span) -> Attempt<Vec<Element>> {
        let mut params = Vec::new();
        while self.consume(")").is_none() {
            if self.is("...") {
                let span = self.span();
                return self.refuse(refuse::rest(span));
            }
            params.push(self.element()?);
            if self.consume(",").is_some() || self.is(")") {
                continue;
            }
            let last = self.last_span();
            let report = self.unclosed(opener, ")", last);
            self.diagnostics.extend(report);
            return Err(Reported);
        }
        if params.len() > MAX_PARAMS {
            let span = opener.to(self.last_span());
            let message = format!("this function has {} parameters", params.len());
            let report = Finding::error(rules::ARGUMENT_COUNT, span, message)
                .why(format!("at most {MAX_PARAMS} are allowed"))
                .help("pass a list or a record");
            return self.refuse(report);
        }
        Ok(params)
    }

    /// Parses `name`, `[a, b]` or `{a, b}`, with or without `= default`.
    fn element(&mut self) -> Attempt<Element> {
        let target = self.pattern("a parameter")?;
        let default = match self.consume("=") {
            Some(_) => Some(self.expression(ASSIGNMENT)?.expr),
            None => None,
        };
        Ok(Element { target, default })
    }

    /// Parses the target of a declaration.
    pub(super) fn pattern(&mut self, what: &str) -> Attempt<Pattern> {
        if self.depth >= MAX_DEPTH {
            let span = self.span();
            return self.too_deep(span);
        }
        self.depth += 1;
        let pattern = match self.peek() {
            TokenKind::Symbol("[") => self.list_pattern(),
            TokenKind::Symbol("{") => self.record_pattern(),
            _ => self.new_name(what).map(Pattern::Name),
        };
        self.depth -= 1;
        pattern
    }

    fn list_pattern(&mut self) -> Attempt<Pattern> {
        let opener = self.bump();
        let mut items = Vec::new();
        loop {
            if let Some(closer) = self.consume("]") {
                return Ok(Pattern::List { items, span: opener.to(closer) });
            }
            if self.consume(",").is_some() {
                items.push(None);
                continue;
            }
            if self.is("...") {
                let span = self.span();
                return self.refuse(refuse::rest(span));
            }
            items.push(Some(self.element()?));
            if self.consume(",").is_none() && !self.is("]") {
                let last = self.last_span();
                let report = self.unclosed(opener, "]", last);
                self.diagnostics.extend(report);
                return Err(Reported);
            }
        }
    }

    fn record_pattern(&mut self) -> Attempt<Pattern> {
        let opener = self.bump();
        let mut entries = Vec::new();
        loop {
            if let Some(closer) = self.consume("}") {
                return Ok(Pattern::Record { entries, span: opener.to(closer) });
            }
            if self.is("...") {
                let span = self.span();
                return self.refuse(refuse::rest(span));
            }
            let span = self.span();
            let TokenKind::Word(text) = self.peek() else {
                let report = Finding::error(
                    rules::MISSING_NAME,
                    span,
                    format!("expected a key, found {}", self.describe_token()),
                )
                .help(format!("write the keys to take, as `const {}`", self.host_terms.parts));
                return self.refuse(report);
            };
            let key = Name { text: (*text).to_owned(), span };
            let renamed = *self.peek_at(1) == TokenKind::Symbol(":");
            let element = if renamed {
                self.bump();
                self.bump();
                self.element()?
            } else {
                self.element()?
            };
            entries.push((key, element));
            if self.consume(",").is_none() && !self.is("}") {
                let last = self.last_span();
                let report = self.unclosed(opener, "}", last);
                self.diagnostics.extend(report);
                return Err(Reported);
            }
        }
    }

    /// Parses a name that is being declared.
    fn new_name(&mut self, what: &str) -> Attempt<Name> {
        let span = self.span();
        let text = match self.peek() {
            TokenKind::Word(word) => (*word).to_owned(),
            TokenKind::Bad => return Err(Reported),
            _ => {
                let report = Finding::error(
                    rules::MISSING_NAME,
                    span,
                    format!("expected {what}, found {}", self.describe_token()),
                )
                .help("write a name, as `angle`");
                return self.refuse(report);
            }
        };
        if refuse::is_reserved(&text) {
            let report =
                Finding::error(rules::NAME_TAKEN, span, format!("`{text}` is a keyword, not a name"))
                    .help("choose another name");
            return self.refuse(report);
        }
        self.bump();
        Ok(Name { text, span })
    }

    /// Parses `{ … }` as statements.
    pub(super) fn block(&mut self) -> Attempt<Vec<Stmt>> {
        let opener = self.bump();
        let statements = self.statements_up_to("}");
        if self.consume("}").is_none() {
            let report = Finding::error(rules::UNCLOSED, opener, "this `{` is not closed")
                .why("everything after it is part of the block")
                .help("write `}` where the block ends");
            return self.refuse(report);
        }
        Ok(statements)
    }
}
