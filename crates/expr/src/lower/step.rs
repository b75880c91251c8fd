//! Statements: declarations, conditions, loops and jumps.

use super::builder::{EarlyExits, FunctionBuilder};
use crate::ir::{Ir, IrKind, IrLoop, IrStatement, LocalId, UpdateResult};
use crate::ssa::{Num, Op, Operand, Representation, Terminator, Val};
use crate::value::Value;
use labspec_finding::Span;

impl FunctionBuilder<'_> {
    pub(super) fn steps(&mut self, steps: &[IrStatement]) {
        for step in steps {
            self.step(step);
        }
    }

    fn step(&mut self, step: &IrStatement) {
        match step {
            IrStatement::Effect(ir) => self.effect(ir),
            IrStatement::Declare(local, value) => self.declare(*local, value),
            IrStatement::Reserve(local) => {
                let cell = self.value_of(Span::default(), Op::EmptyCell);
                self.write(*local, Operand::Value(cell));
            }
            IrStatement::Renew(local) => {
                if self.is_shared(*local) && self.has(*local) {
                    let cell = self.read_value(*local);
                    let old = self.value_of(Span::default(), |dst| Op::CellGet(dst, cell));
                    let new = self.value_of(Span::default(), |dst| Op::NewCell(dst, old));
                    self.write(*local, Operand::Value(new));
                }
            }
            IrStatement::If(test, then, otherwise) => {
                let span = test.span;
                self.choice(test, span, |s| s.steps(then), |s| s.steps(otherwise));
            }
            IrStatement::Loop(inner) => self.repeat(inner),
            IrStatement::Break | IrStatement::Continue => self.leave_iteration(*step == IrStatement::Break),
            IrStatement::Return(value) => self.return_value(value),
            IrStatement::Inline(result, body, span) => self.inline(*result, body, *span),
        }
    }

    /// Evaluates the node and discards the result.
    pub(super) fn effect(&mut self, ir: &Ir) {
        match &ir.kind {
            IrKind::Fill(view, value) => {
                let src = self.number(value);
                self.emit(Op::Fill(*view, src), ir.span);
            }
            IrKind::StoreAll(view, offset, items) => {
                // All values are evaluated first, because an item may read an element that an earlier item overwrites.
                let numbers: Vec<Num> = items.iter().map(|item| self.number(item)).collect();
                for (i, src) in numbers.into_iter().enumerate() {
                    let index = self.constant(offset.saturating_add(i) as f64);
                    self.emit(Op::StoreAt(*view, index, src), ir.span);
                }
            }
            IrKind::Store(place, op, value) if self.is_plain_store(place, *op, value) => {
                self.store(place, *op, value, ir.span);
            }
            IrKind::Update(place, step, _) if self.is_plain_place(place) => {
                self.update(place, *step, UpdateResult::New, ir.span);
            }
            IrKind::Invoke(unit, args) => self.invoke(*unit, args, ir.span),
            IrKind::Block(steps, value) => {
                self.steps(steps);
                self.effect(value);
            }
            IrKind::Constant(_) | IrKind::Local(_) => {}
            _ => {
                self.value(ir);
            }
        }
    }

    fn declare(&mut self, local: LocalId, value: &Ir) {
        if !self.is_shared(local) {
            let operand = self.in_slot(local, value);
            return self.write(local, operand);
        }
        let src = self.value(value);
        if self.has(local) {
            // Functions that were created before already refer to this cell.
            let cell = self.read_value(local);
            return self.emit(Op::CellSet(cell, src, true), value.span);
        }
        let cell = self.value_of(value.span, |dst| Op::NewCell(dst, src));
        self.write(local, Operand::Value(cell));
    }

    /// Evaluates a value in the representation of a local variable.
    fn in_slot(&mut self, local: LocalId, value: &Ir) -> Operand {
        match self.slot(local) {
            Representation::Value => Operand::Value(self.value(value)),
            _ => Operand::Number(self.number(value)),
        }
    }

    pub(super) fn local_value(&mut self, local: LocalId, span: Span) -> Val {
        match self.slot(local) {
            Representation::Value if self.is_shared(local) => {
                let cell = self.read_value(local);
                self.value_of(span, |dst| Op::CellGet(dst, cell))
            }
            Representation::Value => self.read_value(local),
            slot => {
                let number = self.read_number(local);
                self.boxed(number, slot, span)
            }
        }
    }

    fn repeat(&mut self, inner: &IrLoop) {
        self.enter_loop(inner.span);
        let test = |s: &mut Self| {
            if let Some(test) = &inner.test {
                let holds = s.truth(test);
                s.loop_test(holds, test.span);
            }
        };
        if !inner.late {
            test(self);
        }
        self.steps(&inner.body);
        self.join_continues();
        self.steps(&inner.update);
        if inner.late {
            test(self);
        }
        self.leave_loop(inner.span);
    }

    /// Emits the statements of an inlined call. Their result is the value of a local variable.
    fn inline(&mut self, result: LocalId, body: &[IrStatement], span: Span) {
        let outer = self.site.replace(self.site.unwrap_or(span));
        if self.slot(result) == Representation::Value {
            let nothing = self.constant_value(&Value::Undefined);
            self.write(result, Operand::Value(nothing));
        }
        let work = |s: &mut Self, mark| {
            s.inlines.push(EarlyExits { mark, result, exits: Vec::new() });
            s.steps(body);
        };
        self.region(span, work, |s| s.inlines.pop().map(|inline| inline.exits).unwrap_or_default());
        self.site = outer;
    }

    fn return_value(&mut self, value: &Ir) {
        let span = value.span;
        let Some((result, mark)) = self.inlines.last().map(|i| (i.result, i.mark)) else {
            let operand = match self.unit.result {
                Representation::Value => Operand::Value(self.value(value)),
                _ => Operand::Number(self.number(value)),
            };
            return self.end(Terminator::Return(Some(operand)), span);
        };
        let operand = self.in_slot(result, value);
        self.write(result, operand);
        let edge = self.jump(mark, span);
        if let Some(inline) = self.inlines.last_mut() {
            inline.exits.extend(edge);
        }
    }
}
