//! Assignments: to elements of fields, to variables, and to parts of lists and records.

use super::{Home, Lowering, arithmetic};
use crate::Span;
use crate::ir::{Gives, Index, Ir, Place};
use crate::operators::{BinaryOp, LogicalOp};
use crate::schema::Type;
use crate::value::View;
use crate::vm::{Num, Op, Slot, Val};

/// A place whose parts are computed, so that it can be read and then stored.
enum Found {
    Element(View, Num),
    Fixed(View, u32),
    Global(u32),
    GlobalNamed(Val),
    Number(Num, Slot),
    Value(Val),
    Cell(Val),
    Item(Val, Val),
    Member(Val, u32),
}

impl Lowering<'_> {
    /// Whether a place holds numbers and nothing else.
    pub(super) fn is_plain_place(&mut self, place: &Place) -> bool {
        match place {
            Place::Element(..) => true,
            Place::Local(id) => {
                matches!(self.home(*id), Home::Number(_)) && super::slot(self.tree, *id) == Slot::Number
            }
            _ => false,
        }
    }

    /// Whether what an assignment stores and gives is a number for sure, so that it needs no value register.
    pub(super) fn is_plain_store(&mut self, place: &Place, op: Option<BinaryOp>, value: &Ir) -> bool {
        let number = match op {
            None => value.ty == Type::Number,
            Some(BinaryOp::Add) => value.is_plain(),
            Some(_) => true,
        };
        number && self.is_plain_place(place)
    }

    fn find(&mut self, place: &Place) -> Found {
        match place {
            Place::Element(view, Index::At(i)) if view.count().is_some() => {
                Found::Fixed(*view, view.first.saturating_add(u32::try_from(*i).unwrap_or(u32::MAX)))
            }
            Place::Element(view, index) => {
                // The index is computed before the value, and once.
                let at = self.index(index);
                let at = self.unary(Span::default(), |dst| Op::Move(dst, at));
                Found::Element(*view, at)
            }
            Place::Global(slot) => Found::Global(*slot),
            Place::GlobalNamed(name) => Found::GlobalNamed(self.value(name)),
            Place::Local(id) => match self.home(*id) {
                Home::Number(home) => Found::Number(home, super::slot(self.tree, *id)),
                Home::Value(home) => Found::Value(home),
                Home::Cell(cell) => Found::Cell(cell),
            },
            Place::Item(object, index) => {
                let (object, index) = self.two_values(object, index);
                let object = self.unary_value(Span::default(), |dst| Op::MoveValue(dst, object));
                let index = self.unary_value(Span::default(), |dst| Op::MoveValue(dst, index));
                Found::Item(object, index)
            }
            Place::Member(object, name) => {
                let object = self.value(object);
                let object = self.unary_value(Span::default(), |dst| Op::MoveValue(dst, object));
                Found::Member(object, self.text(name))
            }
        }
    }

    fn load_number(&mut self, found: &Found, span: Span) -> Num {
        match found {
            Found::Fixed(view, at) => self.unary(span, |dst| Op::Load(dst, view.field, *at)),
            Found::Element(view, at) => self.unary(span, |dst| Op::LoadAt(dst, *view, *at)),
            // A copy: the value that is computed next may store there.
            Found::Number(home, _) => self.unary(span, |dst| Op::Move(dst, *home)),
            _ => {
                let value = self.load_found(found, span);
                self.unary(span, |dst| Op::ToNumber(dst, value))
            }
        }
    }

    fn load_found(&mut self, found: &Found, span: Span) -> Val {
        match *found {
            Found::Fixed(view, at) => {
                let number = self.unary(span, |dst| Op::Load(dst, view.field, at));
                self.boxed(number, Slot::Number, span)
            }
            Found::Element(view, at) => self.unary_value(span, |dst| Op::LoadValueAt(dst, view, at)),
            Found::Global(slot) => self.unary_value(span, |dst| Op::Global(dst, slot)),
            Found::GlobalNamed(name) => self.unary_value(span, |dst| Op::GlobalNamed(dst, name)),
            Found::Number(home, slot) => self.boxed(home, slot, span),
            Found::Value(home) => self.unary_value(span, |dst| Op::MoveValue(dst, home)),
            Found::Cell(cell) => self.unary_value(span, |dst| Op::CellGet(dst, cell)),
            Found::Item(object, index) => self.unary_value(span, |dst| Op::Element(dst, object, index)),
            Found::Member(object, name) => self.unary_value(span, |dst| Op::Member(dst, object, name)),
        }
    }

    fn store_number(&mut self, found: &Found, src: Num, span: Span) {
        match *found {
            Found::Fixed(view, at) => self.emit(Op::Store(view.field, at, src), span),
            Found::Element(view, at) => self.emit(Op::StoreAt(view, at, src), span),
            Found::Number(home, _) => self.emit(Op::Move(home, src), span),
            _ => {
                let boxed = self.boxed(src, Slot::Number, span);
                self.store_found(found, boxed, span);
            }
        }
    }

    fn store_found(&mut self, found: &Found, src: Val, span: Span) {
        let op = match *found {
            Found::Fixed(..) | Found::Element(..) | Found::Number(..) => {
                let number = self.unary(span, |dst| Op::ToNumber(dst, src));
                return self.store_number(found, number, span);
            }
            Found::Global(slot) => Op::StoreGlobal(slot, src),
            Found::GlobalNamed(name) => Op::StoreGlobalNamed(name, src),
            Found::Value(home) => Op::MoveValue(home, src),
            Found::Cell(cell) => Op::CellSet(cell, src, false),
            Found::Item(object, index) => Op::StoreItem(object, index, src),
            Found::Member(object, name) => Op::StoreMember(object, name, src),
        };
        self.emit(op, span);
    }

    /// Stores a number; gives the register of what was stored.
    pub(super) fn store(&mut self, place: &Place, op: Option<BinaryOp>, value: &Ir, span: Span) -> Num {
        let found = self.find(place);
        let new = match op {
            None => self.number(value),
            Some(op) => {
                let old = self.load_number(&found, span);
                let value = self.number(value);
                self.unary(span, |dst| arithmetic(dst, op, old, value))
            }
        };
        self.store_number(&found, new, span);
        new
    }

    /// Stores a value of any type; gives the register of what was stored.
    pub(super) fn store_value(&mut self, place: &Place, op: Option<BinaryOp>, value: &Ir, span: Span) -> Val {
        let found = self.find(place);
        let new = match op {
            None => self.value(value),
            Some(BinaryOp::Add) => {
                let old = self.load_found(&found, span);
                let value = self.value(value);
                self.unary_value(span, |dst| Op::Plus(dst, old, value))
            }
            Some(op) => {
                let old = self.load_number(&found, span);
                let value = self.number(value);
                let result = self.unary(span, |dst| arithmetic(dst, op, old, value));
                self.boxed(result, Slot::Number, span)
            }
        };
        self.store_found(&found, new, span);
        new
    }

    /// `place ||= value` and its like.
    pub(super) fn store_if(&mut self, op: LogicalOp, place: &Place, value: &Ir, span: Span) -> Val {
        let found = self.find(place);
        let dst = self.new_value();
        let old = self.load_found(&found, span);
        self.emit(Op::MoveValue(dst, old), span);
        let end = self.keeps(op, dst, span);
        self.value_to(value, dst);
        self.store_found(&found, dst, span);
        self.land(end);
        dst
    }

    /// `place++` of a number.
    pub(super) fn update(&mut self, place: &Place, step: f64, gives: Gives, span: Span) -> Num {
        let found = self.find(place);
        let step = self.constant(step);
        if let (Found::Number(home, _), Gives::New) = (&found, gives) {
            self.emit(Op::Add(*home, *home, step), span);
            return *home;
        }
        let old = self.load_number(&found, span);
        let new = self.unary(span, |dst| Op::Add(dst, old, step));
        self.store_number(&found, new, span);
        if gives == Gives::New { new } else { old }
    }

    /// `place++` of a value of any type, which becomes a number.
    pub(super) fn update_value(&mut self, place: &Place, step: f64, gives: Gives, span: Span) -> Val {
        let found = self.find(place);
        let old = self.load_number(&found, span);
        let step = self.constant(step);
        let new = self.unary(span, |dst| Op::Add(dst, old, step));
        let boxed = self.boxed(new, Slot::Number, span);
        self.store_found(&found, boxed, span);
        match gives {
            Gives::New => boxed,
            Gives::Old => self.boxed(old, Slot::Number, span),
        }
    }
}
