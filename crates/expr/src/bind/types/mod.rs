//! The second pass: infers all types and builds the typed tree.
//!
//! A round binds the whole text with the types that are known of its variables and functions. If a type widens after it was
//! read, another round follows (a fixed point over a lattice; Kildall, "A unified approach to global program optimization",
//! 1973). Types only widen, at most three times each, so the rounds terminate. After a few rounds, the places through which
//! every cycle of types passes get the type any (widening; Cousot and Cousot, "Abstract interpretation", 1977), and at most two
//! more rounds follow: see `facts::TypeFacts`.

mod access;
mod assign;
mod binder;
mod call;
mod extra_arguments;
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
