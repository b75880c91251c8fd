//! The accessor language of lessons: text in, typed program out.
//!
//! A lesson is written in the side-effect-limited core of JavaScript: `data.qpos[2]`, `model.opt.timestep = 0.02`, `ctx.peak =
//! Math.max(ctx.peak || 0, data.qvel[2])`. This crate parses such a text, resolves every name against the [`Schema`] of a host,
//! checks indexes, kinds and signatures, and compiles the text to a [`Program`] that runs against a [`Host`] without string
//! lookups. It does not depend on physics: the host defines which fields exist, which can be written, and what functions do.
//!
//! | stage | module | result |
//! |---|---|---|
//! | text to tokens | `lex` (nom) | tokens with byte spans |
//! | tokens to tree | `parse` | [`ast`], always, with a list of findings |
//! | tree to typed tree | `bind` | typed tree of `ir`, every name resolved |
//! | typed tree to SSA form | `lower` | basic blocks of operations, every value defined once |
//! | SSA form to code | `lower::emit`, `lower::pure` | [`Program`]: operations on registers, formulas |
//! | evaluation | `vm`, `row` | a [`Value`], or a [`RuntimeError`] |
//! | evaluation over samples | `columnar` | a column of numbers |
//!
//! Values are those of JavaScript. Arithmetic, comparisons, strings and conversions give the same bits. Functions of `Math`
//! that the standard leaves to the implementation, such as `sin` and `tanh`, are within 2 units in the last place, as measured
//! against node (`docs/measured/math.md`: for 100,000 arguments of each function, 91 to 100 % of the results have the same
//! bits). Parsing and compiling never fail: they return what was understood and a list of [`Finding`]s.

pub mod ast;
pub mod dimension;

mod analysis;
mod bind;
mod chain;
mod columnar;
mod complete;
mod effects;
mod ir;
mod lex;
mod lower;
mod parse;
mod print;
mod program;
mod reference;
mod schema;
mod signature;
mod source_functions;

use labspec_machine::{
    code, context, formula, global_names, globals, heap, host, host_terms, math, natives, number, operation,
    operators, row, runtime_event, ssa, tables, types, value, vm, watch,
};

pub use labspec_machine::rules;

#[cfg(test)]
mod mock;
#[cfg(test)]
#[path = "../../../tests/needs.rs"]
mod needs;
#[cfg(test)]
mod tests;
#[cfg(test)]
#[path = "../../../tests/zz.rs"]
mod zz;

pub use analysis::measure::{AngleArgument, DimensionClash, DimensionStore, KnownDimensions, TextDimensions};
pub use bind::{Compiled, Compiler};
pub use chain::{FieldMention, NamedObject, chain_at, fields_in, names_in, texts_in, variables_of};
pub use columnar::{Columnar, Foreign, Recording};
pub use complete::{CompletionScope, Suggested, Suggestion, complete};
pub use context::Context;
pub use effects::{Access, Effects};
pub use globals::{Globals, ProgramId};
pub use heap::{Full, Heap};
pub use host::Host;
pub use host_terms::HostTerms;
pub use labspec_finding::{Finding, Fix, Severity, Span, floor};
pub use math::hypot;
pub use natives::to_fixed;
pub use parse::Parsed;
pub use parse::{MAX_DEPTH, MAX_SOURCE, parse_expression, parse_statements};
pub use print::{format_expression, format_statements, print, print_statements};
pub use program::{Aggregate, Program};
pub use reference::language_page;
pub use runtime_event::{EventKind, RuntimeError, RuntimeEvent};
pub use schema::{
    AccessedFields, AngleAdvice, Entry, Field, FieldKind, FunctionInfo, Help, Param, ResultDimension, Role,
    Schema,
};
pub use signature::{CallSignature, is_in_aggregate, is_in_brackets, signature_at};
pub use types::{CollectionId, Elem, FieldKey, FunctionId, ObjectId, Type};
pub use value::{Ref, Value, View};
pub use watch::{Comparison, Watch};
