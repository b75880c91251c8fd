//! The machine code of a program: the virtual machine runs it, and function values on the heap refer to it.

use crate::row::Row;
use crate::ssa::{Num, Op, Representation, SsaProgram, Val};
use crate::value::Value;
use labspec_finding::Span;

/// The cost of an operation, in units of work.
pub(crate) const OPERATION: u64 = 2;

/// A program of the virtual machine.
#[derive(Clone, Debug, Default)]
pub(crate) struct MachineCode {
    /// The SSA form from which it was made. It holds the names, tables and arrays to which operations refer by index.
    pub(crate) form: SsaProgram,
    /// The functions; the first is the program itself.
    pub(crate) units: Vec<MachineFunction>,
}

/// A function of the virtual machine. Its first registers are for its result, the next for its parameters, and the next
/// for its captured variables.
#[derive(Clone, Debug, Default)]
pub(crate) struct MachineFunction {
    pub(crate) ops: Vec<Op>,
    /// The source span of each operation.
    pub(crate) spans: Vec<Span>,
    /// Lists of registers.
    pub(crate) args: Vec<u32>,
    /// Formulas, each with the number of operations that it replaces.
    pub(crate) formulas: Vec<(Row, u32)>,
    /// Constants and the registers that hold them.
    pub(crate) numbers: Vec<(Num, f64)>,
    pub(crate) values: Vec<(Val, Value)>,
    /// The cost of one execution, without the iterations of its loops.
    pub(crate) cost: u64,
    /// The number of registers used.
    pub(crate) number_count: u32,
    pub(crate) value_count: u32,
    pub(crate) params: Vec<Representation>,
    pub(crate) captures: Vec<Representation>,
    pub(crate) result: Representation,
}
