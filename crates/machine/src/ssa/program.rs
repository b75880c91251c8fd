//! The one form between binder and machines: every value has one name and one definition (static single assignment;
//! Cytron et al., "Efficiently computing static single assignment form and the control dependence graph", 1991).
//!
//! A function is a list of blocks; what differs between the ways that lead to a block are its parameters, as in a call.
//! Blocks stand in the order of the text, so all ways but those back to the start of a loop lead forward. The machine's
//! code (`lower::emit`) and formulas (`lower::pure`) are made from here.

use std::sync::Arc;

use crate::tables::{ExposedView, MemberTable};
use crate::types::Type;
use crate::value::Value;

use super::op::{Num, Op, Val};
use labspec_finding::Span;

/// A text.
#[derive(Clone, Debug, Default)]
pub struct SsaProgram {
    /// The functions; the first is the text itself.
    pub units: Vec<SsaFunction>,
    /// Names of members.
    pub texts: Vec<Arc<str>>,
    /// Tables of computed names.
    pub picks: Vec<Arc<MemberTable>>,
    /// Arrays that become values.
    pub views: Vec<ExposedView>,
}

/// A function. Its first names, from 1 on, are its parameters and what it uses of the functions around it.
#[derive(Clone, Debug, Default)]
pub struct SsaFunction {
    /// Its blocks; the first is where it begins.
    pub blocks: Vec<BasicBlock>,
    /// The operations of all blocks, one block after the other.
    pub ops: Vec<Op>,
    /// Where each comes from.
    pub spans: Vec<Span>,
    /// Lists of operands.
    pub args: Vec<u32>,
    /// Constants and their names, in the order of the names.
    pub numbers: Vec<(Num, f64)>,
    /// Constant values.
    pub values: Vec<(Val, Value)>,
    /// What each name stands for: itself, or the name before it that turned out to be the same.
    pub same: Aliases,
    /// How each parameter is passed.
    pub params: Vec<Representation>,
    /// How each variable of the functions around it is passed.
    pub captures: Vec<Representation>,
    /// How the result is returned.
    pub result: Representation,
}

/// Names of numbers and of values, each with the name that it stands for.
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

/// Operations that run one after the other.
#[derive(Clone, Debug)]
pub struct BasicBlock {
    /// Its first operation.
    pub first: u32,
    /// What the blocks before it hand over.
    pub params: Vec<Operand>,
    /// The last block that all ways to this one pass.
    pub after: BlockId,
    /// How it ends.
    pub end: Terminator,
    /// Where its end stands.
    pub span: Span,
}

/// A way to a block, with what its parameters are.
#[derive(Clone, Debug, Default)]
pub struct BlockEdge {
    /// The block that follows.
    pub to: BlockId,
    /// What is handed to it.
    pub args: Vec<Operand>,
}

/// Where a block leads.
#[derive(Clone, Debug)]
pub enum Terminator {
    /// To one block.
    Jump(BlockEdge),
    /// When the truth is this one; else on to the next block.
    If(bool, Num, BlockEdge),
    /// When the value is `undefined` or `null`, or is not; else on to the next block.
    IfNothing(bool, Val, BlockEdge),
    /// Back to the start of a loop.
    Again(BlockEdge),
    /// Out of the function.
    Return(Option<Operand>),
}

/// How a value is handed over.
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
    /// The places of the operations of a block.
    pub fn range(&self, block: BlockId) -> std::ops::Range<usize> {
        let first = |b: BlockId| self.blocks.get(b as usize).map_or(self.ops.len(), |b| b.first as usize);
        first(block)..first(block + 1)
    }

    /// The number, if it is known.
    pub fn constant(&self, number: Num) -> Option<f64> {
        let at = self.numbers.binary_search_by_key(&number, |(n, _)| *n).ok()?;
        self.numbers.get(at).map(|(_, x)| *x)
    }

    /// The value, if it is known.
    pub fn constant_value(&self, value: Val) -> Option<&Value> {
        let value = self.same.value(value);
        let at = self.values.binary_search_by_key(&value, |(v, _)| *v).ok()?;
        self.values.get(at).map(|(_, x)| x)
    }
}

impl Aliases {
    pub fn number(&self, n: Num) -> Num {
        Num(last(&self.numbers, n.0))
    }

    pub fn value(&self, v: Val) -> Val {
        Val(last(&self.values, v.0))
    }

    pub fn at(&self, at: Operand) -> Operand {
        match at {
            Operand::Number(n) => Operand::Number(self.number(n)),
            Operand::Value(v) => Operand::Value(self.value(v)),
        }
    }

    /// Every name leads to where it stands for in one step.
    pub fn shorten(&mut self) {
        for list in [&mut self.numbers, &mut self.values] {
            for i in 0..list.len() {
                // A name stands for one before it, which is short already, or for one of an outer loop.
                let end = last(list, i as u32);
                if let Some(place) = list.get_mut(i) {
                    *place = end;
                }
            }
        }
    }

    /// A name turned out to be another one.
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
            // A variable holds numbers or values, never both.
            _ => {}
        }
    }
}

/// Follows names to the one that stands for itself.
fn last(names: &[u32], mut at: u32) -> u32 {
    while let Some(&next) = names.get(at as usize) {
        if next == at {
            break;
        }
        at = next;
    }
    at
}
