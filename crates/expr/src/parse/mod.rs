//! Tokens to syntax tree. The grammar is that of JavaScript for the part of the language that lessons use. Operators are parsed
//! by binding power (Pratt, "Top down operator precedence", 1973).
//!
//! One error does not hide the next: after an error between brackets or commas, the parser skips to the bracket or comma; after
//! any other error, it skips to the end of the statement. Then it continues.

mod brackets;
mod declaration;
mod expr;
mod function;
mod node;
mod parser;
mod primary;
mod python;
mod recovery;
mod refuse;
mod stmt;
mod unexpected;

pub(crate) use parser::{Attempt, MAX_DIAGNOSTICS, Reported, expression, in_order, statements};
pub use parser::{MAX_DEPTH, MAX_SOURCE, Parsed, parse_expression, parse_statements};
