//! From the typed tree to executable code: operations in static single assignment form, formulas, and machine code.

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
