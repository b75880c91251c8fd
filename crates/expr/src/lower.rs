//! Typed tree to code. Each node is computed in the form that its surroundings ask for: as a number, as a value
//! of any type, or only for whether it is true. A numeric expression so never leaves the number registers.

use std::collections::BTreeMap;

use crate::diagnostic::Span;
use crate::ir::{Index, Ir, Kind, Place, Step, View};
use crate::operators::{BinaryOp, LogicalOp};
use crate::schema::Type;
use crate::value::Value;
use crate::vm::{Code, Num, Op, Output, Val};

/// The code of one expression.
pub(crate) fn expression(ir: &Ir) -> Code {
    let mut lowering = Lowering::default();
    lowering.code.output = match ir.ty {
        Type::Number => Output::Number(lowering.number(ir)),
        Type::Boolean => Output::Boolean(lowering.number(ir)),
        _ => Output::Value(lowering.value(ir)),
    };
    lowering.code
}

/// The code of statements.
pub(crate) fn statements(steps: &[Step]) -> Code {
    let mut lowering = Lowering::default();
    for step in steps {
        match step {
            Step::Effect(ir) => lowering.effect(ir),
            Step::Declare { local, fixed, value } => lowering.declare(*local, *fixed, value),
        }
    }
    lowering.code
}

/// Where a local lives.
#[derive(Clone, Copy)]
enum Home {
    Number(Num),
    Value(Val),
}

#[derive(Default)]
struct Lowering {
    code: Code,
    /// Constants by their bits.
    constants: BTreeMap<u64, Num>,
    locals: BTreeMap<u32, Home>,
}

/// A jump whose target is not known yet.
struct Pending(usize);

impl Lowering {
    fn emit(&mut self, op: Op, span: Span) {
        self.code.ops.push(op);
        self.code.spans.push(span);
    }

    fn new_number(&mut self) -> Num {
        self.new_numbers(1)
    }

    /// Registers in a row, of which the first is returned.
    fn new_numbers(&mut self, count: usize) -> Num {
        let first = self.code.number_count;
        self.code.number_count += count as u32;
        Num(first)
    }

    fn new_value(&mut self) -> Val {
        self.new_values(1)
    }

    fn new_values(&mut self, count: usize) -> Val {
        let first = self.code.value_count;
        self.code.value_count += count as u32;
        Val(first)
    }

    /// A jump to a place that [`Self::land`] gives later.
    fn jump(&mut self, op: Op, span: Span) -> Pending {
        self.emit(op, span);
        Pending(self.code.ops.len() - 1)
    }

    fn land(&mut self, jump: Pending) {
        let here = self.code.ops.len() as u32;
        if let Some(Op::Jump(to) | Op::JumpIf(_, _, to)) = self.code.ops.get_mut(jump.0) {
            *to = here;
        }
    }

    fn constant(&mut self, x: f64) -> Num {
        if let Some(&register) = self.constants.get(&x.to_bits()) {
            return register;
        }
        let register = self.new_number();
        self.constants.insert(x.to_bits(), register);
        self.code.numbers.push((register, x));
        register
    }

    fn constant_value(&mut self, value: &Value) -> Val {
        let register = self.new_value();
        self.code.values.push((register, value.clone()));
        register
    }

    /// The register of the node as a number (JavaScript's `Number(x)`).
    fn number(&mut self, ir: &Ir) -> Num {
        let span = ir.span;
        match &ir.kind {
            Kind::Constant(value) => self.constant(value.to_number()),
            Kind::Load(view, index) => self.load(*view, index, span),
            Kind::Length(view) => self.unary(span, |dst| Op::Length(dst, *view)),
            Kind::Aggregate(slot) => self.unary(span, |dst| Op::Aggregate(dst, *slot)),
            Kind::Global(slot) => self.unary(span, |dst| Op::GlobalNumber(dst, *slot)),
            Kind::Local(local) => match self.home(*local) {
                Home::Number(register) => register,
                Home::Value(register) => self.unary(span, |dst| Op::ToNumber(dst, register)),
            },
            Kind::Not(a) => {
                let a = self.truth(a);
                self.unary(span, |dst| Op::Not(dst, a))
            }
            Kind::Negate(a) => {
                let a = self.number(a);
                self.unary(span, |dst| Op::Negate(dst, a))
            }
            Kind::BitNot(a) => {
                let a = self.number(a);
                self.unary(span, |dst| Op::BitNot(dst, a))
            }
            Kind::ToNumber(a) => self.number(a),
            Kind::Binary(op, a, b) => self.binary(*op, a, b, ir),
            Kind::Logical(op, a, b) => self.logical(*op, a, b, span),
            Kind::Choice(test, a, b) => {
                let dst = self.new_number();
                self.choice(test, span, |s| s.number_to(a, dst), |s| s.number_to(b, dst));
                dst
            }
            Kind::Math(function, args) => {
                let (function, count) = (*function, args.len() as u32);
                let first = self.row(args);
                self.unary(span, |dst| Op::Math(dst, function, first, count))
            }
            Kind::Store(place, op, value) if is_plain(place, *op, value) => {
                self.store(place, *op, value, span)
            }
            Kind::Input | Kind::Call(..) | Kind::Store(..) | Kind::Fill(..) | Kind::StoreAll(..) => {
                let value = self.value(ir);
                self.unary(span, |dst| Op::ToNumber(dst, value))
            }
        }
    }

    fn number_to(&mut self, ir: &Ir, dst: Num) {
        let src = self.number(ir);
        self.emit(Op::Move(dst, src), ir.span);
    }

    /// The register of the node as a value of its own type.
    fn value(&mut self, ir: &Ir) -> Val {
        let span = ir.span;
        match (&ir.kind, ir.ty) {
            (Kind::Constant(value), _) => self.constant_value(value),
            (Kind::Fill(..) | Kind::StoreAll(..), _) => {
                self.effect(ir);
                self.constant_value(&Value::Undefined)
            }
            (Kind::Call(function, args), _) => {
                let first = self.value_row(args);
                let (function, count) = (*function, args.len() as u32);
                self.unary_value(span, |dst| Op::Call(dst, function, first, count))
            }
            (Kind::Input, _) => self.unary_value(span, Op::Input),
            (Kind::Store(place, op, value), _) if !is_plain(place, *op, value) => {
                self.store_value(place, *op, value, span)
            }
            (_, Type::Number) => {
                let src = self.number(ir);
                self.unary_value(span, |dst| Op::BoxNumber(dst, src))
            }
            (_, Type::Boolean) => {
                let src = self.number(ir);
                self.unary_value(span, |dst| Op::BoxBoolean(dst, src))
            }
            (Kind::Load(view, index), _) => {
                let index = self.index(index);
                self.unary_value(span, |dst| Op::LoadValueAt(dst, *view, index))
            }
            (Kind::Global(slot), _) => self.unary_value(span, |dst| Op::Global(dst, *slot)),
            (Kind::Local(local), _) => match self.home(*local) {
                Home::Value(register) => register,
                Home::Number(register) => self.unary_value(span, |dst| Op::BoxNumber(dst, register)),
            },
            (Kind::Binary(_, a, b), _) => {
                let (a, b) = self.two_values(a, b);
                self.unary_value(span, |dst| Op::Plus(dst, a, b))
            }
            (Kind::Logical(op, a, b), _) => {
                let dst = self.new_value();
                self.value_to(a, dst);
                let test = self.new_number();
                self.emit(Op::Truthy(test, dst), span);
                let end = self.jump(Op::JumpIf(*op == LogicalOp::Or, test, 0), span);
                self.value_to(b, dst);
                self.land(end);
                dst
            }
            (Kind::Choice(test, a, b), _) => {
                let dst = self.new_value();
                self.choice(test, span, |s| s.value_to(a, dst), |s| s.value_to(b, dst));
                dst
            }
            // All other kinds give numbers or booleans.
            _ => {
                let src = self.number(ir);
                self.unary_value(span, |dst| Op::BoxNumber(dst, src))
            }
        }
    }

    fn value_to(&mut self, ir: &Ir, dst: Val) {
        let src = self.value(ir);
        self.emit(Op::MoveValue(dst, src), ir.span);
    }

    /// A number that is true when the node is.
    fn truth(&mut self, ir: &Ir) -> Num {
        match ir.known() {
            Some(value) => self.constant(f64::from(u8::from(value.truthy()))),
            None if ir.never_text() => self.number(ir),
            None => {
                let value = self.value(ir);
                self.unary(ir.span, |dst| Op::Truthy(dst, value))
            }
        }
    }

    /// Computes the node and drops the result.
    fn effect(&mut self, ir: &Ir) {
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
            Kind::Store(place, op, value) if is_plain(place, *op, value) => {
                self.store(place, *op, value, ir.span);
            }
            _ => {
                self.value(ir);
            }
        }
    }

    fn declare(&mut self, local: u32, fixed: bool, value: &Ir) {
        let home = if fixed && matches!(value.ty, Type::Number | Type::Boolean) {
            let dst = self.new_number();
            self.number_to(value, dst);
            Home::Number(dst)
        } else {
            let dst = self.new_value();
            self.value_to(value, dst);
            Home::Value(dst)
        };
        self.locals.insert(local, home);
    }

    /// `bind` declares every local before its first use.
    fn home(&mut self, local: u32) -> Home {
        match self.locals.get(&local) {
            Some(home) => *home,
            None => Home::Value(self.constant_value(&Value::Undefined)),
        }
    }

    fn unary(&mut self, span: Span, op: impl FnOnce(Num) -> Op) -> Num {
        let dst = self.new_number();
        self.emit(op(dst), span);
        dst
    }

    fn unary_value(&mut self, span: Span, op: impl FnOnce(Val) -> Op) -> Val {
        let dst = self.new_value();
        self.emit(op(dst), span);
        dst
    }

    /// Values of the nodes as numbers, in registers in a row.
    fn row(&mut self, items: &[Ir]) -> Num {
        // A single register is a row already.
        if let [item] = items {
            return self.number(item);
        }
        let sources: Vec<Num> = items.iter().map(|item| self.number(item)).collect();
        let first = self.new_numbers(items.len());
        for (i, (src, item)) in sources.into_iter().zip(items).enumerate() {
            self.emit(Op::Move(Num(first.0 + i as u32), src), item.span);
        }
        first
    }

    fn value_row(&mut self, items: &[Ir]) -> Val {
        let sources: Vec<Val> = items.iter().map(|item| self.value(item)).collect();
        let first = self.new_values(items.len());
        for (i, (src, item)) in sources.into_iter().zip(items).enumerate() {
            self.emit(Op::MoveValue(Val(first.0 + i as u32), src), item.span);
        }
        first
    }

    fn two_values(&mut self, a: &Ir, b: &Ir) -> (Val, Val) {
        let a = self.value(a);
        (a, self.value(b))
    }

    fn load(&mut self, view: View, index: &Index, span: Span) -> Num {
        match (index, view.count) {
            (Index::At(i), Some(_)) => self.unary(span, |dst| Op::Load(dst, view.field, view.first + i)),
            _ => {
                let index = self.index(index);
                self.unary(span, |dst| Op::LoadAt(dst, view, index))
            }
        }
    }

    fn index(&mut self, index: &Index) -> Num {
        match index {
            Index::At(i) => self.constant(*i as f64),
            Index::Computed(ir) if ir.ty == Type::Number => self.number(ir),
            Index::Computed(ir) => {
                let value = self.value(ir);
                self.unary(ir.span, |dst| Op::ToIndex(dst, value))
            }
        }
    }

    fn binary(&mut self, op: BinaryOp, a: &Ir, b: &Ir, ir: &Ir) -> Num {
        let span = ir.span;
        let plain = match op {
            BinaryOp::Add => ir.ty == Type::Number,
            // Equality of one type needs no conversion; order does, unless both may be strings.
            _ if op.power() == 8 => a.ty == b.ty && matches!(a.ty, Type::Number | Type::Boolean),
            _ if op.is_comparison() => a.never_text() || b.never_text(),
            _ => true,
        };
        if plain {
            let (a, b) = (self.number(a), self.number(b));
            return self.unary(span, |dst| arithmetic(dst, op, a, b));
        }
        let (a, b) = self.two_values(a, b);
        if op == BinaryOp::Add {
            let sum = self.unary_value(span, |dst| Op::Plus(dst, a, b));
            return self.unary(span, |dst| Op::ToNumber(dst, sum));
        }
        self.unary(span, |dst| Op::Compare(dst, op, a, b))
    }

    /// `a && b` or `a || b` as a number.
    fn logical(&mut self, op: LogicalOp, a: &Ir, b: &Ir, span: Span) -> Num {
        let dst = self.new_number();
        let test = if a.never_text() {
            self.number_to(a, dst);
            dst
        } else {
            // The text "0" is true, although it is 0 as a number.
            let value = self.value(a);
            self.emit(Op::ToNumber(dst, value), a.span);
            self.unary(a.span, |test| Op::Truthy(test, value))
        };
        let end = self.jump(Op::JumpIf(op == LogicalOp::Or, test, 0), span);
        self.number_to(b, dst);
        self.land(end);
        dst
    }

    fn choice(
        &mut self,
        test: &Ir,
        span: Span,
        then: impl FnOnce(&mut Self),
        otherwise: impl FnOnce(&mut Self),
    ) {
        let test = self.truth(test);
        let skip = self.jump(Op::JumpIf(false, test, 0), span);
        then(self);
        let end = self.jump(Op::Jump(0), span);
        self.land(skip);
        otherwise(self);
        self.land(end);
    }

    /// Stores a number; gives the register of what was stored.
    fn store(&mut self, place: &Place, op: Option<BinaryOp>, value: &Ir, span: Span) -> Num {
        match place {
            Place::Element(view, index) => self.store_element(*view, index, op, value, span),
            Place::Global(slot) => {
                let old = op.map(|_| self.unary(span, |dst| Op::GlobalNumber(dst, *slot)));
                let new = self.combined(old, op, value, span);
                let boxed = self.unary_value(span, |dst| Op::BoxNumber(dst, new));
                self.emit(Op::StoreGlobal(*slot, boxed), span);
                new
            }
            Place::Local(local) => match self.home(*local) {
                Home::Number(home) => {
                    let new = self.combined(Some(home), op, value, span);
                    self.emit(Op::Move(home, new), span);
                    new
                }
                Home::Value(home) => {
                    let old = op.map(|_| self.unary(span, |dst| Op::ToNumber(dst, home)));
                    let new = self.combined(old, op, value, span);
                    self.emit(Op::BoxNumber(home, new), span);
                    new
                }
            },
        }
    }

    /// `old op value`, or just the value.
    fn combined(&mut self, old: Option<Num>, op: Option<BinaryOp>, value: &Ir, span: Span) -> Num {
        let value = self.number(value);
        match (old, op) {
            (Some(old), Some(op)) => self.unary(span, |dst| arithmetic(dst, op, old, value)),
            _ => value,
        }
    }

    /// Stores in a field. The index is computed before the value, and once.
    fn store_element(
        &mut self,
        view: View,
        index: &Index,
        op: Option<BinaryOp>,
        value: &Ir,
        span: Span,
    ) -> Num {
        if let (Index::At(i), Some(_)) = (index, view.count) {
            let at = view.first + i;
            let old = op.map(|_| self.unary(span, |dst| Op::Load(dst, view.field, at)));
            let new = self.combined(old, op, value, span);
            self.emit(Op::Store(view.field, at, new), span);
            return new;
        }
        let index = self.index(index);
        let old = op.map(|_| self.unary(span, |dst| Op::LoadAt(dst, view, index)));
        let new = self.combined(old, op, value, span);
        self.emit(Op::StoreAt(view, index, new), span);
        new
    }

    /// Stores a value of any type, or the result of `+`, which may be text; gives what was stored.
    fn store_value(&mut self, place: &Place, op: Option<BinaryOp>, value: &Ir, span: Span) -> Val {
        match place {
            Place::Element(view, index) => self.store_value_element(*view, index, op, value, span),
            Place::Global(slot) => {
                let old = op.map(|_| self.unary_value(span, |dst| Op::Global(dst, *slot)));
                let new = self.combined_value(old, op, value, span);
                self.emit(Op::StoreGlobal(*slot, new), span);
                new
            }
            Place::Local(local) => match self.home(*local) {
                Home::Value(home) => {
                    // A copy: the value may change the local itself.
                    let old = op.map(|_| self.unary_value(span, |dst| Op::MoveValue(dst, home)));
                    let new = self.combined_value(old, op, value, span);
                    self.emit(Op::MoveValue(home, new), span);
                    new
                }
                Home::Number(home) => {
                    let old = op.map(|_| self.unary_value(span, |dst| Op::BoxNumber(dst, home)));
                    let new = self.combined_value(old, op, value, span);
                    self.emit(Op::ToNumber(home, new), span);
                    new
                }
            },
        }
    }

    fn store_value_element(
        &mut self,
        view: View,
        index: &Index,
        op: Option<BinaryOp>,
        value: &Ir,
        span: Span,
    ) -> Val {
        let index = self.index(index);
        let old = op.map(|_| self.unary_value(span, |dst| Op::LoadValueAt(dst, view, index)));
        let new = self.combined_value(old, op, value, span);
        let number = self.unary(span, |dst| Op::ToNumber(dst, new));
        self.emit(Op::StoreAt(view, index, number), span);
        new
    }

    fn combined_value(&mut self, old: Option<Val>, op: Option<BinaryOp>, value: &Ir, span: Span) -> Val {
        let value = self.value(value);
        match (old, op) {
            (Some(old), Some(BinaryOp::Add)) => self.unary_value(span, |dst| Op::Plus(dst, old, value)),
            (Some(old), Some(op)) => {
                let a = self.unary(span, |dst| Op::ToNumber(dst, old));
                let b = self.unary(span, |dst| Op::ToNumber(dst, value));
                let result = self.unary(span, |dst| arithmetic(dst, op, a, b));
                self.unary_value(span, |dst| Op::BoxNumber(dst, result))
            }
            _ => value,
        }
    }
}

/// Whether what an assignment stores is a number for sure, so that it needs no value register.
fn is_plain(place: &Place, op: Option<BinaryOp>, value: &Ir) -> bool {
    match op {
        None => value.ty == Type::Number,
        Some(BinaryOp::Add) => matches!(place, Place::Element(..)) && value.never_text(),
        Some(_) => true,
    }
}

fn arithmetic(dst: Num, op: BinaryOp, a: Num, b: Num) -> Op {
    match op {
        BinaryOp::Add => Op::Add(dst, a, b),
        BinaryOp::Subtract => Op::Subtract(dst, a, b),
        BinaryOp::Multiply => Op::Multiply(dst, a, b),
        BinaryOp::Divide => Op::Divide(dst, a, b),
        _ => Op::Binary(dst, op, a, b),
    }
}
