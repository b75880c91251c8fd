//! Bracketed parts, and findings about missing brackets and values.

use super::node::{ASSIGNMENT, ExprNode, error_node, infix};
use super::parser::{Attempt, Parser, Reported};
use crate::ast::{Expr, ExprKind};
use crate::lex::TokenKind;
use crate::rules;
use labspec_finding::{Finding, Span};

impl Parser<'_> {
    /// Parses one expression and its closing bracket; after an error, skips to the bracket.
    pub(super) fn enclosed(&mut self, opener: Span, closer: &str, power: u8) -> Attempt<(ExprNode, Span)> {
        if self.is(closer) {
            let span = opener.to(self.bump());
            let what = if closer == "]" { "an index" } else { "an expression" };
            let report =
                Finding::error(rules::MISSING_VALUE, span, format!("{what} is missing between the brackets"))
                    .help(if closer == "]" {
                        "write the index, as `[0]`"
                    } else {
                        "write the expression, or remove the brackets"
                    });
            self.diagnostics.push(report);
            return Ok((error_node(span), span));
        }
        let inner = match self.expression(power) {
            Ok(inner) => inner,
            Err(Reported) => {
                let span = self.span();
                if !self.skip_to(&[closer]) {
                    return Err(Reported);
                }
                error_node(span)
            }
        };
        if let Some(end) = self.consume(closer) {
            return Ok((inner, end));
        }
        let report = self.unclosed(opener, closer, inner.expr.span);
        self.diagnostics.extend(report);
        if self.skip_to(&[closer]) { Ok((inner, self.bump())) } else { Err(Reported) }
    }

    /// Parses comma-separated expressions and their closing bracket; after an error, skips to the next comma.
    pub(super) fn list(&mut self, opener: Span, closer: &str) -> Attempt<(Vec<Expr>, usize, Span)> {
        let mut items = Vec::new();
        let mut height = 0;
        loop {
            if let Some(end) = self.consume(closer) {
                return Ok((items, height, end)); // also after a trailing comma, as in JavaScript
            }
            let span = self.span();
            let item = match self.item() {
                Ok(item) => item,
                Err(Reported) if self.skip_to(&[",", closer]) => error_node(span),
                Err(Reported) => return Err(Reported),
            };
            height = height.max(item.height);
            let last = item.expr.span;
            items.push(item.expr);
            if self.consume(",").is_some() || self.is(closer) {
                continue;
            }
            let report = self.unclosed(opener, closer, last);
            self.diagnostics.extend(report);
            if !self.skip_to(&[",", closer]) {
                return Err(Reported);
            }
            self.consume(",");
        }
    }

    /// Parses an item or an argument, possibly a spread.
    pub(super) fn item(&mut self) -> Attempt<ExprNode> {
        let Some(dots) = self.consume("...") else { return self.expression(ASSIGNMENT) };
        let value = self.expression(ASSIGNMENT)?;
        let span = dots.to(value.expr.span);
        self.node(ExprKind::Spread(Box::new(value.expr)), span, value.height)
    }

    /// The finding for another token where a bracket must close.
    pub(super) fn unclosed(&mut self, opener: Span, closer: &str, before: Span) -> Option<Finding> {
        // An index contains no assignment, so `=` shows that the bracket should have been closed before it.
        let ends = self.ended() || matches!(self.peek(), TokenKind::Symbol(";" | ")" | "]" | "}" | "="));
        if !ends {
            return self.unexpected_after(before);
        }
        let open = opener.text(self.source);
        Some(
            Finding::error(rules::UNCLOSED, opener, format!("this `{open}` is not closed"))
                .why(format!("found {} where `{closer}` is required", self.describe_token()))
                .help(format!("write `{closer}` after `{}`", before.text(self.source)))
                .guess(before.after(), closer),
        )
    }

    /// Reports that a value is missing.
    pub(super) fn expected_value<T>(&mut self) -> Attempt<T> {
        let span = self.span();
        let before = self.last_span().text(self.source);
        let message = format!("expected a value, found {}", self.describe_token());
        let mut report = Finding::error(rules::MISSING_VALUE, span, message);
        if !before.is_empty() && self.position > 0 {
            report = report.why(format!("`{before}` needs a value after it"));
        }
        report = match self.peek() {
            // `a = == b`, `a * * b`: two consecutive operators.
            TokenKind::Symbol(symbol) if infix(symbol).is_some() && before.is_empty() => {
                report.help(format!("write the value before `{symbol}`, or remove it"))
            }
            TokenKind::Symbol(symbol) if infix(symbol).is_some() => report.help(format!(
                "remove one of the operators, or write the value between `{before}` and `{symbol}`"
            )),
            _ => report.help(format!(
                "write a number, a name such as `{}`, or an expression in parentheses",
                self.host_terms.number
            )),
        };
        self.refuse(report)
    }
}
