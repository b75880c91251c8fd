//! The machine code of a program: the virtual machine runs it, and function values on the heap refer to it.

use crate::row::Row;
use crate::ssa::{Num, Op, Representation, SsaProgram, Val};
use crate::value::Value;
use labspec_finding::Span;

/// The cost of an operation, in units of work.
pub const OPERATION: u64 = 2;

/// A program of the virtual machine.
#[derive(Clone, Debug, Default)]
pub struct MachineCode {
    /// The SSA form from which it was made. It holds the names, tables and arrays to which operations refer by index.
    pub form: SsaProgram,
    /// The functions; the first is the program itself.
    pub units: Vec<MachineFunction>,
}

/// A function of the virtual machine. Its first registers are for its result, the next for its parameters, and the next
/// for its captured variables.
#[derive(Clone, Debug, Default)]
pub struct MachineFunction {
    /// Its operations, in the order in which they run.
    pub ops: Vec<Op>,
    /// The source span of each operation.
    pub spans: Vec<Span>,
    /// Lists of registers.
    pub args: Vec<u32>,
    /// Formulas, each with the number of operations that it replaces.
    pub formulas: Vec<(Row, u32)>,
    /// Constants and the registers that hold them.
    pub numbers: Vec<(Num, f64)>,
    /// Constant values and the registers that hold them.
    pub values: Vec<(Val, Value)>,
    /// The cost of one execution, without the iterations of its loops.
    pub cost: u64,
    /// The number of registers used.
    pub number_count: u32,
    /// Registers of values used.
    pub value_count: u32,
    /// How each parameter is passed.
    pub params: Vec<Representation>,
    /// How each variable of the functions around it is passed.
    pub captures: Vec<Representation>,
    /// How the result is returned.
    pub result: Representation,
}
