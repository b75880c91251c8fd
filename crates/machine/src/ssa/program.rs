//! The intermediate form between the binder and the evaluators: every value has one name and one definition (static single
//! assignment; Cytron et al., "Efficiently computing static single assignment form and the control dependence graph", 1991).
//!
//! A function is a list of basic blocks. Values that differ between the edges to a block are parameters of the block, as in a
//! call. Blocks are in source order, so all edges lead forward, except those back to the start of a loop. Machine code
//! (`lower::emit`) and formulas (`lower::pure`) are generated from this form.

use std::sync::Arc;

use crate::tables::{ExposedView, MemberTable};
use crate::types::Type;
use crate::value::Value;

use super::op::{Num, Op, Val};
use labspec_finding::Span;

/// A program in SSA form.
#[derive(Clone, Debug, Default)]
pub struct SsaProgram {
    /// The functions; the first is the program itself.
    pub units: Vec<SsaFunction>,
    /// Names of members.
    pub texts: Vec<Arc<str>>,
    /// Tables of computed names.
    pub picks: Vec<Arc<MemberTable>>,
    /// Arrays used as values.
    pub views: Vec<ExposedView>,
}

/// A function. Its first names, from 1 on, are its parameters and its captured variables.
#[derive(Clone, Debug, Default)]
pub struct SsaFunction {
    /// Its blocks; the first is where it begins.
    pub blocks: Vec<BasicBlock>,
    /// The operations of all blocks, block after block.
    pub ops: Vec<Op>,
    /// The span of each operation.
    pub spans: Vec<Span>,
    /// Lists of operands.
    pub args: Vec<u32>,
    /// Constants and their names, in the order of the names.
    pub numbers: Vec<(Num, f64)>,
    /// Constant values.
    pub values: Vec<(Val, Value)>,
    /// The alias of each name: itself, or an earlier name with the same value.
    pub same: Aliases,
    /// How each parameter is passed.
    pub params: Vec<Representation>,
    /// How each variable of the functions around it is passed.
    pub captures: Vec<Representation>,
    /// How the result is returned.
    pub result: Representation,
}

/// The names of numbers and of values, each with its alias.
#[derive(Clone, Debug, Default)]
pub struct Aliases {
    pub numbers: Vec<u32>,
    pub values: Vec<u32>,
}

/// A number or a value of any type.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Operand {
    /// A number.
    Number(Num),
    /// A value.
    Value(Val),
}

/// The number of a block.
pub type BlockId = u32;

/// A basic block: operations that are executed in sequence.
#[derive(Clone, Debug)]
pub struct BasicBlock {
    /// Its first operation.
    pub first: u32,
    /// What the blocks before it hand over.
    pub params: Vec<Operand>,
    /// The last block through which all paths to this one pass.
    pub after: BlockId,
    /// How it ends.
    pub end: Terminator,
    /// The span of its terminator.
    pub span: Span,
}

/// An edge to a block, with the arguments of its parameters.
#[derive(Clone, Debug, Default)]
pub struct BlockEdge {
    /// The block that follows.
    pub to: BlockId,
    /// What is handed to it.
    pub args: Vec<Operand>,
}

/// The end of a block.
#[derive(Clone, Debug)]
pub enum Terminator {
    /// To one block.
    Jump(BlockEdge),
    /// Jumps if the condition has this truth value; otherwise continues with the next block.
    If(bool, Num, BlockEdge),
    /// Jumps if the value is, or is not, `undefined` or `null`; otherwise continues with the next block.
    IfNothing(bool, Val, BlockEdge),
    /// Jumps back to the start of a loop.
    Again(BlockEdge),
    /// Out of the function.
    Return(Option<Operand>),
}

/// How a value is passed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Representation {
    /// A number, in a register of numbers.
    Number,
    /// As a number, 1 or 0.
    Boolean,
    /// A value of any kind, in a register of values.
    #[default]
    Value,
}

impl Representation {
    /// How a value of this type is represented.
    pub fn for_type(ty: Type) -> Representation {
        match ty {
            Type::Number => Representation::Number,
            Type::Boolean => Representation::Boolean,
            _ => Representation::Value,
        }
    }
}

impl SsaFunction {
    /// The indexes of the operations of a block.
    pub fn range(&self, block: BlockId) -> std::ops::Range<usize> {
        let first = |b: BlockId| self.blocks.get(b as usize).map_or(self.ops.len(), |b| b.first as usize);
        first(block)..first(block + 1)
    }

    /// The value of a number, if it is constant.
    pub fn constant(&self, number: Num) -> Option<f64> {
        let index = self.numbers.binary_search_by_key(&number, |(n, _)| *n).ok()?;
        self.numbers.get(index).map(|(_, x)| *x)
    }

    /// The value, if it is constant.
    pub fn constant_value(&self, value: Val) -> Option<&Value> {
        let value = self.same.value(value);
        let index = self.values.binary_search_by_key(&value, |(v, _)| *v).ok()?;
        self.values.get(index).map(|(_, x)| x)
    }
}

impl Aliases {
    pub fn number(&self, n: Num) -> Num {
        Num(last(&self.numbers, n.0))
    }

    pub fn value(&self, v: Val) -> Val {
        Val(last(&self.values, v.0))
    }

    pub fn at(&self, operand: Operand) -> Operand {
        match operand {
            Operand::Number(n) => Operand::Number(self.number(n)),
            Operand::Value(v) => Operand::Value(self.value(v)),
        }
    }

    /// Shortens all chains of aliases to one step.
    pub fn shorten(&mut self) {
        for list in [&mut self.numbers, &mut self.values] {
            for i in 0..list.len() {
                // A name is an alias of an earlier one, which has been shortened already, or of one of an outer loop.
                let end = last(list, i as u32);
                if let Some(place) = list.get_mut(i) {
                    *place = end;
                }
            }
        }
    }

    /// Makes a name an alias of another one.
    pub fn join(&mut self, name: Operand, other: Operand) {
        match (name, other) {
            (Operand::Number(n), Operand::Number(other)) => {
                let other = self.number(other).0;
                if let Some(place) = self.numbers.get_mut(n.0 as usize) {
                    *place = other;
                }
            }
            (Operand::Value(v), Operand::Value(other)) => {
                let other = self.value(other).0;
                if let Some(place) = self.values.get_mut(v.0 as usize) {
                    *place = other;
                }
            }
            // A variable contains either numbers or values, never both.
            _ => {}
        }
    }
}

/// Follows a chain of aliases to its end.
fn last(names: &[u32], mut name: u32) -> u32 {
    while let Some(&next) = names.get(name as usize) {
        if next == name {
            break;
        }
        name = next;
    }
    name
}
