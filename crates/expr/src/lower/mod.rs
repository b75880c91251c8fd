//! From the typed tree to what runs: operations in single-assignment form, formulas of them, and code.

mod build;
mod builder;
mod call;
mod emit;
mod flow;
mod fold;
mod function;
mod place;
mod pure;
mod registers;
mod step;

pub(crate) use emit::emit;
pub(crate) use function::lower;
pub(crate) use pure::whole as whole_formula;
