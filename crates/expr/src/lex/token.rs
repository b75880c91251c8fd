//! Tokens, in their source form and in their interpreted form.

use labspec_finding::{Finding, Span};

/// A piece of the source text.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Token<'s> {
    pub(crate) kind: TokenKind<'s>,
    pub(crate) span: Span,
    /// Whether a line ends between the previous token and this one.
    pub(crate) newline: bool,
    /// A finding that is reported only under a condition: `02` in `0,02` unless the two numbers are read as one; typographic
    /// quotes unless the host reports them.
    pub(crate) doubt: Option<Box<Finding>>,
}

/// The kind of a token.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum TokenKind<'s> {
    Number(f64),
    Text(String),
    Word(&'s str),
    Symbol(&'static str),
    /// A template literal: its strings, and the spans of the expressions between them.
    Template(Vec<String>, Vec<Span>),
    /// An invalid token; the error has been reported.
    Bad,
    /// The end of the text.
    End,
}

/// A token in its source form.
pub(super) enum RawToken<'a> {
    Word(&'a str),
    /// A number, and the letters that directly follow it.
    Number(&'a str, &'a str),
    Symbol(&'static str),
    /// A string: its quote, its parts, and whether it is closed.
    Text(char, Vec<LiteralPart<'a>>, bool),
    Template(Vec<LiteralPart<'a>>),
    /// The string between two typographic quotes.
    Typographic(&'a str),
    /// Any other character.
    Odd(char),
}

/// A part of a string or a template.
#[derive(Clone)]
pub(super) enum LiteralPart<'a> {
    Plain(&'a str),
    /// The character that an escape sequence denotes.
    Char(char),
    /// A line continuation.
    Nothing,
    /// An invalid escape sequence.
    Broken(&'a str),
    /// The expression between `${` and `}`.
    Code(&'a str),
}
