//! What a watched run records for each operation: whether an operand that is NaN (or `undefined`) became an ordinary value, and
//! the results of comparisons of numbers ([`crate::Watch`]).

use super::machine::{Machine, RegisterFrame, span_of};
use super::operands::Operands;
use crate::code::MachineFunction;
use crate::heap::{Heap, HeapObject};
use crate::natives::{self, NanBehaviour};
use crate::operation::truth;
use crate::operators::BinaryOp;
use crate::ssa::{Args, Num, Op, Val};
use crate::tables::MethodId;
use crate::types::Elem;
use crate::value::Value;

impl Machine<'_> {
    /// Inspects the operands of an operation. A NaN that selects a branch or an element is lost here, whatever the result is.
    pub(super) fn before(&mut self, op: Op, unit: &MachineFunction, f: RegisterFrame) -> Operands {
        let sides = match op {
            Op::Binary(_, op, a, b) => Some((op, self.num(f, a), self.num(f, b))),
            Op::Compare(_, op, a, b) => match (self.val(f, a), self.val(f, b)) {
                (Value::Number(a), Value::Number(b)) => Some((op, *a, *b)),
                _ => None,
            },
            _ => None,
        };
        let nan = match op {
            Op::Binary(..) => sides.is_some_and(|(_, a, b)| a.is_nan() || b.is_nan()),
            Op::Unary(_, _, a) => self.num(f, a).is_nan(),
            Op::Math(_, function, args) => {
                let numbers = args.operands(&unit.args);
                // The minimum or maximum of no arguments is not the value of any measurement.
                (numbers.is_empty() || numbers.iter().any(|n| self.num(f, Num(*n)).is_nan()))
                    && !function.gives_boolean()
            }
            Op::MathOver(_, _, list) => self.is_empty_list(f, list) || self.has_no_number(f, list),
            Op::Compare(_, op, a, b) => self.compares_nan(f, op, a, b),
            Op::Plus(_, a, b) => self.has_no_number(f, a) || self.has_no_number(f, b),
            Op::CallHost(_, _, args) => self.any_without_number(args, unit, f),
            Op::Method(_, name, args) => self.method_tests_nan(name, args, unit, f),
            Op::MethodList(_, name, receiver, list) => {
                self.becomes(name, self.val(f, receiver)).of_elements()
                    && (self.has_no_number(f, receiver) || self.has_no_number(f, list))
            }
            Op::Native(_, function, args) => {
                function.row().nan.of_arguments() && self.any_without_number(args, unit, f)
            }
            Op::NativeList(_, function, list) => {
                function.row().nan.of_arguments() && self.has_no_number(f, list)
            }
            _ => false,
        };
        if self.decides_by_nan(op, f)
            && let Some(watch) = &mut self.context.watch
        {
            watch.lose();
        }
        Operands { nan, sides }
    }

    /// Whether NaN selects a branch, an element or a string in this operation.
    fn decides_by_nan(&self, op: Op, f: RegisterFrame) -> bool {
        match op {
            Op::JumpIf(_, test, _) | Op::Select(_, test, ..) => self.num(f, test).is_nan(),
            Op::LoadAt(_, _, a) | Op::LoadValueAt(_, _, a) | Op::StoreAt(_, a, _) => self.num(f, a).is_nan(),
            Op::ElementAt(_, _, index) => self.num(f, index).is_nan(),
            Op::Truthy(_, a) | Op::ToIndex(_, a) | Op::Element(_, _, a) => self.is_no_number(f, a),
            Op::ToText(_, a) => self.has_no_number(f, a),
            Op::Pick(_, _, a) | Op::PickNumber(_, _, a) | Op::GlobalNamed(_, a) => self.is_no_number(f, a),
            Op::Put(_, a, _) | Op::StoreGlobalNamed(a, _) => self.is_no_number(f, a),
            Op::StoreItem(list, index, value, _) => {
                let whole = match self.context.heap.object(self.val(f, list)) {
                    HeapObject::Numbers(_, elem) => *elem != Elem::Double,
                    _ => false,
                };
                self.is_no_number(f, index) || whole && self.is_no_number(f, value)
            }
            _ => false,
        }
    }

    /// Inspects the result of an operation: if an operand was NaN and the result is not, the NaN was lost.
    pub(super) fn after(&mut self, op: Op, operands: Operands, f: RegisterFrame) {
        let passed = match op {
            Op::Binary(d, ..)
            | Op::Unary(d, ..)
            | Op::Math(d, ..)
            | Op::MathOver(d, ..)
            | Op::Compare(d, ..) => self.num(f, d).is_nan(),
            Op::Plus(d, ..) | Op::CallHost(d, ..) => self.has_no_number(f, d),
            // A list that still contains NaN may have been sorted by comparisons with it.
            Op::Method(d, ..) | Op::MethodList(d, ..) => self.is_no_number(f, d),
            Op::Native(d, ..) | Op::NativeList(d, ..) => self.is_no_number(f, d),
            _ => true,
        };
        let (Op::Binary(dst, ..) | Op::Compare(dst, ..)) = op else {
            if operands.nan && !passed {
                self.lose();
            }
            return;
        };
        if operands.nan && !passed {
            self.lose();
        }
        if let Some((op, a, b)) = operands.sides {
            let x = self.num(f, dst);
            let seen = self.context.watch.as_mut().map_or(x, |watch| watch.compared(op, a, b, x));
            if seen.to_bits() != x.to_bits() {
                self.put(f, dst, truth(seen != 0.0));
            }
        }
    }

    pub(super) fn settle(&mut self, unit: &MachineFunction, pc: usize) {
        if let Some(watch) = &mut self.context.watch {
            watch.settle(span_of(unit, pc));
        }
    }

    fn lose(&mut self) {
        if let Some(watch) = &mut self.context.watch {
            watch.lose();
        }
    }

    /// Whether a value is NaN, or `undefined` if the watch counts that.
    fn is_no_number(&self, f: RegisterFrame, value: Val) -> bool {
        let value = self.val(f, value);
        value.is_primitive() && self.without_number(value)
    }

    /// Whether a value is NaN, or a list that contains NaN.
    fn has_no_number(&self, f: RegisterFrame, value: Val) -> bool {
        self.without_number(self.val(f, value))
    }

    fn without_number(&self, value: &Value) -> bool {
        match value {
            Value::View(view) => {
                let first = view.first as usize;
                (0..self.length(*view)).any(|i| self.host.get(view.field, first + i).is_none_or(f64::is_nan))
            }
            _ => self.context.watch.as_ref().is_some_and(|watch| {
                is_without_number(&self.context.heap, value, watch.counts_undefined(), 8)
            }),
        }
    }

    fn any_without_number(&self, args: Args, unit: &MachineFunction, f: RegisterFrame) -> bool {
        args.operands(&unit.args).iter().any(|a| self.has_no_number(f, Val(*a)))
    }

    fn is_empty_list(&self, f: RegisterFrame, list: Val) -> bool {
        match self.val(f, list) {
            Value::View(view) => self.length(*view) == 0,
            value => self.context.heap.len(value) == Some(0),
        }
    }

    /// Whether a comparison of values has an operand that is not a number. A comparison with `undefined` tests
    /// for it, and loses nothing.
    fn compares_nan(&self, f: RegisterFrame, op: BinaryOp, a: Val, b: Val) -> bool {
        let (a, b) = (self.val(f, a), self.val(f, b));
        let equality = op.power() == 8;
        match (a, b) {
            (Value::Undefined, Value::Undefined) if equality => false,
            (Value::Undefined, other) | (other, Value::Undefined) if equality => other.is_nan(),
            _ => self.without_number(a) || self.without_number(b),
        }
    }

    fn method_tests_nan(&self, name: MethodId, args: Args, unit: &MachineFunction, f: RegisterFrame) -> bool {
        let Some((receiver, args)) = args.operands(&unit.args).split_first() else { return false };
        let nan = self.becomes(name, self.val(f, Val(*receiver)));
        nan.of_elements() && self.has_no_number(f, Val(*receiver))
            || nan.of_arguments() && args.iter().any(|a| self.has_no_number(f, Val(*a)))
    }

    /// How a method of a value treats NaN. A function in a record may do anything with it.
    fn becomes(&self, name: MethodId, receiver: &Value) -> NanBehaviour {
        natives::find_row(&self.context.heap, name, receiver).map_or(NanBehaviour::Looks, |row| row.nan)
    }
}

/// Whether a value is NaN (or `undefined`), or contains one down to a depth.
fn is_without_number(heap: &Heap, value: &Value, undefined: bool, depth: usize) -> bool {
    let inner = |value: &Value| is_without_number(heap, value, undefined, depth - 1);
    match value {
        Value::Number(x) => x.is_nan(),
        Value::Undefined => undefined,
        Value::List(_) | Value::Record(_) if depth > 0 => match heap.object(value) {
            HeapObject::List(items) => items.iter().any(inner),
            HeapObject::Numbers(items, _) => items.iter().any(|x| x.is_nan()),
            HeapObject::Record(entries) => entries.iter().any(|(_, value)| inner(value)),
            _ => false,
        },
        _ => false,
    }
}
