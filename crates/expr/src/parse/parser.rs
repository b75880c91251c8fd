//! The parser's state: its position, its findings, and the parsing of a whole text.

use crate::ast::{Expr, ExprKind, Stmt};
use crate::host_terms::HostTerms;
use crate::lex::{self, Token, TokenKind};
use crate::rules;
use labspec_finding::order;
use labspec_finding::{Finding, Span};

/// The result of a parser: the tree and the findings.
#[derive(Clone, Debug, PartialEq)]
pub struct Parsed<T> {
    /// The tree; invalid parts are [`crate::ast::ExprKind::Error`].
    pub tree: T,
    /// Findings in source order.
    pub diagnostics: Vec<Finding>,
    /// Whether there are typographic quotes that the host reports itself.
    pub quotes_left_to_host: bool,
}

/// The maximum length of a source text in bytes. Real lessons stay below 2,000.
pub const MAX_SOURCE: usize = 32 * 1024;

/// The maximum nesting of an expression: brackets, unary operators and chains like `a + b + c + …` each count one level.
pub const MAX_DEPTH: usize = 128;

/// The maximum number of findings for one text.
pub(crate) const MAX_DIAGNOSTICS: usize = 40;

/// Parses an expression. It never fails: an invalid part becomes [`ExprKind::Error`] and a finding.
pub fn parse_expression(source: &str) -> Parsed<Expr> {
    expression(source, &HostTerms::PLAIN, false)
}

/// Parses an expression of a host with these terms. `tells` states that the host reports typographic quotes itself.
pub(crate) fn expression(source: &str, host_terms: &'static HostTerms, tells: bool) -> Parsed<Expr> {
    let mut parser = Parser::new(source, host_terms, tells);
    let tree = parser.whole_expression();
    Parsed {
        tree,
        diagnostics: in_order(parser.diagnostics),
        quotes_left_to_host: parser.quotes_left_to_host,
    }
}

/// Parses statements separated by semicolons or line ends. It never fails, see [`parse_expression`].
pub fn parse_statements(source: &str) -> Parsed<Vec<Stmt>> {
    statements(source, &HostTerms::PLAIN, false)
}

/// Parses statements of a host with these terms, see [`expression`].
pub(crate) fn statements(source: &str, host_terms: &'static HostTerms, tells: bool) -> Parsed<Vec<Stmt>> {
    let mut parser = Parser::new(source, host_terms, tells);
    let tree = parser.statements();
    Parsed {
        tree,
        diagnostics: in_order(parser.diagnostics),
        quotes_left_to_host: parser.quotes_left_to_host,
    }
}

/// The findings in source order, limited in number.
pub(crate) fn in_order(mut found: Vec<Finding>) -> Vec<Finding> {
    // A string that is not closed contains the brackets behind it, so the brackets before it seem to be open.
    let open_string = found.iter().filter(|d| d.code == rules::BAD_STRING.code).map(|d| d.span.start).max();
    found
        .retain(|d| d.code != rules::UNCLOSED.code || open_string.is_none_or(|offset| d.span.start > offset));
    order::sort_by_key(&mut found, |d| (d.span.start, d.span.end));
    if found.len() > MAX_DIAGNOSTICS {
        found.truncate(MAX_DIAGNOSTICS);
        let span = found.last().map_or(Span::default(), |d| Span::new(d.span.end, d.span.end));
        found.push(
            Finding::error(
                rules::TOO_MANY_ERRORS,
                span,
                format!("the text has more than {MAX_DIAGNOSTICS} mistakes: the rest are not listed"),
            )
            .help("fix the first ones; the others may follow from them"),
        );
    }
    found
}

/// Marks an error that has been reported; it is propagated to where parsing can continue.
#[derive(Debug)]
pub(crate) struct Reported;

pub(crate) type Attempt<T> = Result<T, Reported>;

/// The parser: a position in the tokens, and the findings.
pub(super) struct Parser<'s> {
    pub(super) source: &'s str,
    pub(super) host_terms: &'static HostTerms,
    /// Whether the host reports typographic quotes, and whether there are any.
    pub(super) tells: bool,
    pub(super) quotes_left_to_host: bool,
    pub(super) tokens: Vec<Token<'s>>,
    pub(super) position: usize,
    /// The nesting depth of the expressions and statements that are being parsed.
    pub(super) depth: usize,
    /// The height of the highest tree since [`Parser::measured`] began.
    pub(super) tallest: usize,
    pub(super) diagnostics: Vec<Finding>,
}

impl<'s> Parser<'s> {
    pub(super) fn new(source: &'s str, host_terms: &'static HostTerms, tells: bool) -> Parser<'s> {
        let mut diagnostics = Vec::new();
        let tokens = if source.len() > MAX_SOURCE {
            let message = format!("the text has {} bytes, but the limit is {MAX_SOURCE}", source.len());
            diagnostics
                .push(Finding::error(rules::TOO_LONG, Span::default(), message).help(host_terms.split));
            vec![Token { kind: TokenKind::Bad, span: Span::default(), newline: false, doubt: None }]
        } else {
            lex::tokens(source, &mut diagnostics)
        };
        let quotes_left_to_host = false;
        let mut parser = Parser {
            source,
            host_terms,
            tells,
            quotes_left_to_host,
            tokens,
            position: 0,
            depth: 0,
            tallest: 0,
            diagnostics,
        };
        parser.check_typographic_quotes();
        parser
    }

    /// Reports findings about typographic quotes, or records that the host must.
    pub(super) fn check_typographic_quotes(&mut self) {
        for token in self.tokens.iter_mut().filter(|token| !matches!(token.kind, TokenKind::Number(_))) {
            match token.doubt.take() {
                Some(_) if self.tells => self.quotes_left_to_host = true,
                doubt => self.diagnostics.extend(doubt.map(|finding| *finding)),
            }
        }
    }

    pub(super) fn peek(&self) -> &TokenKind<'s> {
        self.peek_at(0)
    }

    /// The token `n` positions ahead, or [`TokenKind::End`] after the last.
    pub(super) fn peek_at(&self, n: usize) -> &TokenKind<'s> {
        self.tokens.get(self.position + n).map_or(&TokenKind::End, |t| &t.kind)
    }

    /// The span of the next token. At the end of the text, it is the end of the last token.
    pub(super) fn span(&self) -> Span {
        let next = self.tokens.get(self.position).filter(|t| t.kind != TokenKind::End);
        next.map_or(self.last_span().after(), |t| t.span)
    }

    /// The span of the previous token.
    pub(super) fn last_span(&self) -> Span {
        self.position.checked_sub(1).and_then(|i| self.tokens.get(i)).map_or(Span::default(), |t| t.span)
    }

    /// Whether a line ends before the next token.
    pub(super) fn newline(&self) -> bool {
        self.tokens.get(self.position).is_none_or(|t| t.newline)
    }

    pub(super) fn ended(&self) -> bool {
        *self.peek() == TokenKind::End
    }

    pub(super) fn bump(&mut self) -> Span {
        let span = self.span();
        self.position += 1;
        span
    }

    pub(super) fn is(&self, symbol: &str) -> bool {
        matches!(self.peek(), TokenKind::Symbol(s) if *s == symbol)
    }

    pub(super) fn is_word(&self, word: &str) -> bool {
        matches!(self.peek(), TokenKind::Word(w) if *w == word)
    }

    /// Consumes the symbol if it is next.
    pub(super) fn consume(&mut self, symbol: &str) -> Option<Span> {
        self.is(symbol).then(|| self.bump())
    }

    /// Reports a finding, and abandons this part.
    pub(super) fn refuse<T>(&mut self, report: Finding) -> Attempt<T> {
        self.diagnostics.push(report);
        Err(Reported)
    }

    /// The next token as a message describes it.
    pub(super) fn describe_token(&self) -> String {
        match self.peek() {
            TokenKind::End => "the end of the text".into(),
            TokenKind::Template(..) => "a template literal".into(),
            _ => format!("`{}`", self.span().text(self.source)),
        }
    }

    /// Skips to one of `stops` at this level of brackets. Returns `false`, and stops in front of the end, if the statement or
    /// the enclosing bracket ends first.
    pub(super) fn skip_to(&mut self, stops: &[&str]) -> bool {
        loop {
            match *self.peek() {
                TokenKind::Symbol(s) if stops.contains(&s) => return true,
                TokenKind::End | TokenKind::Symbol(";" | ")" | "]" | "}") => return false,
                _ => self.skip_group(),
            }
        }
    }

    /// Skips one token, or a whole bracket with its contents.
    pub(super) fn skip_group(&mut self) {
        let mut open = 0usize;
        loop {
            match *self.peek() {
                TokenKind::End => return,
                TokenKind::Symbol("(" | "[" | "{") => open += 1,
                TokenKind::Symbol(")" | "]" | "}") => open = open.saturating_sub(1),
                _ => {}
            }
            self.bump();
            if open == 0 {
                return;
            }
        }
    }

    /// Runs `work`, and also returns the height of the highest tree that it builds.
    pub(super) fn measured<T>(&mut self, work: impl FnOnce(&mut Self) -> T) -> (T, usize) {
        let before = std::mem::take(&mut self.tallest);
        let result = work(self);
        let height = self.tallest;
        self.tallest = before.max(height);
        (result, height)
    }

    /// Parses the whole text as one expression.
    fn whole_expression(&mut self) -> Expr {
        let nothing = Expr { kind: ExprKind::Error, span: self.span() };
        if self.ended() {
            let report = Finding::error(rules::EMPTY, self.span(), "the expression is empty")
                .help(format!("write an expression, as `{}`", self.host_terms.number));
            self.diagnostics.push(report);
            return nothing;
        }
        if let Some(report) = self.statement_keyword() {
            self.diagnostics.push(report);
            return nothing;
        }
        let Ok(expr) = self.assignment() else { return nothing };
        if self.is(",")
            && let Some(report) = self.unexpected_after(expr.span)
        {
            self.diagnostics.push(report);
            return expr;
        }
        if !self.ended() {
            let report = self.trailing(&expr);
            self.diagnostics.extend(report);
        }
        expr
    }

    /// The finding for a text that continues after its expression.
    pub(super) fn trailing(&mut self, expr: &Expr) -> Option<Finding> {
        let span = self.span();
        if !self.is(";") {
            return self.unexpected_after(expr.span);
        }
        self.bump();
        let report = Finding::error(rules::EXPRESSION_ONLY, span, "an expression does not end with `;`");
        Some(if self.ended() {
            report
                .why("this text is a single value, not a list of statements")
                .help("remove the `;`")
                .fix(span, "")
        } else {
            report.why("only one value is read here, so a second statement is not allowed").help(format!(
                "keep the expression of the value, and move statements into {}",
                self.host_terms.statements
            ))
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn codes(source: &str) -> Vec<&'static str> {
        parse_statements(source).diagnostics.iter().map(|d| d.code).collect()
    }

    #[test]
    fn several_mistakes_are_all_found() {
        let source = "data.qpos[0] = * 2; x = (1 + ]; const = 3\nf(1, *, 2, /); ok = 1";
        let found = codes(source);
        assert!(found.len() >= 5, "{found:?}");
        let parsed = parse_statements(source);
        assert!(matches!(parsed.tree.last().map(|s| &s.kind), Some(crate::ast::StmtKind::Expr(_))));
    }

    #[test]
    fn depth_is_limited_without_using_the_stack() {
        let n = 5000;
        for source in [
            "(".repeat(n),
            "[".repeat(n),
            "f(".repeat(n),
            "-".repeat(n),
            "- ".repeat(n) + "1",
            "!".repeat(n) + "1",
            "a?".repeat(n),
            "a=".repeat(n) + "1",
            "1+".repeat(n) + "1",
            "2**".repeat(n) + "1",
            "a".to_owned() + &".b".repeat(n),
            "a".to_owned() + &"[0]".repeat(n),
            "a".to_owned() + &"()".repeat(n),
            "(".repeat(n) + "1" + &")".repeat(n),
            "a[".repeat(n) + "1" + &"]".repeat(n),
        ] {
            assert!(codes(&source).contains(&rules::TOO_DEEP.code), "{}", &source[..10]);
        }
    }

    #[test]
    fn many_mistakes_are_cut_short() {
        let found = codes(&"] ;".repeat(2000));
        assert_eq!(found.len(), MAX_DIAGNOSTICS + 1);
        assert_eq!(found.last(), Some(&rules::TOO_MANY_ERRORS.code));
    }

    #[test]
    fn long_texts_are_refused() {
        assert_eq!(codes(&" ".repeat(MAX_SOURCE + 1)), [rules::TOO_LONG]);
        assert_eq!(parse_expression(&" ".repeat(MAX_SOURCE + 1)).diagnostics.len(), 1);
    }
}
