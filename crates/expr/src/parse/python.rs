//! Operators of Python, which authors write by habit. They are reported and parsed as those of JavaScript.

use super::node::{ExprNode, infix};
use super::parser::{Attempt, Parser};
use crate::ast::{ExprKind, UnaryOp};
use crate::lex::TokenKind;
use crate::rules;
use labspec_finding::{Finding, Span};

/// The binding power of the operand of `not`: comparisons bind more tightly.
const COMPARISON: u8 = 8;

/// The finding for a construct of Python.
fn python(span: Span, what: &str) -> Finding {
    Finding::error(rules::NOT_IN_LANGUAGE, span, format!("{what} is not in this language"))
        .why("it is an operator of Python; a text of a lab is JavaScript")
}

impl Parser<'_> {
    /// The operator of JavaScript for `and` and `or` after a value on the same line.
    fn python_operator(&self) -> Option<(&'static str, &'static str)> {
        match self.peek() {
            _ if self.newline() => None,
            TokenKind::Word("and") => Some(("and", "&&")),
            TokenKind::Word("or") => Some(("or", "||")),
            _ => None,
        }
    }

    /// Parses `left and right` as `left && right`. Returns `left` unchanged if there is no such operator, or if it binds less
    /// tightly than `power`.
    pub(super) fn python_infix(&mut self, left: ExprNode, power: u8) -> Attempt<(ExprNode, bool)> {
        let Some((word, symbol)) = self.python_operator() else { return Ok((left, false)) };
        let Some((operator, binds)) = infix(symbol).filter(|(_, binds)| *binds >= power) else {
            return Ok((left, false));
        };
        let span = self.span();
        let report = python(span, &format!("`{word}`")).help(format!("write `{symbol}`")).guess(span, symbol);
        self.diagnostics.push(report);
        Ok((self.binary(left.whole_chain(), operator, binds)?, true))
    }

    /// Whether the next token is the operator `not` before an operand.
    pub(super) fn is_python_not(&self) -> bool {
        let after = self.source.get(self.span().end..).unwrap_or("");
        let is_operand = match self.peek_at(1) {
            TokenKind::Word(word) => !matches!(*word, "and" | "or" | "in" | "is" | "instanceof"),
            TokenKind::Number(_) => true,
            TokenKind::Symbol("(") => after.starts_with(' '),
            _ => false,
        };
        matches!(self.peek(), TokenKind::Word("not"))
            && is_operand
            && !after.trim_start_matches(' ').starts_with('\n')
    }

    /// Parses `not operand` as `!(operand)`.
    pub(super) fn python_not(&mut self) -> Attempt<ExprNode> {
        let word = self.bump();
        let operand = self.expression(COMPARISON)?;
        let text = operand.expr.span.text(self.source);
        let needs_brackets = matches!(operand.expr.kind, ExprKind::Binary { .. } | ExprKind::Logical { .. })
            && !operand.closed;
        let meant = if needs_brackets { format!("!({text})") } else { format!("!{text}") };
        let span = word.to(operand.expr.span);
        let report = python(word, "`not`").help(format!("write `{meant}`")).guess(span, meant);
        self.diagnostics.push(report);
        self.node(ExprKind::Unary { op: UnaryOp::Not, operand: Box::new(operand.expr) }, span, operand.height)
    }

    /// The finding for another word of Python after a value.
    pub(super) fn python_word(&self, word: &str, before: &str) -> Option<Finding> {
        let span = self.span();
        Some(match (word, before) {
            ("is", _) => match self.peek_at(1) {
                TokenKind::Word("not") => python(span, "`is not`").help("write `!==`"),
                _ => python(span, "`is`").help("write `===`").guess(span, "==="),
            },
            ("not", _) => python(span, "`not in`").help("write `!list.includes(x)`"),
            ("if", _) => python(span, "`a if test else b`").help("write `test ? a : b`"),
            ("for", _) => python(span, "a comprehension").help("write `list.map((x) => …)`"),
            (_, "def") => python(span, "`def`").help(format!("write `const {word} = (x) => …`")),
            (_, "lambda") => python(span, "`lambda`").help(format!("write `({word}) => …`")),
            _ => return None,
        })
    }
}
