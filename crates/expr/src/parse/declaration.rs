//! Declarations of names.

use super::parser::{Attempt, Parser};
use super::refuse;
use crate::ast::{Declarator, Expr, ExprKind, Name, Pattern, StmtKind};
use crate::lex::TokenKind;
use crate::rules;
use labspec_finding::{Finding, Span, distance};

impl Parser<'_> {
    /// A declaration in place of `class name`, so that uses of the name are not reported as further errors.
    pub(super) fn class_name(&self) -> Option<StmtKind> {
        let (TokenKind::Word(text), true) = (self.peek_at(1), self.is_word("class")) else { return None };
        let span = self.tokens.get(self.position + 1)?.span;
        let value = Some(Expr { kind: ExprKind::Error, span });
        let target = Pattern::Name(Name { text: (*text).to_owned(), span });
        Some(StmtKind::Declare { constant: true, declarators: vec![Declarator { target, value }] })
    }

    /// Reports a misspelt `const` or `let` before a name: `cosnt a = 1`. The declaration is parsed as if it were right.
    pub(super) fn reports_misspelt_declaration(&mut self) -> bool {
        let (TokenKind::Word(word), TokenKind::Word(_)) = (self.peek(), self.peek_at(1)) else {
            return false;
        };
        let word = *word;
        let Some(right) = ["const", "let"].into_iter().find(|right| distance(word, right) == 1) else {
            return false;
        };
        let span = self.span();
        self.diagnostics.push(
            Finding::error(rules::UNKNOWN_NAME, span, format!("unknown name `{word}`"))
                .help(format!("did you mean `{right}`?"))
                .guess(span, right),
        );
        true
    }

    /// Parses `const a = 1, b = 2` and the end of the statement.
    pub(super) fn declaration(&mut self) -> Attempt<StmtKind> {
        let (first, opener) = (self.position, self.span());
        let (kind, failed) = self.declarators()?;
        if failed {
            // The names are declared nevertheless, so that their uses are not reported as further errors.
            if !self.at_boundary(first) {
                self.skip_statement(first, "}");
            }
            return Ok(kind);
        }
        let span = opener.to(self.last_span());
        self.end_of_statement(span)?;
        Ok(kind)
    }

    /// Parses `const a = 1, b = 2`, and returns whether the last value could not be parsed.
    pub(super) fn declarators(&mut self) -> Attempt<(StmtKind, bool)> {
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

    pub(super) fn declarator(&mut self, constant: bool, opener: Span) -> Attempt<Declarator> {
        let span = self.span();
        if !matches!(self.peek(), TokenKind::Word(_) | TokenKind::Bad | TokenKind::Symbol("[" | "{")) {
            let report = Finding::error(
                rules::MISSING_NAME,
                span,
                format!("expected a name, found {}", self.describe_token()),
            )
            .why(format!("`{}` declares a name", opener.text(self.source)))
            .help(format!("write `const angle = {}[0]`", self.host_terms.array));
            return self.refuse(report);
        }
        let target = self.pattern("a name")?;
        let unread = Expr { kind: ExprKind::Error, span };
        let value = self.consume("=").map(|_| self.assignment().unwrap_or(unread));
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
}
