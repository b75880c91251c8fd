//! Assignments to elements of fields, to variables, and to elements of lists and records.

use super::builder::FunctionBuilder;
use crate::ir::{AssignmentTarget, Index, Ir, LocalId, UpdateResult};
use crate::operators::{BinaryOp, LogicalOp};
use crate::ssa::{Num, Op, Operand, Representation, Val};
use crate::types::Type;
use crate::value::View;
use labspec_finding::Span;

/// A target whose operands have been evaluated, so that it can be read and then stored.
enum ResolvedTarget {
    Element(View, Num),
    Fixed(View, u32),
    Global(u32),
    GlobalNamed(Val),
    Local(LocalId),
    /// The flag is `true` if the object is certainly a record.
    Item(Val, Val, bool),
    Member(Val, u32, bool),
}

impl FunctionBuilder<'_> {
    /// Whether a target stores only numbers.
    pub(super) fn is_plain_place(&mut self, place: &AssignmentTarget) -> bool {
        match place {
            AssignmentTarget::Element(..) => true,
            AssignmentTarget::Local(id) => self.slot(*id) == Representation::Number,
            _ => false,
        }
    }

    /// Whether the value that an assignment stores and returns is certainly a number, so that it needs no value register.
    pub(super) fn is_plain_store(
        &mut self,
        place: &AssignmentTarget,
        op: Option<BinaryOp>,
        value: &Ir,
    ) -> bool {
        let number = match op {
            None => value.ty == Type::Number,
            Some(BinaryOp::Add) => value.is_plain(),
            Some(_) => true,
        };
        number && self.is_plain_place(place)
    }

    fn place(&mut self, place: &AssignmentTarget) -> ResolvedTarget {
        match place {
            AssignmentTarget::Element(view, Index::At(i)) if view.count().is_some() => {
                ResolvedTarget::Fixed(*view, view.first.saturating_add(u32::try_from(*i).unwrap_or(u32::MAX)))
            }
            AssignmentTarget::Element(view, index) => {
                // The index is evaluated once, before the value.
                ResolvedTarget::Element(*view, self.index(index))
            }
            AssignmentTarget::Global(slot) => ResolvedTarget::Global(*slot),
            AssignmentTarget::GlobalNamed(name) => ResolvedTarget::GlobalNamed(self.value(name)),
            AssignmentTarget::Local(id) => ResolvedTarget::Local(*id),
            AssignmentTarget::Item(object, index) => {
                ResolvedTarget::Item(self.value(object), self.value(index), object.ty == Type::Record)
            }
            AssignmentTarget::Member(object, name) => {
                ResolvedTarget::Member(self.value(object), self.text(name), object.ty == Type::Record)
            }
        }
    }

    fn load_number(&mut self, found: &ResolvedTarget, span: Span) -> Num {
        match found {
            ResolvedTarget::Fixed(view, index) => {
                self.number_by(span, |dst| Op::Load(dst, view.field, *index))
            }
            ResolvedTarget::Element(view, index) => {
                self.number_by(span, |dst| Op::LoadAt(dst, *view, *index))
            }
            ResolvedTarget::Local(id) if self.slot(*id) != Representation::Value => self.read_number(*id),
            _ => {
                let value = self.load_found(found, span);
                self.number_by(span, |dst| Op::ToNumber(dst, value))
            }
        }
    }

    fn load_found(&mut self, found: &ResolvedTarget, span: Span) -> Val {
        match *found {
            ResolvedTarget::Fixed(view, index) => {
                let number = self.number_by(span, |dst| Op::Load(dst, view.field, index));
                self.boxed(number, Representation::Number, span)
            }
            ResolvedTarget::Element(view, index) => {
                self.value_of(span, |dst| Op::LoadValueAt(dst, view, index))
            }
            ResolvedTarget::Global(slot) => self.value_of(span, |dst| Op::Global(dst, slot)),
            ResolvedTarget::GlobalNamed(name) => self.value_of(span, |dst| Op::GlobalNamed(dst, name)),
            ResolvedTarget::Local(id) => self.local_value(id, span),
            ResolvedTarget::Item(object, index, _) => {
                self.value_of(span, |dst| Op::Element(dst, object, index))
            }
            ResolvedTarget::Member(object, name, _) => {
                self.value_of(span, |dst| Op::Member(dst, object, name))
            }
        }
    }

    fn store_number(&mut self, found: &ResolvedTarget, src: Num, span: Span) {
        match *found {
            ResolvedTarget::Fixed(view, index) => self.emit(Op::Store(view.field, index, src), span),
            ResolvedTarget::Element(view, index) => self.emit(Op::StoreAt(view, index, src), span),
            ResolvedTarget::Local(id) if self.slot(id) != Representation::Value => {
                self.write(id, Operand::Number(src))
            }
            _ => {
                let boxed = self.boxed(src, Representation::Number, span);
                self.store_found(found, boxed, span);
            }
        }
    }

    fn store_found(&mut self, found: &ResolvedTarget, src: Val, span: Span) {
        let op = match *found {
            ResolvedTarget::Fixed(..) | ResolvedTarget::Element(..) => {
                let number = self.number_by(span, |dst| Op::ToNumber(dst, src));
                return self.store_number(found, number, span);
            }
            ResolvedTarget::Local(id) if self.slot(id) != Representation::Value => {
                let number = self.number_by(span, |dst| Op::ToNumber(dst, src));
                return self.write(id, Operand::Number(number));
            }
            ResolvedTarget::Local(id) if self.is_shared(id) => Op::CellSet(self.read_value(id), src, false),
            ResolvedTarget::Local(id) => return self.write(id, Operand::Value(src)),
            ResolvedTarget::Global(slot) => Op::StoreGlobal(slot, src),
            ResolvedTarget::GlobalNamed(name) => Op::StoreGlobalNamed(name, src),
            ResolvedTarget::Item(object, index, record) => Op::StoreItem(object, index, src, record),
            ResolvedTarget::Member(object, name, record) => Op::StoreMember(object, name, src, record),
        };
        self.emit(op, span);
    }

    /// Stores a number, and returns the register of the stored number.
    pub(super) fn store(
        &mut self,
        place: &AssignmentTarget,
        op: Option<BinaryOp>,
        value: &Ir,
        span: Span,
    ) -> Num {
        let found = self.place(place);
        let new = match op {
            None => self.number(value),
            Some(op) => {
                let old = self.load_number(&found, span);
                let value = self.number(value);
                self.number_by(span, |dst| Op::Binary(dst, op, old, value))
            }
        };
        self.store_number(&found, new, span);
        new
    }

    /// Stores a value of any type, and returns the register of the stored value.
    pub(super) fn store_value(
        &mut self,
        place: &AssignmentTarget,
        op: Option<BinaryOp>,
        value: &Ir,
        span: Span,
    ) -> Val {
        let found = self.place(place);
        let new = match op {
            None => self.value(value),
            Some(BinaryOp::Add) => {
                let old = self.load_found(&found, span);
                let value = self.value(value);
                self.value_of(span, |dst| Op::Plus(dst, old, value))
            }
            Some(op) => {
                let old = self.load_number(&found, span);
                let value = self.number(value);
                let result = self.number_by(span, |dst| Op::Binary(dst, op, old, value));
                self.boxed(result, Representation::Number, span)
            }
        };
        self.store_found(&found, new, span);
        new
    }

    /// Evaluates `place ||= value` and similar assignments.
    pub(super) fn store_if(
        &mut self,
        op: LogicalOp,
        place: &AssignmentTarget,
        value: &Ir,
        span: Span,
    ) -> Val {
        let found = self.place(place);
        let (result, old) = (self.temporary(), self.load_found(&found, span));
        self.write(result, Operand::Value(old));
        let test = self.keeps(op, old, span);
        self.skip(test, span, |s| {
            let new = s.value(value);
            s.write(result, Operand::Value(new));
            s.store_found(&found, new, span);
        });
        self.read_value(result)
    }

    /// Evaluates `place++` for a number.
    pub(super) fn update(
        &mut self,
        place: &AssignmentTarget,
        step: f64,
        gives: UpdateResult,
        span: Span,
    ) -> Num {
        let found = self.place(place);
        let step = self.constant(step);
        let old = self.load_number(&found, span);
        let new = self.number_by(span, |dst| Op::Binary(dst, BinaryOp::Add, old, step));
        self.store_number(&found, new, span);
        if gives == UpdateResult::New { new } else { old }
    }

    /// Evaluates `place++` for a value of any type, which is converted to a number.
    pub(super) fn update_value(
        &mut self,
        place: &AssignmentTarget,
        step: f64,
        gives: UpdateResult,
        span: Span,
    ) -> Val {
        let found = self.place(place);
        let old = self.load_number(&found, span);
        let step = self.constant(step);
        let new = self.number_by(span, |dst| Op::Binary(dst, BinaryOp::Add, old, step));
        let boxed = self.boxed(new, Representation::Number, span);
        self.store_found(&found, boxed, span);
        match gives {
            UpdateResult::New => boxed,
            UpdateResult::Old => self.boxed(old, Representation::Number, span),
        }
    }
}
