//! What the programs of the accessor language are while they run: values, the heap, code and the machine.
//!
//! `labspec-expr` compiles texts to the code that is described here, and has the interface of the language. The crates are two
//! because a page's module is built for speed only where it runs in every step.
//!
//! | what | module |
//! |---|---|
//! | operations on registers, in blocks | `ssa`, and in a row: `code` |
//! | numbers that are computed together | `formula`, `row` |
//! | methods and functions | `natives`, `math` |
//! | running | `vm`, with a `context` and a `host`: a [`value::Value`], or a [`runtime_event::RuntimeError`] |
//!
//! [`rules`] are those of the whole language: what a program breaks while it runs, and what its text breaks.

pub mod code;
pub mod context;
pub mod formula;
pub mod global_names;
pub mod globals;
pub mod heap;
pub mod host;
pub mod host_terms;
pub mod math;
pub mod natives;
pub mod number;
pub mod operation;
pub mod operators;
pub mod row;
pub mod rules;
pub mod runtime_event;
pub mod ssa;
pub mod tables;
pub mod types;
pub mod value;
pub mod vm;
pub mod watch;
