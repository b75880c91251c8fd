//! Calls of methods and of function values, and access to shared variables.

use std::sync::Arc;

use super::collections::describe;
use super::machine::{Machine, RegisterFrame, StepError, result_value};
use crate::code::{MachineCode, MachineFunction};
use crate::heap::HeapObject;
use crate::natives::{self, NativeError};
use crate::rules;
use crate::ssa::{Args, Representation, Val};
use crate::tables::{FreeFunctionId, MethodId};
use crate::value::Value;

impl Machine<'_> {
    /// Calls a function value.
    pub(super) fn invoke_with(
        &mut self,
        unit: &MachineFunction,
        f: RegisterFrame,
        callee: &Value,
        args: &[Value],
    ) -> Result<Value, StepError> {
        let (code, index, captures) = match self.context.heap.object(callee) {
            HeapObject::Closure { code, unit, captures } => (code.clone(), *unit, captures.clone()),
            object => {
                let message = format!("{} is called but is not a function", describe(callee, object));
                return Err(NativeError::new(rules::NOT_CALLABLE, message).into());
            }
        };
        let Some(function) = code.units.get(index as usize) else { return Ok(Value::Undefined) };
        self.enter(function)?;
        let frame = RegisterFrame { n: f.n + unit.number_count as usize, v: f.v + unit.value_count as usize };
        self.make_room(function, frame);
        let (mut n, mut v) = (frame.n + 1, frame.v + 1);
        let params =
            function.params.iter().enumerate().map(|(i, s)| (s, args.get(i).cloned().unwrap_or_default()));
        let captured = function.captures.iter().zip(captures);
        for (slot, value) in params.chain(captured) {
            match slot {
                Representation::Value => {
                    self.context.values[v] = value;
                    v += 1;
                }
                Representation::Number | Representation::Boolean => {
                    self.context.numbers[n] = value.to_number();
                    n += 1;
                }
            }
        }
        let result = self.execute(&code, function, frame);
        self.depth -= 1;
        result.map_err(StepError::Inside)?;
        Ok(result_value(function.result, self.context.numbers.get(frame.n), self.context.values.get(frame.v)))
    }

    /// Evaluates `receiver.name(args)`: a call of a method, or of a function in a record.
    pub(super) fn method(
        &mut self,
        code: &Arc<MachineCode>,
        unit: &MachineFunction,
        f: RegisterFrame,
        name: MethodId,
        receiver: &Value,
        args: &[Value],
    ) -> Result<Value, StepError> {
        if let Value::Record(_) = receiver
            && let Some(function @ Value::Function(_)) = self.context.heap.get(receiver, name.text())
        {
            return self.invoke_with(unit, f, &function, args);
        }
        Ok(natives::call(&mut self.env(code), name, receiver, args)?)
    }

    /// Reads a shared variable.
    #[inline]
    pub(super) fn read_cell(&mut self, dst: Val, cell: Val, f: RegisterFrame) -> Result<(), NativeError> {
        let value = match self.context.heap.object(self.val(f, cell)) {
            HeapObject::Cell(Some(value)) => value.clone(),
            _ => return Err(too_early()),
        };
        self.put_value(f, dst, value);
        Ok(())
    }

    /// Stores a shared variable.
    #[inline]
    pub(super) fn write_cell(
        &mut self,
        cell: Val,
        src: Val,
        declares: bool,
        f: RegisterFrame,
    ) -> Result<(), NativeError> {
        let (cell, value) = (self.val(f, cell).clone(), self.val(f, src).clone());
        match self.context.heap.object_mut(&cell) {
            Some(HeapObject::Cell(place)) if declares || place.is_some() => *place = Some(value),
            _ => return Err(too_early()),
        }
        Ok(())
    }

    /// Calls a method; the receiver is the first argument.
    #[inline]
    pub(super) fn call_method(
        &mut self,
        code: &Arc<MachineCode>,
        unit: &MachineFunction,
        dst: Val,
        name: MethodId,
        args: Args,
        f: RegisterFrame,
    ) -> Result<(), StepError> {
        let args = self.operand_values(args, unit, f);
        let Some((receiver, args)) = args.split_first() else { return Ok(()) };
        let value = self.method(code, unit, f, name, receiver, args)?;
        self.put_value(f, dst, value);
        Ok(())
    }

    /// Calls a method with the elements of a list as arguments.
    #[inline]
    pub(super) fn call_method_with_list(
        &mut self,
        code: &Arc<MachineCode>,
        unit: &MachineFunction,
        dst: Val,
        name: MethodId,
        (receiver, list): (Val, Val),
        f: RegisterFrame,
    ) -> Result<(), StepError> {
        let (receiver, list) = (self.val(f, receiver).clone(), self.val(f, list).clone());
        let args = self.env(code).items(&list)?;
        let value = self.method(code, unit, f, name, &receiver, &args)?;
        self.put_value(f, dst, value);
        Ok(())
    }

    /// Calls a free function with the elements of a list as arguments.
    #[inline]
    pub(super) fn call_free_with_list(
        &mut self,
        code: &MachineCode,
        dst: Val,
        function: FreeFunctionId,
        list: Val,
        f: RegisterFrame,
    ) -> Result<(), NativeError> {
        let list = self.val(f, list).clone();
        let mut env = self.env(code);
        let args = env.items(&list)?;
        let value = natives::call_free(&mut env, function, &args)?;
        self.put_value(f, dst, value);
        Ok(())
    }

    /// Calls a function value with the elements of a list as arguments.
    #[inline]
    pub(super) fn invoke_with_list(
        &mut self,
        code: &MachineCode,
        unit: &MachineFunction,
        dst: Val,
        callee: Val,
        list: Val,
        f: RegisterFrame,
    ) -> Result<(), StepError> {
        let (callee, list) = (self.val(f, callee).clone(), self.val(f, list).clone());
        let args = self.env(code).items(&list)?;
        let value = self.invoke_with(unit, f, &callee, &args)?;
        self.put_value(f, dst, value);
        Ok(())
    }
}

fn too_early() -> NativeError {
    NativeError::new(rules::USED_TOO_EARLY, "a name is used before its declaration runs")
}
