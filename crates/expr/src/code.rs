//! The code of a program: what the machine runs, and what the heap keeps of functions.

use crate::row::Row;
use crate::ssa::{Num, Op, Representation, SsaProgram, Val};
use crate::value::Value;
use labspec_finding::Span;

/// What an operation counts, in units of work.
pub(crate) const OPERATION: u64 = 2;

/// A program for the machine.
#[derive(Clone, Debug, Default)]
pub(crate) struct MachineCode {
    /// What it was made from, with the names, tables and arrays that its operations name by number.
    pub(crate) form: SsaProgram,
    /// The functions; the first is the text itself.
    pub(crate) units: Vec<MachineFunction>,
}

/// A function for the machine. Its first registers hold its result, the next its parameters and what it uses of
/// the functions around it.
#[derive(Clone, Debug, Default)]
pub(crate) struct MachineFunction {
    pub(crate) ops: Vec<Op>,
    /// Where each operation comes from.
    pub(crate) spans: Vec<Span>,
    /// Lists of registers.
    pub(crate) args: Vec<u32>,
    /// Numbers that are computed together, with how many operations each formula is.
    pub(crate) formulas: Vec<(Row, u32)>,
    /// Constants and the registers that hold them.
    pub(crate) numbers: Vec<(Num, f64)>,
    pub(crate) values: Vec<(Val, Value)>,
    /// What running it once costs, without the turns of its loops.
    pub(crate) cost: u64,
    /// Registers used.
    pub(crate) number_count: u32,
    pub(crate) value_count: u32,
    pub(crate) params: Vec<Representation>,
    pub(crate) captures: Vec<Representation>,
    pub(crate) result: Representation,
}
