//! Tree to text: one layout, parentheses only where the tree needs them. Reading the result gives the tree back.
//! The formatter is this with two wishes of authors: numbers stay as they are written, and a text of one line stays on one.

mod expression;
mod format;
mod literal;
mod printer;
mod statement;

pub use format::{format_expression, format_statements, print, print_statements};
