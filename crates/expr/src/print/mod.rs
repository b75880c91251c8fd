//! Syntax tree to text: one layout, with parentheses only where the tree requires them. Parsing the result gives the same tree.
//! The formatter adds two features for authors: numbers keep their spelling, and a text of one line stays on one line.

mod expression;
mod format;
mod literal;
mod printer;
mod statement;

pub use format::{format_expression, format_statements, print, print_statements};
