//! The builder for one function: its names, constants and operations so far, and the current values of its variables.

use std::collections::BTreeMap;
use std::sync::Arc;

use crate::ir::{IrProgram, LocalId};
use crate::ssa::{Args, BlockId, Num, Op, Operand, Representation, SsaFunction, SsaProgram, Val};
use crate::tables::MemberTable;
use crate::value::Value;
use labspec_finding::Span;

/// The current values of the local variables.
#[derive(Default)]
pub(super) struct Variables {
    /// The value of each variable, and the number of enclosing loops when it was determined.
    pub(super) current: Vec<Option<(Operand, u32)>>,
    /// The previous value for each change.
    pub(super) log: Vec<(LocalId, Option<(Operand, u32)>)>,
}

/// An edge with an unknown target: its source block, and the variables stored since a mark in the log.
pub(super) struct PendingEdge {
    pub(super) from: BlockId,
    pub(super) stored: Vec<(LocalId, Operand)>,
}

impl PendingEdge {
    /// The value that was stored in a variable along the edge.
    pub(super) fn stored_value(&self, local: LocalId) -> Option<Operand> {
        let index = self.stored.binary_search_by_key(&local, |s| s.0).ok()?;
        self.stored.get(index).map(|(_, value)| *value)
    }
}

/// A loop around the current position.
pub(super) struct LoopContext {
    pub(super) header: BlockId,
    /// The edge into the loop.
    pub(super) entry: Option<PendingEdge>,
    pub(super) mark: usize,
    /// Variables that are read or stored in the loop, with their parameter and their value before the loop.
    pub(super) params: BTreeMap<LocalId, (Operand, Operand)>,
    pub(super) breaks: Vec<PendingEdge>,
    pub(super) continues: Vec<PendingEdge>,
    /// The number of early exits (of inlined calls and of chains) that already existed when the loop began.
    pub(super) returns: (usize, usize),
}

/// A region with several exits and a result: the statements of an inlined call, or a chain with `?.`.
pub(super) struct EarlyExits {
    pub(super) mark: usize,
    pub(super) result: LocalId,
    pub(super) exits: Vec<PendingEdge>,
}

/// The builder for one function.
pub(super) struct FunctionBuilder<'t> {
    pub(super) tree: &'t IrProgram,
    pub(super) form: &'t mut SsaProgram,
    pub(super) unit: SsaFunction,
    /// Whether the current position is unreachable.
    pub(super) dead: bool,
    /// Constants, by their bits.
    pub(super) constants: BTreeMap<u64, Num>,
    pub(super) variables: Variables,
    pub(super) temporaries: u32,
    pub(super) loops: Vec<LoopContext>,
    pub(super) inlines: Vec<EarlyExits>,
    pub(super) chains: Vec<EarlyExits>,
    /// The span that is reported for all operations, if they are part of an inlined call.
    pub(super) site: Option<Span>,
}

impl<'t> FunctionBuilder<'t> {
    pub(super) fn new(
        tree: &'t IrProgram,
        form: &'t mut SsaProgram,
        variables: Variables,
    ) -> FunctionBuilder<'t> {
        let mut build = FunctionBuilder {
            tree,
            form,
            unit: SsaFunction::default(),
            dead: false,
            constants: BTreeMap::new(),
            variables,
            temporaries: 0,
            loops: Vec::new(),
            inlines: Vec::new(),
            chains: Vec::new(),
            site: None,
        };
        // Capacity for a source text of usual length.
        build.unit.ops.reserve(32);
        build.unit.spans.reserve(32);
        build.unit.same.numbers.reserve(64);
        build.unit.same.values.reserve(32);
        // The first names are those of the result.
        build.new_number();
        build.new_value();
        build.begin(0);
        build
    }

    pub(super) fn is_shared(&self, local: LocalId) -> bool {
        self.tree.locals.get(local as usize).is_some_and(|l| l.shared)
    }

    pub(super) fn emit(&mut self, op: Op, span: Span) {
        if !self.dead {
            self.unit.ops.push(op);
            self.unit.spans.push(self.site.unwrap_or(span));
        }
    }

    pub(super) fn new_number(&mut self) -> Num {
        let name = self.unit.same.numbers.len() as u32;
        self.unit.same.numbers.push(name);
        Num(name)
    }

    pub(super) fn new_value(&mut self) -> Val {
        let name = self.unit.same.values.len() as u32;
        self.unit.same.values.push(name);
        Val(name)
    }

    pub(super) fn constant(&mut self, x: f64) -> Num {
        if let Some(&name) = self.constants.get(&x.to_bits()) {
            return name;
        }
        let name = self.new_number();
        self.constants.insert(x.to_bits(), name);
        self.unit.numbers.push((name, x));
        name
    }

    pub(super) fn constant_value(&mut self, value: &Value) -> Val {
        let existing = self.unit.values.iter().find(|(_, v)| match (v, value) {
            (Value::Number(a), Value::Number(b)) => a.to_bits() == b.to_bits(),
            (a, b) => a == b,
        });
        if let Some((name, _)) = existing {
            return *name;
        }
        let name = self.new_value();
        self.unit.values.push((name, value.clone()));
        name
    }

    pub(super) fn list_of(&mut self, names: &[u32]) -> Args {
        let first = self.unit.args.len() as u32;
        self.unit.args.extend_from_slice(names);
        Args { first, count: names.len() as u32 }
    }

    pub(super) fn text(&mut self, text: &Arc<str>) -> u32 {
        match self.form.texts.iter().position(|t| t == text) {
            Some(index) => index as u32,
            None => {
                self.form.texts.push(text.clone());
                (self.form.texts.len() - 1) as u32
            }
        }
    }

    pub(super) fn number_by(&mut self, span: Span, op: impl FnOnce(Num) -> Op) -> Num {
        let dst = self.new_number();
        self.emit(op(dst), span);
        dst
    }

    pub(super) fn value_of(&mut self, span: Span, op: impl FnOnce(Val) -> Op) -> Val {
        let dst = self.new_value();
        self.emit(op(dst), span);
        dst
    }

    pub(super) fn boxed(&mut self, src: Num, slot: Representation, span: Span) -> Val {
        match slot {
            Representation::Boolean => self.value_of(span, |dst| Op::BoxBoolean(dst, src)),
            _ => self.value_of(span, |dst| Op::BoxNumber(dst, src)),
        }
    }

    pub(super) fn table(&mut self, picks: &Arc<MemberTable>) -> u32 {
        self.form.picks.push(picks.clone());
        (self.form.picks.len() - 1) as u32
    }

    /// The representation in which a local variable is passed.
    pub(super) fn slot(&self, local: LocalId) -> Representation {
        match self.tree.locals.get(local as usize) {
            Some(local) if local.shared => Representation::Value,
            Some(local) => Representation::for_type(local.ty),
            None => Representation::Value,
        }
    }
}
