//! Statements: declarations, conditions, loops and jumps.

use super::{Exits, Home, Inline, Lowering};
use crate::Span;
use crate::ir::{Ir, Kind, LocalId, Loop, Step};
use crate::value::Value;
use crate::vm::{Num, Op, Slot, Val};

impl Lowering<'_> {
    pub(super) fn steps(&mut self, steps: &[Step]) {
        for step in steps {
            self.step(step);
        }
    }

    fn step(&mut self, step: &Step) {
        match step {
            Step::Effect(ir) => self.effect(ir),
            Step::Declare(local, value) => self.declare(*local, value),
            Step::Reserve(local) => {
                let cell = self.new_value();
                self.emit(Op::EmptyCell(cell), Span::default());
                self.homes.insert(*local, Home::Cell(cell));
            }
            Step::Renew(local) => {
                if let Some(Home::Cell(cell)) = self.homes.get(local).copied() {
                    let old = self.unary_value(Span::default(), |dst| Op::CellGet(dst, cell));
                    self.emit(Op::NewCell(cell, old), Span::default());
                }
            }
            Step::If(test, then, otherwise) => {
                let span = test.span;
                self.choice(test, span, |s| s.steps(then), |s| s.steps(otherwise));
            }
            Step::Loop(inner) => self.repeat(inner),
            Step::Break | Step::Continue => {
                let jump = self.jump(Op::Jump(0), Span::default());
                let Some(exits) = self.loops.last_mut() else { return };
                match step {
                    Step::Break => exits.breaks.push(jump),
                    _ => exits.continues.push(jump),
                }
            }
            Step::Return(value) => self.give_back(value),
            Step::Inline(result, body, span) => self.inline(*result, body, *span),
        }
    }

    /// Computes the node and drops the result.
    pub(super) fn effect(&mut self, ir: &Ir) {
        match &ir.kind {
            Kind::Fill(view, value) => {
                let src = self.number(value);
                self.emit(Op::Fill(*view, src), ir.span);
            }
            Kind::StoreAll(view, offset, items) => {
                // All values first: an item may read what an earlier one overwrites.
                let first = self.row(items);
                for i in 0..items.len() {
                    let index = self.constant(offset.saturating_add(i) as f64);
                    self.emit(Op::StoreAt(*view, index, Num(first.0 + i as u32)), ir.span);
                }
            }
            Kind::Store(place, op, value) if self.is_plain_store(place, *op, value) => {
                self.store(place, *op, value, ir.span);
            }
            Kind::Update(place, step, _) if self.is_plain_place(place) => {
                self.update(place, *step, crate::ir::Gives::New, ir.span);
            }
            Kind::Invoke(unit, args) => self.invoke(*unit, args, ir.span),
            Kind::Block(steps, value) => {
                self.steps(steps);
                self.effect(value);
            }
            Kind::Constant(_) | Kind::Local(_) => {}
            _ => {
                self.value(ir);
            }
        }
    }

    fn declare(&mut self, local: LocalId, value: &Ir) {
        if self.is_shared(local) {
            let src = self.value(value);
            match self.homes.get(&local).copied() {
                // Functions that were made before hold the place already.
                Some(Home::Cell(cell)) => self.emit(Op::CellSet(cell, src, true), value.span),
                _ => {
                    let cell = self.new_value();
                    self.emit(Op::NewCell(cell, src), value.span);
                    self.homes.insert(local, Home::Cell(cell));
                }
            }
            return;
        }
        let home = match self.homes.get(&local) {
            Some(home) => *home,
            None => self.new_home(local, super::slot(self.tree, local)),
        };
        match home {
            Home::Number(dst) => self.number_to(value, dst),
            Home::Value(dst) | Home::Cell(dst) => self.value_to(value, dst),
        }
    }

    /// `bind` declares every local before its first use.
    pub(super) fn home(&mut self, local: LocalId) -> Home {
        match self.homes.get(&local) {
            Some(home) => *home,
            None => {
                let slot = super::slot(self.tree, local);
                let home = self.new_home(local, slot);
                if let Home::Value(register) = home {
                    let nothing = self.constant_value(&Value::Undefined);
                    self.emit(Op::MoveValue(register, nothing), Span::default());
                }
                home
            }
        }
    }

    pub(super) fn local_value(&mut self, local: LocalId, span: Span) -> Val {
        match self.home(local) {
            Home::Value(register) => register,
            Home::Cell(cell) => self.unary_value(span, |dst| Op::CellGet(dst, cell)),
            Home::Number(register) => {
                let slot = super::slot(self.tree, local);
                self.boxed(register, slot, span)
            }
        }
    }

    fn repeat(&mut self, inner: &Loop) {
        let top = self.unit.ops.len() as u32;
        self.loops.push(Exits::default());
        let mut exit = None;
        let test = |s: &mut Self| {
            let test = inner.test.as_ref()?;
            let holds = s.truth(test);
            Some(s.jump(Op::JumpIf(false, holds, 0), test.span))
        };
        if !inner.late {
            exit = test(self);
        }
        self.steps(&inner.body);
        let continues = self.loops.last_mut().map(|e| std::mem::take(&mut e.continues)).unwrap_or_default();
        continues.into_iter().for_each(|jump| self.land(jump));
        self.steps(&inner.update);
        if inner.late {
            exit = test(self);
        }
        self.emit(Op::Again(top), inner.span);
        let exits = self.loops.pop().unwrap_or_default();
        exits.breaks.into_iter().chain(exit).for_each(|jump| self.land(jump));
    }

    /// Statements in the place of a call: what they return is the value of a local.
    fn inline(&mut self, result: LocalId, body: &[Step], span: Span) {
        let outer = self.site.replace(self.site.unwrap_or(span));
        if let Home::Value(place) = self.home(result) {
            let nothing = self.constant_value(&Value::Undefined);
            self.emit(Op::MoveValue(place, nothing), span);
        }
        self.inlines.push(Inline { result, exits: Vec::new() });
        self.steps(body);
        let done = self.inlines.pop();
        done.into_iter().flat_map(|d| d.exits).for_each(|jump| self.land(jump));
        self.site = outer;
    }

    fn give_back(&mut self, value: &Ir) {
        let span = value.span;
        let Some(result) = self.inlines.last().map(|i| i.result) else {
            return self.leave(Some(value), span);
        };
        match self.home(result) {
            Home::Number(dst) => self.number_to(value, dst),
            Home::Value(dst) | Home::Cell(dst) => self.value_to(value, dst),
        }
        let jump = self.jump(Op::Jump(0), span);
        if let Some(inline) = self.inlines.last_mut() {
            inline.exits.push(jump);
        }
    }

    /// Ends the unit with a value, or with `undefined`.
    pub(super) fn leave(&mut self, value: Option<&Ir>, span: Span) {
        match (value, self.unit.result) {
            (Some(value), Slot::Number | Slot::Boolean) => self.number_to(value, Num(0)),
            (Some(value), Slot::Value) => self.value_to(value, Val(0)),
            (None, _) => {
                let nothing = self.constant_value(&Value::Undefined);
                self.emit(Op::MoveValue(Val(0), nothing), span);
            }
        }
        self.emit(Op::Return, span);
    }
}
