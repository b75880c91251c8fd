//! Tokens, as they are written and as they are read.

use labspec_finding::{Finding, Span};

/// A piece of the source text.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Token<'s> {
    pub(crate) kind: TokenKind<'s>,
    pub(crate) span: Span,
    /// A line ends between the token before and this one.
    pub(crate) newline: bool,
    /// What is wrong with it, unless it is not read by itself, as `02` in `0,02`, or the host tells of it, as of
    /// typographic quotes.
    pub(crate) doubt: Option<Box<Finding>>,
}

/// What a token is.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum TokenKind<'s> {
    Number(f64),
    Text(String),
    Word(&'s str),
    Symbol(&'static str),
    /// A template literal: its texts, and where the expressions between them stand.
    Template(Vec<String>, Vec<Span>),
    /// Could not be read; already reported.
    Bad,
    /// Behind the last character.
    End,
}

/// A token, as it is written.
pub(super) enum RawToken<'a> {
    Word(&'a str),
    /// A number, and the letters that stand directly behind it.
    Number(&'a str, &'a str),
    Symbol(&'static str),
    /// A string: its quote, its parts, and whether it is closed.
    Text(char, Vec<LiteralPart<'a>>, bool),
    Template(Vec<LiteralPart<'a>>),
    /// What stands between two typographic quotes.
    Typographic(&'a str),
    /// Any other character.
    Odd(char),
}

/// A part of a string or a template.
#[derive(Clone)]
pub(super) enum LiteralPart<'a> {
    Plain(&'a str),
    /// What an escape stands for.
    Char(char),
    /// A line that goes on.
    Nothing,
    /// An escape without a meaning.
    Broken(&'a str),
    /// The expression between `${` and `}`.
    Code(&'a str),
}
