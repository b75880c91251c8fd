//! Typed tree to SSA form, in one walk. Each node is evaluated in the form that its context needs: as a number, as a value of
//! any type, or only as a condition. Thus a numeric expression never becomes a boxed value.

use super::builder::{EarlyExits, FunctionBuilder};
use crate::ir::{Index, Ir, IrEntry, IrItem, IrKind, LocalId};
use crate::operators::{BinaryOp, LogicalOp, UnaryOp};
use crate::ssa::{Args, BlockEdge, Num, Op, Operand, Representation, Terminator, Val};
use crate::tables::UnitId;
use crate::types::Type;
use crate::value::{Value, View};
use labspec_finding::Span;

impl FunctionBuilder<'_> {
    /// Evaluates the node as a number (JavaScript's `Number(x)`).
    pub(super) fn number(&mut self, ir: &Ir) -> Num {
        let span = ir.span;
        match &ir.kind {
            IrKind::Constant(value) if value.is_primitive() => self.constant(value.to_number()),
            IrKind::Load(view, index) => self.load(*view, index, span),
            IrKind::Length(view) => self.number_by(span, |dst| Op::Length(dst, *view)),
            IrKind::Aggregate(slot) => self.number_by(span, |dst| Op::Aggregate(dst, *slot)),
            IrKind::Global(slot) => self.number_by(span, |dst| Op::GlobalNumber(dst, *slot)),
            IrKind::Local(local) => match self.slot(*local) {
                Representation::Value => self.number_of_value(ir),
                _ => self.read_number(*local),
            },
            IrKind::Unary(op, a) => {
                let (op, a) = (*op, if *op == UnaryOp::Not { self.truth(a) } else { self.number(a) });
                self.number_by(span, |dst| Op::Unary(dst, op, a))
            }
            IrKind::ToNumber(a) => self.number(a),
            IrKind::Binary(op, a, b) => self.binary(*op, a, b, ir),
            IrKind::Logical(LogicalOp::Nullish, a, _) if matches!(a.ty, Type::Number | Type::Boolean) => {
                self.number(a)
            }
            IrKind::Logical(LogicalOp::Nullish, ..) => self.number_of_value(ir),
            IrKind::Logical(op, a, b) => self.logical(*op, a, b, span),
            IrKind::Choice(test, a, b) => {
                let result = self.temporary();
                self.choice(test, span, |s| s.number_to(a, result), |s| s.number_to(b, result));
                self.read_number(result)
            }
            IrKind::Math(function, args) => {
                let names: Vec<u32> = args.iter().map(|arg| self.number(arg).0).collect();
                let (function, args) = (*function, self.list_of(&names));
                self.number_by(span, |dst| Op::Math(dst, function, args))
            }
            IrKind::MathOver(function, list) => {
                let (function, list) = (*function, self.value(list));
                self.number_by(span, |dst| Op::MathOver(dst, function, list))
            }
            IrKind::Invoke(unit, args) if self.result_slot(*unit) != Representation::Value => {
                self.invoke(*unit, args, span);
                self.number_by(span, Op::TakeNumber)
            }
            IrKind::Store(place, op, value) if self.is_plain_store(place, *op, value) => {
                self.store(place, *op, value, span)
            }
            IrKind::Update(place, step, gives) if self.is_plain_place(place) => {
                self.update(place, *step, *gives, span)
            }
            IrKind::Block(steps, value) => {
                self.steps(steps);
                self.number(value)
            }
            IrKind::Pick(picks, name) if picks.scalar => {
                let name = self.value(name);
                let table = self.table(picks);
                self.number_by(span, |dst| Op::PickNumber(dst, table, name))
            }
            _ => self.number_of_value(ir),
        }
    }

    fn number_of_value(&mut self, ir: &Ir) -> Num {
        let value = self.value(ir);
        self.number_by(ir.span, |dst| Op::ToNumber(dst, value))
    }

    fn number_to(&mut self, ir: &Ir, place: LocalId) {
        let src = self.number(ir);
        self.write(place, Operand::Number(src));
    }

    /// Evaluates the node as a value of its type.
    pub(super) fn value(&mut self, ir: &Ir) -> Val {
        let span = ir.span;
        match (&ir.kind, ir.ty) {
            (IrKind::Constant(value), _) => self.constant_value(value),
            (IrKind::Fill(..) | IrKind::StoreAll(..), _) => {
                self.effect(ir);
                self.constant_value(&Value::Undefined)
            }
            (IrKind::Call(function, args), _) => {
                let (function, args) = (*function, self.values(args));
                self.value_of(span, |dst| Op::CallHost(dst, function, args))
            }
            (IrKind::Input, _) => self.value_of(span, Op::Input),
            (IrKind::Local(local), _) => self.local_value(*local, span),
            (IrKind::Store(place, op, value), _) if !self.is_plain_store(place, *op, value) => {
                self.store_value(place, *op, value, span)
            }
            (IrKind::StoreIf(op, place, value), _) => self.store_if(*op, place, value, span),
            (IrKind::Update(place, step, gives), _) if !self.is_plain_place(place) => {
                self.update_value(place, *step, *gives, span)
            }
            (IrKind::Block(steps, value), _) => {
                self.steps(steps);
                self.value(value)
            }
            (IrKind::Invoke(unit, args), _) => self.invoked_value(*unit, args, span),
            (IrKind::Pick(picks, name), _) if !picks.scalar => {
                let name = self.value(name);
                let table = self.table(picks);
                self.value_of(span, |dst| Op::Pick(dst, table, name))
            }
            _ => self.value_of_parts(ir),
        }
    }

    /// Evaluates lists, records, their elements, calls of them, and strings.
    fn value_of_parts(&mut self, ir: &Ir) -> Val {
        let span = ir.span;
        match &ir.kind {
            IrKind::InvokeValue(callee, args) => self.invoke_value(callee, args, span),
            IrKind::Method(name, receiver, args) => self.method(*name, receiver, args, span),
            IrKind::Native(function, args) => self.native(*function, args, span),
            IrKind::Closure(unit) => self.closure(*unit, span),
            IrKind::List(items) => self.list(items, span),
            IrKind::Record(entries) => self.record(entries, span),
            IrKind::Element(object, index) => {
                let object = self.value(object);
                if index.ty == Type::Number {
                    let index = self.number(index);
                    return self.value_of(span, |dst| Op::ElementAt(dst, object, index));
                }
                let index = self.value(index);
                self.value_of(span, |dst| Op::Element(dst, object, index))
            }
            IrKind::Member(object, name) => {
                let object = self.value(object);
                let name = self.text(name);
                self.value_of(span, |dst| Op::Member(dst, object, name))
            }
            IrKind::ToText(a) => {
                let a = self.value(a);
                self.value_of(span, |dst| Op::ToText(dst, a))
            }
            IrKind::TypeOf(a) => {
                let a = self.value(a);
                self.value_of(span, |dst| Op::TypeOf(dst, a))
            }
            IrKind::GlobalNamed(name) => {
                let name = self.value(name);
                self.value_of(span, |dst| Op::GlobalNamed(dst, name))
            }
            IrKind::Chain(inner) => self.chain(inner, span),
            // A number register cannot distinguish `undefined` from NaN.
            IrKind::Logical(op @ LogicalOp::Nullish, a, b) => self.logical_value(*op, a, b, span),
            IrKind::Present(object) => self.present(object, span),
            _ => self.value_by_type(ir),
        }
    }

    /// Evaluates a node that is certainly a number or a boolean as a number, and all others as values of any type.
    fn value_by_type(&mut self, ir: &Ir) -> Val {
        let span = ir.span;
        match (&ir.kind, ir.ty) {
            (_, Type::Number) => {
                let src = self.number(ir);
                self.boxed(src, Representation::Number, span)
            }
            (_, Type::Boolean) => {
                let src = self.number(ir);
                self.boxed(src, Representation::Boolean, span)
            }
            (IrKind::Load(view, Index::At(i)), _) if view.count().is_none_or(|n| *i < n) => {
                let index = u32::try_from(*i).unwrap_or(u32::MAX);
                self.value_of(span, |dst| Op::LoadValue(dst, *view, index))
            }
            (IrKind::Load(view, index), _) => {
                let index = self.index(index);
                self.value_of(span, |dst| Op::LoadValueAt(dst, *view, index))
            }
            (IrKind::Global(slot), _) => self.value_of(span, |dst| Op::Global(dst, *slot)),
            (IrKind::Binary(_, a, b), _) => {
                let (a, b) = (self.value(a), self.value(b));
                self.value_of(span, |dst| Op::Plus(dst, a, b))
            }
            (IrKind::Logical(op, a, b), _) => self.logical_value(*op, a, b, span),
            (IrKind::Choice(test, a, b), _) => {
                let result = self.temporary();
                self.choice(test, span, |s| s.value_to(a, result), |s| s.value_to(b, result));
                self.read_value(result)
            }
            // All other kinds of nodes give numbers or booleans.
            _ => {
                let src = self.number(ir);
                self.boxed(src, Representation::Number, span)
            }
        }
    }

    /// Calls a function of the program, and returns its result as a value.
    fn invoked_value(&mut self, unit: UnitId, args: &[Ir], span: Span) -> Val {
        self.invoke(unit, args, span);
        match self.result_slot(unit) {
            Representation::Value => self.value_of(span, Op::TakeValue),
            slot => {
                let number = self.number_by(span, Op::TakeNumber);
                self.boxed(number, slot, span)
            }
        }
    }

    /// Evaluates the operand of `?.`. If it is `null` or `undefined`, control leaves the enclosing chain.
    fn present(&mut self, object: &Ir, span: Span) -> Val {
        let value = self.value(object);
        let mark = self.chains.last().map_or(0, |chain| chain.mark);
        let edge = self.jump_if(Terminator::IfNothing(true, value, BlockEdge::default()), mark, span);
        // A chain always encloses it.
        if let Some(chain) = self.chains.last_mut() {
            chain.exits.extend(edge);
        }
        value
    }

    fn logical_value(&mut self, op: LogicalOp, a: &Ir, b: &Ir, span: Span) -> Val {
        let (result, left) = (self.temporary(), self.value(a));
        self.write(result, Operand::Value(left));
        let test = self.keeps(op, left, span);
        self.skip(test, span, |s| s.value_to(b, result));
        self.read_value(result)
    }

    /// The terminator of a block for the case that the result of `value op …` is `value`.
    pub(super) fn keeps(&mut self, op: LogicalOp, value: Val, span: Span) -> Terminator {
        if op == LogicalOp::Nullish {
            return Terminator::IfNothing(false, value, BlockEdge::default());
        }
        let test = self.number_by(span, |dst| Op::Truthy(dst, value));
        Terminator::If(op == LogicalOp::Or, test, BlockEdge::default())
    }

    fn value_to(&mut self, ir: &Ir, place: LocalId) {
        let src = self.value(ir);
        self.write(place, Operand::Value(src));
    }

    /// Evaluates the node as a number that is truthy exactly when the node is.
    pub(super) fn truth(&mut self, ir: &Ir) -> Num {
        match ir.as_constant() {
            // NaN is false, but stays NaN, so that a watched run records that it decides.
            Some(Value::Number(x)) if x.is_nan() => self.constant(*x),
            Some(value) => self.constant(f64::from(u8::from(value.truthy()))),
            None if ir.is_plain() && !matches!(ir.kind, IrKind::Logical(LogicalOp::Nullish, ..)) => {
                self.number(ir)
            }
            None => {
                let value = self.value(ir);
                self.number_by(ir.span, |dst| Op::Truthy(dst, value))
            }
        }
    }

    pub(super) fn values<'i>(&mut self, items: impl IntoIterator<Item = &'i Ir>) -> Args {
        let names: Vec<u32> = items.into_iter().map(|item| self.value(item).0).collect();
        self.list_of(&names)
    }

    fn load(&mut self, view: View, index: &Index, span: Span) -> Num {
        match (index, view.count()) {
            (Index::At(i), Some(_)) => {
                let element = view.first.saturating_add(u32::try_from(*i).unwrap_or(u32::MAX));
                self.number_by(span, |dst| Op::Load(dst, view.field, element))
            }
            _ => {
                let index = self.index(index);
                self.number_by(span, |dst| Op::LoadAt(dst, view, index))
            }
        }
    }

    pub(super) fn index(&mut self, index: &Index) -> Num {
        match index {
            Index::At(i) => self.constant(*i as f64),
            Index::Computed(ir) if ir.ty == Type::Number => self.number(ir),
            Index::Computed(ir) => {
                let value = self.value(ir);
                self.number_by(ir.span, |dst| Op::ToIndex(dst, value))
            }
        }
    }

    fn binary(&mut self, op: BinaryOp, a: &Ir, b: &Ir, ir: &Ir) -> Num {
        let span = ir.span;
        let plain = match op {
            BinaryOp::Add => ir.ty == Type::Number,
            // Equality of operands of the same type needs no conversion. Ordering does, unless both may be strings.
            _ if op.power() == 8 => a.ty == b.ty && matches!(a.ty, Type::Number | Type::Boolean),
            _ if op.is_comparison() => a.is_plain() || b.is_plain(),
            _ => true,
        };
        if plain {
            let (a, b) = (self.number(a), self.number(b));
            return self.number_by(span, |dst| Op::Binary(dst, op, a, b));
        }
        let (a, b) = (self.value(a), self.value(b));
        if op == BinaryOp::Add {
            let sum = self.value_of(span, |dst| Op::Plus(dst, a, b));
            return self.number_by(span, |dst| Op::ToNumber(dst, sum));
        }
        self.number_by(span, |dst| Op::Compare(dst, op, a, b))
    }

    /// Evaluates `a && b` or `a || b` as a number.
    fn logical(&mut self, op: LogicalOp, a: &Ir, b: &Ir, span: Span) -> Num {
        let result = self.temporary();
        let (left, test) = if a.is_plain() {
            let left = self.number(a);
            (left, left)
        } else {
            // The string "0" is truthy, although its number is 0.
            let value = self.value(a);
            let left = self.number_by(a.span, |dst| Op::ToNumber(dst, value));
            (left, self.number_by(a.span, |dst| Op::Truthy(dst, value)))
        };
        self.write(result, Operand::Number(left));
        let test = Terminator::If(op == LogicalOp::Or, test, BlockEdge::default());
        self.skip(test, span, |s| s.number_to(b, result));
        self.read_number(result)
    }

    pub(super) fn choice(
        &mut self,
        test: &Ir,
        span: Span,
        then: impl FnOnce(&mut Self),
        otherwise: impl FnOnce(&mut Self),
    ) {
        let test = Terminator::If(false, self.truth(test), BlockEdge::default());
        self.build_branches(test, span, then, otherwise);
    }

    fn chain(&mut self, inner: &Ir, span: Span) -> Val {
        let (result, nothing) = (self.temporary(), self.constant_value(&Value::Undefined));
        self.write(result, Operand::Value(nothing));
        let outer = self.chains.len();
        let work = |s: &mut Self, mark| {
            s.chains.push(EarlyExits { mark, result, exits: Vec::new() });
            s.value_to(inner, result);
        };
        self.region(span, work, |s| s.chains.drain(outer..).flat_map(|chain| chain.exits).collect());
        self.read_value(result)
    }

    pub(super) fn list(&mut self, items: &[IrItem], span: Span) -> Val {
        if items.iter().all(|i| !i.spread) {
            let args = self.values(items.iter().map(|i| &i.value));
            return self.value_of(span, |dst| Op::List(dst, args));
        }
        let list = self.value_of(span, |dst| Op::List(dst, Args { first: 0, count: 0 }));
        for item in items {
            let value = self.value(&item.value);
            self.emit(Op::Append(list, value, item.spread), item.value.span);
        }
        list
    }

    fn record(&mut self, entries: &[IrEntry], span: Span) -> Val {
        let record = self.value_of(span, Op::NewRecord);
        for entry in entries {
            match entry {
                IrEntry::Named(key, value) => {
                    let key = self.constant_value(&Value::String(key.clone()));
                    let src = self.value(value);
                    self.emit(Op::Put(record, key, src), value.span);
                }
                IrEntry::Computed(key, value) => {
                    let (key, src) = (self.value(key), self.value(value));
                    self.emit(Op::Put(record, key, src), value.span);
                }
                IrEntry::Spread(value) => {
                    let src = self.value(value);
                    self.emit(Op::PutAll(record, src), value.span);
                }
            }
        }
        record
    }
}
