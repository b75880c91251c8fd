//! Recovery after errors.

use super::parser::Parser;
use crate::ast::{Stmt, StmtKind};
use crate::lex::TokenKind;

impl Parser<'_> {
    /// Parses a statement. An invalid statement is skipped, and [`StmtKind::Error`] takes its place.
    pub(super) fn recovered(&mut self, closer: &str) -> Stmt {
        let (first, span) = (self.position, self.span());
        let kind = self.statement().unwrap_or(StmtKind::Error);
        let failed = kind == StmtKind::Error;
        let stmt = Stmt { kind, span: span.to(self.last_span()) };
        // If a keyword was refused, its whole construct has already been skipped.
        if failed && !self.at_boundary(first) {
            self.skip_statement(first, closer);
        }
        stmt
    }

    /// Whether the parser is at the end of a statement.
    pub(super) fn at_boundary(&self, first: usize) -> bool {
        self.position > first
            && (self.ended() || self.newline() || self.previous_is(";") || self.previous_is("}"))
    }

    /// Whether the previous token is this symbol.
    fn previous_is(&self, symbol: &str) -> bool {
        let before = self.position.checked_sub(1).and_then(|i| self.tokens.get(i));
        before.is_some_and(|t| matches!(t.kind, TokenKind::Symbol(s) if s == symbol))
    }

    /// Skips the rest of a statement that started at token `first`: past its semicolon, to the next line, or to the end of the
    /// block. Consumes at least one token, unless the block ends.
    pub(super) fn skip_statement(&mut self, first: usize, closer: &str) {
        while !self.ended() && !self.is(closer) {
            if self.position > first && self.newline() {
                return;
            }
            if self.consume(";").is_some() {
                return;
            }
            self.skip_group();
        }
    }

    /// Skips a refused statement with its header, its body and its continuations (`else`, `catch`).
    pub(super) fn skip_construct(&mut self) {
        loop {
            let opener = match self.peek() {
                TokenKind::Word(word) => *word,
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
            } else if !self.previous_is(";") {
                let first = self.position;
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
}
