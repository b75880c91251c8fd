//! The third pass: lints, which report code that is allowed but rarely intended. They read the source text and the results
//! of the other passes, and change nothing.

mod angles;
mod compare;
mod conditions;
mod constants;
mod definitions;
mod exact;
mod idle;
mod limits;
mod numbers;
mod operands;
mod pass;
mod sums;
mod twice;

pub(super) use pass::lint;
