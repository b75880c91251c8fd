//! Tokens to tree. The grammar is JavaScript's for the part of the language that lessons use; operators are
//! read by binding power (Pratt, "Top down operator precedence", 1973).
//!
//! One mistake does not hide the next: a mistake between brackets or commas is skipped to the bracket or
//! comma, any other to the end of its statement, and reading goes on from there.

mod brackets;
mod declaration;
mod expr;
mod function;
mod node;
mod parser;
mod primary;
mod recovery;
mod refuse;
mod stmt;
mod unexpected;

pub(crate) use parser::{Attempt, MAX_DIAGNOSTICS, Reported, expression, in_order, statements};
pub use parser::{MAX_DEPTH, MAX_SOURCE, Parsed, parse_expression, parse_statements};
