//! Operations on values and variables, and calls of the host.

use std::sync::Arc;

use super::index::index_of;
use super::machine::{Machine, RegisterFrame, StepError};
use crate::code::{MachineCode, MachineFunction};
use crate::heap::MAX_TEXT;
use crate::natives::{self, NativeError};
use crate::operation::truth;
use crate::operators::BinaryOp;
use crate::rules;
use crate::runtime_event::EventKind;
use crate::ssa::{Num, Op, Val};
use crate::types::FunctionId;
use crate::value::Value;

/// The cost of a call of the host in addition to the work of the host itself, in elements.
const HOST_CALL: usize = 10;

impl Machine<'_> {
    /// Executes any operation except jumps, calls and plain arithmetic. It is one `match`, so that the
    /// dispatch is a single jump.
    #[inline(never)]
    pub(super) fn step(
        &mut self,
        op: Op,
        code: &Arc<MachineCode>,
        unit: &MachineFunction,
        f: RegisterFrame,
        pc: usize,
    ) -> Result<(), StepError> {
        match op {
            Op::Length(dst, view) => self.put(f, dst, self.length(view) as f64),
            Op::Input(dst) => self.put_value(f, dst, self.input.cloned().unwrap_or_default()),
            Op::Global(dst, slot) => self.put_value(f, dst, self.context.get(slot).clone()),
            Op::GlobalNumber(dst, slot) => self.global_number(code, dst, slot, f)?,
            Op::GlobalNamed(dst, name) => self.global_named(code, dst, name, f)?,
            Op::Aggregate(dst, slot) => {
                self.put(f, dst, self.context.aggregates.get(slot as usize).copied().unwrap_or(f64::NAN));
            }

            Op::MoveValue(dst, src) => self.put_value(f, dst, self.val(f, src).clone()),
            Op::BoxBoolean(dst, src) => self.put_value(f, dst, Value::Boolean(self.num(f, src) != 0.0)),
            Op::ToNumber(dst, src) => self.convert_to_number(code, dst, src, f)?,
            Op::ToIndex(dst, src) => self.put(f, dst, index_of(self.val(f, src))),
            Op::Truthy(dst, src) => self.put(f, dst, truth(self.val(f, src).truthy())),
            Op::ToText(dst, src) => self.convert_to_text(code, dst, src, f)?,
            Op::TypeOf(dst, src) => {
                let name = self.val(f, src).type_name();
                self.put_value(f, dst, Value::from(name));
            }
            Op::Plus(dst, a, b) => {
                let sum = self.plus(code, f, a, b)?;
                self.put_value(f, dst, sum);
            }
            Op::Compare(dst, op, a, b) => {
                let holds = self.compare(code, f, op, a, b)?;
                self.put(f, dst, truth(holds));
            }

            Op::CallHost(dst, function, args) => {
                self.call_host(code, dst, function, args.operands(&unit.args), f)?
            }
            Op::Store(field, index, src) => self.store(field, index as usize, self.num(f, src))?,
            Op::StoreAt(view, index, src) => {
                let written = self.num(f, index);
                match self.position(view, written) {
                    Some(index) => self.store(view.field, index, self.num(f, src))?,
                    None => self.note(EventKind::StorePastEnd, unit, pc, view, written),
                }
            }
            Op::StoreGlobal(slot, src) => {
                let value = self.val(f, src).clone();
                self.check_kept(&value)?;
                self.context.set(slot, value);
            }
            Op::StoreGlobalNamed(name, src) => self.store_global_named(code, name, src, f)?,
            Op::Fill(view, src) => {
                for index in 0..self.length(view) {
                    self.store(view.field, view.first as usize + index, self.num(f, src))?;
                }
            }
            _ => self.step_collection(op, code, unit, f)?,
        }
        Ok(())
    }

    #[inline]
    fn global_number(
        &mut self,
        code: &MachineCode,
        dst: Num,
        slot: u32,
        f: RegisterFrame,
    ) -> Result<(), NativeError> {
        let value = self.context.get(slot).clone();
        let x = self.env(code).number(&value)?;
        self.put(f, dst, x);
        Ok(())
    }

    #[inline]
    fn global_named(
        &mut self,
        code: &MachineCode,
        dst: Val,
        name: Val,
        f: RegisterFrame,
    ) -> Result<(), NativeError> {
        let name = self.val(f, name).clone();
        let name = self.env(code).text(&name)?;
        self.put_value(f, dst, self.context.get_named(&name));
        Ok(())
    }

    #[inline]
    fn convert_to_number(
        &mut self,
        code: &MachineCode,
        dst: Num,
        src: Val,
        f: RegisterFrame,
    ) -> Result<(), NativeError> {
        let x = match self.val(f, src) {
            Value::Number(x) => *x,
            value => {
                let value = value.clone();
                self.env(code).number(&value)?
            }
        };
        self.put(f, dst, x);
        Ok(())
    }

    #[inline]
    fn convert_to_text(
        &mut self,
        code: &MachineCode,
        dst: Val,
        src: Val,
        f: RegisterFrame,
    ) -> Result<(), NativeError> {
        let value = self.val(f, src).clone();
        let mut env = self.env(code);
        let text = env.text(&value)?;
        let text = env.string(text)?;
        self.put_value(f, dst, text);
        Ok(())
    }

    /// Calls a function of the host.
    #[inline]
    fn call_host(
        &mut self,
        code: &MachineCode,
        dst: Val,
        function: FunctionId,
        args: &[u32],
        f: RegisterFrame,
    ) -> Result<(), NativeError> {
        self.env(code).spend(HOST_CALL)?;
        let mut handed = std::mem::take(&mut self.context.handed);
        handed.extend(args.iter().map(|a| self.val(f, Val(*a)).clone()));
        let before = self.host.work();
        let result = self.host.call(&mut self.context.heap, function, &handed);
        handed.clear();
        self.context.handed = handed;
        let done = self.host.work().saturating_sub(before).min(self.budget);
        self.of_host += done;
        self.charge(done)?;
        let result = result.map_err(|message| NativeError::new(rules::HOST_CALL, message))?;
        self.put_value(f, dst, result);
        Ok(())
    }

    #[inline]
    fn store_global_named(
        &mut self,
        code: &MachineCode,
        name: Val,
        src: Val,
        f: RegisterFrame,
    ) -> Result<(), NativeError> {
        let name = self.val(f, name).clone();
        let name = self.env(code).text(&name)?;
        let value = self.val(f, src).clone();
        self.check_kept(&value)?;
        if !self.context.set_named(&name, value) {
            return Err(NativeError::new(rules::MEMORY, "too many variables with computed names"));
        }
        Ok(())
    }

    /// Refuses to store an array of the simulation in `ctx`.
    pub(super) fn check_kept(&self, value: &Value) -> Result<(), NativeError> {
        if matches!(value, Value::View(_)) {
            return Err(NativeError::new(
                rules::WHOLE_ARRAY,
                "`ctx` cannot store an array of the model; store a copy, as `list.slice()`",
            ));
        }
        Ok(())
    }

    pub(super) fn plus(
        &mut self,
        code: &MachineCode,
        f: RegisterFrame,
        a: Val,
        b: Val,
    ) -> Result<Value, NativeError> {
        let (a, b) = (self.val(f, a), self.val(f, b));
        if let (Value::Number(a), Value::Number(b)) = (a, b) {
            return Ok(Value::Number(a + b));
        }
        let length = a.text_len() + b.text_len();
        if length > MAX_TEXT {
            return Err(natives::too_long());
        }
        if a.is_primitive() && b.is_primitive() {
            let sum = a.plus(b);
            self.env(code).spend(length / 16)?;
            return Ok(sum);
        }
        let (a, b) = (a.clone(), b.clone());
        let mut env = self.env(code);
        let text = env.text(&a)? + &env.text(&b)?;
        env.string(text)
    }

    pub(super) fn compare(
        &mut self,
        code: &MachineCode,
        f: RegisterFrame,
        op: BinaryOp,
        a: Val,
        b: Val,
    ) -> Result<bool, NativeError> {
        let (a, b) = (self.val(f, a), self.val(f, b));
        let strict = matches!(op, BinaryOp::StrictEqual | BinaryOp::StrictNotEqual);
        let plain = a.is_primitive() && b.is_primitive();
        let equality = op.power() == 8;
        // Lists, records and functions are equal only if they are the same object, and never equal `null` or `undefined`.
        let things = equality && (!a.is_primitive() && !b.is_primitive() || a.is_nothing() || b.is_nothing());
        if plain || strict || things {
            return Ok(op.on_values(a, b).truthy());
        }
        let (a, b) = (a.clone(), b.clone());
        let mut env = self.env(code);
        let mut primitive = |v: Value| -> Result<Value, NativeError> {
            if v.is_primitive() { Ok(v) } else { Ok(Value::String(env.text(&v)?.into())) }
        };
        let (a, b) = (primitive(a)?, primitive(b)?);
        Ok(op.on_values(&a, &b).truthy())
    }
}
