//! Text to tokens, with nom: every token, and every blank between tokens, is read by a parser of its kind; what is wrong with one is
//! said when it is read. Every token keeps its bytes and whether a line ends before it, which is all that automatic semicolons need.
//! A character that starts no token is reported once and skipped.

mod blank;
mod literal;
mod scan;
mod token;

pub(crate) use scan::{tokens, tokens_of};
pub(crate) use token::{Token, TokenKind};
