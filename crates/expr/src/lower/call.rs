//! Calls of functions of the program, calls of methods, and functions as values.

use super::builder::FunctionBuilder;
use crate::ir::{Ir, IrItem, LocalId};
use crate::ssa::{Op, Operand, Representation, Val};
use crate::tables::{FreeFunctionId, MethodId, UnitId};
use crate::value::Value;
use labspec_finding::Span;

impl FunctionBuilder<'_> {
    /// The representation in which a function returns its result.
    pub(super) fn result_slot(&self, unit: UnitId) -> Representation {
        self.tree
            .units
            .get(unit as usize)
            .and_then(|u| u.result)
            .map_or(Representation::Value, Representation::for_type)
    }

    fn params(&self, unit: UnitId) -> Vec<Representation> {
        let params = self.tree.units.get(unit as usize).map(|u| u.params.as_slice()).unwrap_or(&[]);
        params.iter().map(|p| self.slot(*p)).collect()
    }

    fn captures(&self, unit: UnitId) -> Vec<LocalId> {
        self.tree.units.get(unit as usize).map(|u| u.captures.clone()).unwrap_or_default()
    }

    /// Calls a known function. The next operation takes its result.
    pub(super) fn invoke(&mut self, unit: UnitId, args: &[Ir], span: Span) {
        // All arguments are evaluated first, because the evaluation of one may call a function itself.
        let mut passed = Vec::new();
        for (i, slot) in self.params(unit).into_iter().enumerate() {
            passed.push(match (args.get(i), slot) {
                (Some(arg), Representation::Number | Representation::Boolean) => {
                    Operand::Number(self.number(arg))
                }
                (Some(arg), Representation::Value) => Operand::Value(self.value(arg)),
                (None, Representation::Value) => Operand::Value(self.constant_value(&Value::Undefined)),
                (None, _) => Operand::Number(self.constant(f64::NAN)),
            });
        }
        for capture in self.captures(unit) {
            passed.push(match self.slot(capture) {
                // A shared variable is passed as its cell.
                Representation::Value => Operand::Value(self.read_value(capture)),
                _ => Operand::Number(self.read_number(capture)),
            });
        }
        // The first registers of a function are for its result.
        let (mut numbers, mut values) = (1, 1);
        for passed in passed {
            match passed {
                Operand::Number(src) => {
                    self.emit(Op::PassNumber(numbers, src), span);
                    numbers += 1;
                }
                Operand::Value(src) => {
                    self.emit(Op::PassValue(values, src), span);
                    values += 1;
                }
            }
        }
        self.emit(Op::Call(unit), span);
    }

    /// Creates a function value with its captured variables.
    pub(super) fn closure(&mut self, unit: UnitId, span: Span) -> Val {
        let mut names = Vec::new();
        for capture in self.captures(unit) {
            // A shared variable is captured as its cell.
            let shared = self.is_shared(capture);
            let operand = if shared { self.read_value(capture) } else { self.local_value(capture, span) };
            names.push(operand.0);
        }
        let args = self.list_of(&names);
        self.value_of(span, |dst| Op::Closure(dst, unit, args))
    }

    pub(super) fn invoke_value(&mut self, callee: &Ir, args: &[IrItem], span: Span) -> Val {
        let callee = self.value(callee);
        if args.iter().any(|a| a.spread) {
            let list = self.list(args, span);
            return self.value_of(span, |dst| Op::InvokeList(dst, callee, list));
        }
        let args = self.values(args.iter().map(|a| &a.value));
        self.value_of(span, |dst| Op::Invoke(dst, callee, args))
    }

    pub(super) fn method(&mut self, name: MethodId, receiver: &Ir, args: &[IrItem], span: Span) -> Val {
        if args.iter().any(|a| a.spread) {
            let receiver = self.value(receiver);
            let list = self.list(args, span);
            return self.value_of(span, |dst| Op::MethodList(dst, name, receiver, list));
        }
        let args = self.values(std::iter::once(receiver).chain(args.iter().map(|a| &a.value)));
        self.value_of(span, |dst| Op::Method(dst, name, args))
    }

    pub(super) fn native(&mut self, function: FreeFunctionId, args: &[IrItem], span: Span) -> Val {
        if args.iter().any(|a| a.spread) {
            let list = self.list(args, span);
            return self.value_of(span, |dst| Op::NativeList(dst, function, list));
        }
        let args = self.values(args.iter().map(|a| &a.value));
        self.value_of(span, |dst| Op::Native(dst, function, args))
    }
}
