//! Calls of functions of the text, of methods, and functions as values.

use super::{Home, Lowering};
use crate::Span;
use crate::ir::{Ir, Item, LocalId, UnitId};
use crate::natives;
use crate::value::Value;
use crate::vm::{Op, Slot, Val};

impl Lowering<'_> {
    /// How a function hands over what it returns.
    pub(super) fn result_slot(&self, unit: UnitId) -> Slot {
        self.tree.units.get(unit as usize).and_then(|u| u.result).map_or(Slot::Value, Slot::of)
    }

    fn params(&self, unit: UnitId) -> Vec<Slot> {
        let params = self.tree.units.get(unit as usize).map(|u| u.params.as_slice()).unwrap_or(&[]);
        params.iter().map(|p| super::slot(self.tree, *p)).collect()
    }

    fn captures(&self, unit: UnitId) -> Vec<LocalId> {
        self.tree.units.get(unit as usize).map(|u| u.captures.clone()).unwrap_or_default()
    }

    /// Calls a known function; what it returns is taken next.
    pub(super) fn invoke(&mut self, unit: UnitId, args: &[Ir], span: Span) {
        // All arguments first: computing one may call a function itself.
        let mut passed = Vec::new();
        for (i, slot) in self.params(unit).into_iter().enumerate() {
            let rest: Vec<&Ir> = args.iter().skip(i + 1).collect();
            passed.push(match (args.get(i), slot) {
                (Some(arg), Slot::Number | Slot::Boolean) => Passed::Number(self.held(arg, &rest)),
                (Some(arg), Slot::Value) => Passed::Value(self.held_value(arg, &rest)),
                (None, Slot::Value) => Passed::Value(self.constant_value(&Value::Undefined)),
                (None, _) => Passed::Number(self.constant(f64::NAN)),
            });
        }
        for capture in self.captures(unit) {
            passed.push(match self.home(capture) {
                Home::Number(home) => Passed::Number(home),
                Home::Value(home) | Home::Cell(home) => Passed::Value(home),
            });
        }
        // The first registers of a function are for its result.
        let (mut numbers, mut values) = (1, 1);
        for passed in passed {
            match passed {
                Passed::Number(src) => {
                    self.emit(Op::PassNumber(numbers, src), span);
                    numbers += 1;
                }
                Passed::Value(src) => {
                    self.emit(Op::PassValue(values, src), span);
                    values += 1;
                }
            }
        }
        self.emit(Op::Call(unit), span);
    }

    /// A function as a value, with what it uses of the functions around it.
    pub(super) fn closure(&mut self, unit: UnitId, span: Span) -> Val {
        let captures = self.captures(unit);
        let mut sources = Vec::new();
        for capture in &captures {
            sources.push(match self.home(*capture) {
                // The shared place itself.
                Home::Cell(cell) => cell,
                _ => self.local_value(*capture, span),
            });
        }
        let first = self.new_values(captures.len());
        for (i, src) in sources.into_iter().enumerate() {
            self.emit(Op::MoveValue(Val(first.0 + i as u32), src), span);
        }
        let count = captures.len() as u32;
        self.unary_value(span, |dst| Op::Closure(dst, unit, first, count))
    }

    pub(super) fn invoke_value(&mut self, callee: &Ir, args: &[Item], span: Span) -> Val {
        let rest: Vec<&Ir> = args.iter().map(|a| &a.value).collect();
        let callee = self.held_value(callee, &rest);
        if args.iter().any(|a| a.spread) {
            let list = self.list(args, span);
            return self.unary_value(span, |dst| Op::InvokeList(dst, callee, list));
        }
        let first = self.value_row(args.iter().map(|a| &a.value));
        let count = args.len() as u32;
        self.unary_value(span, |dst| Op::Invoke(dst, callee, first, count))
    }

    pub(super) fn method(&mut self, name: natives::Name, receiver: &Ir, args: &[Item], span: Span) -> Val {
        if args.iter().any(|a| a.spread) {
            let receiver = self.value(receiver);
            let list = self.list(args, span);
            return self.unary_value(span, |dst| Op::MethodList(dst, name, receiver, list));
        }
        let all: Vec<&Ir> = std::iter::once(receiver).chain(args.iter().map(|a| &a.value)).collect();
        let count = all.len() as u32;
        let first = self.value_row(all);
        self.unary_value(span, |dst| Op::Method(dst, name, first, count))
    }

    pub(super) fn native(&mut self, function: natives::Free, args: &[Item], span: Span) -> Val {
        if args.iter().any(|a| a.spread) {
            let list = self.list(args, span);
            return self.unary_value(span, |dst| Op::NativeList(dst, function, list));
        }
        let first = self.value_row(args.iter().map(|a| &a.value));
        let count = args.len() as u32;
        self.unary_value(span, |dst| Op::Native(dst, function, first, count))
    }
}

/// What is handed to a function.
enum Passed {
    Number(crate::vm::Num),
    Value(Val),
}
