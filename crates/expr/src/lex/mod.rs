//! Lexer, with nom. A parser for each kind of token, and for blanks between tokens, reports what is wrong with it when it reads
//! it. Every token stores its span and whether a line ends before it, which is all that automatic semicolons need. A character
//! that starts no token is reported once and skipped.

mod blank;
mod literal;
mod scan;
mod token;

pub(crate) use scan::{tokens, tokens_of};
pub(crate) use token::{Token, TokenKind};
