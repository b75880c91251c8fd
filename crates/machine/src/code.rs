//! The code of a program: what the machine runs, and what the heap keeps of functions.

use crate::row::Row;
use crate::ssa::{Num, Op, Representation, SsaProgram, Val};
use crate::value::Value;
use labspec_finding::Span;

/// What an operation counts, in units of work.
pub const OPERATION: u64 = 2;

/// A program for the machine.
#[derive(Clone, Debug, Default)]
pub struct MachineCode {
    /// What it was made from, with the names, tables and arrays that its operations name by number.
    pub form: SsaProgram,
    /// The functions; the first is the text itself.
    pub units: Vec<MachineFunction>,
}

/// A function for the machine. Its first registers hold its result, the next its parameters and what it uses of
/// the functions around it.
#[derive(Clone, Debug, Default)]
pub struct MachineFunction {
    /// Its operations, in the order in which they run.
    pub ops: Vec<Op>,
    /// Where each operation comes from.
    pub spans: Vec<Span>,
    /// Lists of registers.
    pub args: Vec<u32>,
    /// Numbers that are computed together, with how many operations each formula is.
    pub formulas: Vec<(Row, u32)>,
    /// Constants and the registers that hold them.
    pub numbers: Vec<(Num, f64)>,
    /// Constant values and the registers that hold them.
    pub values: Vec<(Val, Value)>,
    /// What running it once costs, without the turns of its loops.
    pub cost: u64,
    /// Registers used.
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
