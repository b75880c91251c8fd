//! The second pass: which type everything has, and the typed tree.
//!
//! A round binds the whole text with the types that are known of its variables and functions. Where a type grows after it was read,
//! another round follows (a fixed point over a lattice; Kildall, "A unified approach to global program optimization", 1973). Types
//! only grow, at most three times each, so the rounds end. After a few of them the places through which every circle of types goes
//! are taken to hold anything (widening; Cousot and Cousot, "Abstract interpretation", 1977), and two more rounds are the last:
//! see `facts::TypeFacts`.

mod access;
mod assign;
mod binder;
mod call;
mod facts;
mod function;
mod inline_method;
mod literal;
mod loops;
mod member;
mod method;
mod object;
mod scope;
mod statement;
#[cfg(test)]
mod tests;
mod typed;
mod value;

pub(super) use binder::{BindContext, bind};
pub(super) use typed::{Expectation, ExpressionShape, TypedText};
