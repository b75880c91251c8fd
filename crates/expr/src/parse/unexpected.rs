//! Findings about tokens that are not allowed where they are.

use super::parser::Parser;
use super::refuse;
use crate::lex::TokenKind;
use crate::rules;
use labspec_finding::{Finding, Span};

impl Parser<'_> {
    /// The finding for a keyword of a statement where an expression is expected.
    pub(super) fn statement_keyword(&self) -> Option<Finding> {
        let TokenKind::Word(word) = self.peek() else { return None };
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
                    self.host_terms.keeper
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
                    self.host_terms.keeper
                )),
            ),
            "switch" | "try" | "class" | "with" | "throw" | "import" | "export" | "debugger" | "else"
            | "case" | "default" | "catch" | "finally" | "async" => {
                refuse::word(word, self.span(), self.host_terms)
            }
            _ => None,
        }
    }

    /// The finding for a token after something complete, or `None` if it is already reported.
    pub(super) fn unexpected_after(&mut self, before: Span) -> Option<Finding> {
        let span = self.span();
        let token = self.describe_token();
        match self.peek() {
            TokenKind::Bad => None,
            TokenKind::Symbol(",") => {
                let decimal = self.decimal_comma();
                Some(refuse::comma(span, decimal))
            }
            TokenKind::Symbol(closer @ (")" | "]" | "}")) => Some(
                Finding::error(rules::UNOPENED, span, format!("`{closer}` closes nothing"))
                    .why("no bracket is open here")
                    .help("remove it, or write the bracket that it should close")
                    .guess(span, ""),
            ),
            TokenKind::Symbol(":") => Some(
                Finding::error(rules::HALF_CHOICE, span, "this `:` has no `?` before it")
                    .help("write a conditional expression as `test ? a : b`"),
            ),
            TokenKind::Symbol(text)
                if refuse::symbol(text, span, self.host_terms).is_some() && *text != "/" =>
            {
                refuse::symbol(text, span, self.host_terms)
            }
            TokenKind::Symbol(text) => Some(
                Finding::error(rules::MISPLACED, span, format!("`{text}` is not allowed here"))
                    .help("remove it"),
            ),
            TokenKind::Word(word) if matches!(*word, "in" | "instanceof") => {
                refuse::word(word, span, self.host_terms)
            }
            TokenKind::Word(word) if self.python_word(word, before.text(self.source)).is_some() => {
                self.python_word(word, before.text(self.source))
            }
            _ => {
                let left = shorten(before.text(self.source));
                Some(
                    Finding::error(rules::MISSING_OPERATOR, span, format!("{token} directly follows `{left}` without an operator"))
                        .why("the operation between them is unknown")
                        .help("add the missing part: an operator, as `*` for a product, a comma in a list, or `;` between statements"),
                )
            }
        }
    }

    /// If the next comma is between digits without a space, as in `0,5`: its span and the intended number.
    pub(super) fn decimal_comma(&self) -> Option<(Span, String)> {
        let before = self.position.checked_sub(1).and_then(|i| self.tokens.get(i))?;
        let behind = self.tokens.get(self.position + 1)?;
        let numbers = matches!((&before.kind, &behind.kind), (TokenKind::Number(_), TokenKind::Number(_)));
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
