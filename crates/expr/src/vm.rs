//! The machine: flat operations on two files of registers, one of doubles and one of values of any type.
//!
//! A boolean lives in a number register as 1 or 0; `lower` knows which it is. Constants stand in registers
//! before the first operation. Jumps only go forward, so every run ends.

use crate::code;
use crate::diagnostic::Span;
use crate::ir::View;
use crate::math;
use crate::number;
use crate::operators::BinaryOp;
use crate::program::{Context, EventKind, Host, RuntimeError, RuntimeEvent};
use crate::schema::{FieldKey, FunctionId};
use crate::value::{Value, truthy};

/// A register of numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Num(pub(crate) u32);

/// A register of values.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Val(pub(crate) u32);

/// One operation; the first register is where the result goes.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Op {
    Load(Num, FieldKey, usize),
    LoadAt(Num, View, Num),
    LoadValueAt(Val, View, Num),
    Length(Num, View),
    Input(Val),
    Global(Val, u32),
    GlobalNumber(Num, u32),
    Aggregate(Num, u32),

    Move(Num, Num),
    MoveValue(Val, Val),
    BoxNumber(Val, Num),
    BoxBoolean(Val, Num),
    ToNumber(Num, Val),
    ToIndex(Num, Val),
    Truthy(Num, Val),

    Add(Num, Num, Num),
    Subtract(Num, Num, Num),
    Multiply(Num, Num, Num),
    Divide(Num, Num, Num),
    Binary(Num, BinaryOp, Num, Num),
    Negate(Num, Num),
    Not(Num, Num),
    BitNot(Num, Num),
    Math(Num, math::Function, Num, u32),
    /// `+` of values.
    Plus(Val, Val, Val),
    /// A comparison of values.
    Compare(Num, BinaryOp, Val, Val),

    Jump(u32),
    JumpIf(bool, Num, u32),

    Call(Val, FunctionId, Val, u32),
    Store(FieldKey, usize, Num),
    StoreAt(View, Num, Num),
    StoreGlobal(u32, Val),
    Fill(View, Num),
}

/// A program for the machine.
#[derive(Clone, Debug, Default)]
pub(crate) struct Code {
    pub(crate) ops: Vec<Op>,
    /// Where each operation comes from.
    pub(crate) spans: Vec<Span>,
    /// Constants and the registers that hold them.
    pub(crate) numbers: Vec<(Num, f64)>,
    pub(crate) values: Vec<(Val, Value)>,
    /// Registers used.
    pub(crate) number_count: u32,
    pub(crate) value_count: u32,
    pub(crate) output: Output,
}

/// Where the result stands.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) enum Output {
    #[default]
    Nothing,
    Number(Num),
    Boolean(Num),
    Value(Val),
}

/// The longest string that a program can build, in bytes: a sum that grows with every step must not eat the
/// memory of the page.
const MAX_TEXT: usize = 1 << 20;

/// Runs a program once.
pub(crate) fn run(
    code: &Code,
    host: &mut dyn Host,
    context: &mut Context,
    input: Option<&Value>,
) -> Result<Value, RuntimeError> {
    context.events.clear();
    // Registers are taken out while running, so that the rest of the context stays usable.
    let mut numbers = std::mem::take(&mut context.numbers);
    let mut values = std::mem::take(&mut context.values);
    if numbers.len() < code.number_count as usize {
        numbers.resize(code.number_count as usize, 0.0);
    }
    if values.len() < code.value_count as usize {
        values.resize(code.value_count as usize, Value::Undefined);
    }
    for &(register, x) in &code.numbers {
        numbers[register.0 as usize] = x;
    }
    for (register, value) in &code.values {
        values[register.0 as usize] = value.clone();
    }
    let mut machine = Machine { host, context, input, numbers: &mut numbers, values: &mut values };
    let result = machine.run(code);
    context.numbers = numbers;
    context.values = values;
    result
}

/// The state of a run. Registers and jump targets come from `lower`, which gives out only existing ones.
struct Machine<'a> {
    host: &'a mut dyn Host,
    context: &'a mut Context,
    input: Option<&'a Value>,
    numbers: &'a mut [f64],
    values: &'a mut [Value],
}

impl Machine<'_> {
    fn run(&mut self, code: &Code) -> Result<Value, RuntimeError> {
        let mut at = 0;
        while let Some(&op) = code.ops.get(at) {
            at += 1;
            match op {
                Op::Jump(to) => at = to as usize,
                Op::JumpIf(when, test, to) => {
                    if truthy(self.num(test)) == when {
                        at = to as usize;
                    }
                }
                _ => self.step(op, code, at - 1)?,
            }
        }
        Ok(match code.output {
            Output::Nothing => Value::Undefined,
            Output::Number(r) => Value::Number(self.num(r)),
            Output::Boolean(r) => Value::Boolean(self.num(r) != 0.0),
            Output::Value(r) => self.val(r).clone(),
        })
    }

    #[inline]
    fn num(&self, register: Num) -> f64 {
        self.numbers[register.0 as usize]
    }

    #[inline]
    fn val(&self, register: Val) -> &Value {
        &self.values[register.0 as usize]
    }

    #[inline]
    fn put(&mut self, register: Num, x: f64) {
        self.numbers[register.0 as usize] = x;
    }

    fn put_value(&mut self, register: Val, value: Value) {
        self.values[register.0 as usize] = value;
    }

    /// Everything but jumps.
    #[inline]
    fn step(&mut self, op: Op, code: &Code, at: usize) -> Result<(), RuntimeError> {
        match op {
            Op::Load(dst, field, index) => match self.host.get(field, index) {
                Some(x) => self.put(dst, x),
                None => {
                    let view = View { field, first: 0, count: None };
                    self.note(EventKind::ReadPastEnd, code, at, view, index as f64);
                    self.put(dst, f64::NAN);
                }
            },
            Op::LoadAt(dst, view, index) => {
                let x = self.element(view, self.num(index), code, at).unwrap_or(f64::NAN);
                self.put(dst, x);
            }
            Op::LoadValueAt(dst, view, index) => {
                let x = self.element(view, self.num(index), code, at);
                self.put_value(dst, x.map_or(Value::Undefined, Value::Number));
            }
            Op::Length(dst, view) => self.put(dst, self.length(view) as f64),
            Op::Input(dst) => self.put_value(dst, self.input.cloned().unwrap_or_default()),
            Op::Global(dst, slot) => self.put_value(dst, self.context.get(slot).clone()),
            Op::GlobalNumber(dst, slot) => self.put(dst, self.context.get(slot).to_number()),
            Op::Aggregate(dst, slot) => {
                self.put(dst, self.context.aggregates.get(slot as usize).copied().unwrap_or(f64::NAN));
            }

            Op::Move(dst, src) => self.put(dst, self.num(src)),
            Op::MoveValue(dst, src) => self.put_value(dst, self.val(src).clone()),
            Op::BoxNumber(dst, src) => self.put_value(dst, Value::Number(self.num(src))),
            Op::BoxBoolean(dst, src) => self.put_value(dst, Value::Boolean(self.num(src) != 0.0)),
            Op::ToNumber(dst, src) => self.put(dst, self.val(src).to_number()),
            Op::ToIndex(dst, src) => self.put(dst, index_of(self.val(src))),
            Op::Truthy(dst, src) => self.put(dst, truth(self.val(src).truthy())),

            Op::Add(dst, a, b) => self.put(dst, self.num(a) + self.num(b)),
            Op::Subtract(dst, a, b) => self.put(dst, self.num(a) - self.num(b)),
            Op::Multiply(dst, a, b) => self.put(dst, self.num(a) * self.num(b)),
            Op::Divide(dst, a, b) => self.put(dst, self.num(a) / self.num(b)),
            Op::Binary(dst, op, a, b) => self.put(dst, op.on_numbers(self.num(a), self.num(b))),
            Op::Negate(dst, a) => self.put(dst, -self.num(a)),
            Op::Not(dst, a) => self.put(dst, truth(!truthy(self.num(a)))),
            Op::BitNot(dst, a) => self.put(dst, f64::from(!number::to_int32(self.num(a)))),
            Op::Math(dst, function, first, count) => {
                let first = first.0 as usize;
                self.put(dst, function.apply(&self.numbers[first..first + count as usize]));
            }
            Op::Plus(dst, a, b) => {
                let (a, b) = (self.val(a), self.val(b));
                if a.text_len() + b.text_len() > MAX_TEXT {
                    let message = format!("a string grew beyond {MAX_TEXT} bytes");
                    return Err(failure(code::TEXT_TOO_LONG, code, at, message));
                }
                self.put_value(dst, a.plus(b));
            }
            Op::Compare(dst, op, a, b) => {
                let holds = op.on_values(self.val(a), self.val(b)).truthy();
                self.put(dst, truth(holds));
            }

            Op::Call(dst, function, first, count) => {
                let first = first.0 as usize;
                let args = &self.values[first..first + count as usize];
                let result = self.host.call(function, args);
                self.put_value(dst, result.map_err(|message| failure(code::HOST_CALL, code, at, message))?);
            }
            Op::Store(field, index, src) => self.store(field, index, self.num(src), code, at)?,
            Op::StoreAt(view, index, src) => {
                let written = self.num(index);
                match self.position(view, written) {
                    Some(index) => self.store(view.field, index, self.num(src), code, at)?,
                    None => self.note(EventKind::StorePastEnd, code, at, view, written),
                }
            }
            Op::StoreGlobal(slot, src) => {
                let value = self.val(src).clone();
                self.context.set(slot, value);
            }
            Op::Fill(view, src) => {
                for index in 0..self.length(view) {
                    self.store(view.field, view.first + index, self.num(src), code, at)?;
                }
            }
            Op::Jump(_) | Op::JumpIf(..) => {} // see `run`
        }
        Ok(())
    }

    /// Number of elements of a view, now.
    fn length(&self, view: View) -> usize {
        view.count.unwrap_or_else(|| self.host.len(view.field).saturating_sub(view.first))
    }

    /// The element of the whole field at index `written` of a view, `None` when there is none.
    fn position(&self, view: View, written: f64) -> Option<usize> {
        // The comparison is false for NaN; a fraction does not survive the round trip.
        let index = if written >= 0.0 { written as usize } else { return None };
        let exists = index as f64 == written && index < self.length(view);
        if exists { view.first.checked_add(index) } else { None }
    }

    fn element(&mut self, view: View, written: f64, code: &Code, at: usize) -> Option<f64> {
        let found = self.position(view, written).and_then(|index| self.host.get(view.field, index));
        if found.is_none() {
            self.note(EventKind::ReadPastEnd, code, at, view, written);
        }
        found
    }

    fn store(
        &mut self,
        field: FieldKey,
        index: usize,
        x: f64,
        code: &Code,
        at: usize,
    ) -> Result<(), RuntimeError> {
        self.host.set(field, index, x).map_err(|message| failure(code::HOST_STORE, code, at, message))
    }

    #[cold]
    fn note(&mut self, kind: EventKind, code: &Code, at: usize, view: View, index: f64) {
        let len = self.length(view);
        self.context.note(RuntimeEvent { kind, span: span_of(code, at), field: view.field, index, len });
    }
}

fn truth(holds: bool) -> f64 {
    f64::from(u8::from(holds))
}

/// The index that a value means as the key of an element: `"1"` is 1, `null` and `"01"` are none.
fn index_of(value: &Value) -> f64 {
    match value {
        Value::Number(x) => *x,
        Value::String(text) => {
            let x = number::from_text(text);
            if number::to_text(x) == **text { x } else { f64::NAN }
        }
        _ => f64::NAN,
    }
}

fn span_of(code: &Code, at: usize) -> Span {
    code.spans.get(at).copied().unwrap_or_default()
}

fn failure(name: &'static str, code: &Code, at: usize, message: String) -> RuntimeError {
    RuntimeError { code: name, span: span_of(code, at), message }
}
