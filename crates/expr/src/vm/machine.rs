//! The state of a run, and its loop over operations.

use std::sync::Arc;

use super::operands::Operands;
use crate::code::{Code, CodeUnit};
use crate::context::Context;
use crate::heap::{MAX_TEXT, Object};
use crate::host::Host;
use crate::natives::{self, Env, Trouble};
use crate::number;
use crate::operation::{select, truth, truthy};
use crate::operators::BinaryOp;
use crate::row::REGISTERS;
use crate::rules;
use crate::runtime_event::{EventKind, RuntimeError, RuntimeEvent};
use crate::ssa::{Num, Op, Slot, Val};
use crate::types::FieldKey;
use crate::value::{Value, View};
use labspec_finding::Span;

/// Work that a run may do. A unit is about a nanosecond of a fast machine.
pub(crate) const MAX_WORK: u64 = 200_000_000;
/// What a call of the host counts besides the work of the host itself, in elements.
pub(super) const HOST_CALL: usize = 10;
/// Functions that may call each other, one inside the other.
pub(super) const MAX_CALLS: usize = 200;
/// Registers for what is handed to a function.
pub(super) const HANDED: usize = 64;

/// Runs a program once. Not inlined: the ways of a formula stay short.
#[inline(never)]
pub(crate) fn run(
    code: &Arc<Code>,
    host: &mut dyn Host,
    context: &mut Context,
    input: Option<&Value>,
) -> Result<Value, RuntimeError> {
    context.events.clear();
    if let Some(watch) = &mut context.watch {
        watch.begin();
    }
    if context.heap.wants_collection() {
        // What the last run left in registers is of no use any more.
        context.values.clear();
        context.collect(input);
    }
    let budget = context.allowed.map_or(MAX_WORK, |left| left.min(MAX_WORK));
    let mut machine = Machine { host, context, input, budget, depth: 0, of_host: 0 };
    let done = machine.whole(code);
    let Machine { context, budget: left, of_host, .. } = machine;
    context.work += budget.saturating_sub(left).saturating_sub(of_host);
    match done {
        Ok(slot) => Ok(taken(slot, context.numbers.first(), context.values.first())),
        Err(error) => Err(*error),
    }
}

/// What a function left in its first registers as its result. Made where it is wanted: to hand a value on is slow.
#[inline(always)]
pub(super) fn taken(slot: Slot, number: Option<&f64>, value: Option<&Value>) -> Value {
    let x = number.copied().unwrap_or(f64::NAN);
    match (slot, value) {
        (Slot::Number, _) => Value::Number(x),
        (Slot::Boolean, _) => Value::Boolean(x != 0.0),
        (Slot::Value, Some(Value::Number(x))) => Value::Number(*x),
        (Slot::Value, value) => value.cloned().unwrap_or_default(),
    }
}

/// Where the registers of a function start.
#[derive(Clone, Copy)]
pub(super) struct Frame {
    pub(super) n: usize,
    pub(super) v: usize,
}

/// The state of a run. Registers and jump targets come from `emit`, which gives out only existing ones.
pub(super) struct Machine<'a> {
    pub(super) host: &'a mut dyn Host,
    pub(super) context: &'a mut Context,
    pub(super) input: Option<&'a Value>,
    /// Work that may still be done.
    pub(super) budget: u64,
    pub(super) depth: usize,
    /// Work that the host did.
    pub(super) of_host: u64,
}

/// Where something went wrong.
pub(super) type Failed = Result<(), Box<RuntimeError>>;

impl Machine<'_> {
    /// Runs the text itself; gives how it left its result.
    #[inline]
    pub(super) fn whole(&mut self, code: &Arc<Code>) -> Result<Slot, Box<RuntimeError>> {
        let Some(unit) = code.units.first() else { return Ok(Slot::Value) };
        let frame = Frame { n: 0, v: 0 };
        self.make_room(unit, frame);
        self.budget = self.budget.saturating_sub(unit.cost);
        self.execute(code, unit, frame)?;
        Ok(unit.result)
    }

    pub(super) fn make_room(&mut self, unit: &CodeUnit, frame: Frame) {
        let numbers = frame.n + (unit.number_count as usize + HANDED).max(REGISTERS);
        if self.context.numbers.len() < numbers {
            self.context.numbers.resize(numbers, 0.0);
        }
        let values = frame.v + unit.value_count as usize + HANDED;
        if self.context.values.len() < values {
            self.context.values.resize(values, Value::Undefined);
        }
    }

    #[inline]
    pub(super) fn num(&self, f: Frame, register: Num) -> f64 {
        self.context.numbers[f.n + register.0 as usize]
    }

    #[inline]
    pub(super) fn val(&self, f: Frame, register: Val) -> &Value {
        &self.context.values[f.v + register.0 as usize]
    }

    #[inline]
    pub(super) fn put(&mut self, f: Frame, register: Num, x: f64) {
        self.context.numbers[f.n + register.0 as usize] = x;
    }

    #[inline]
    pub(super) fn put_value(&mut self, f: Frame, register: Val, value: Value) {
        self.context.values[f.v + register.0 as usize] = value;
    }

    /// Runs a function whose parameters stand in their registers.
    #[inline]
    pub(super) fn execute(&mut self, code: &Arc<Code>, unit: &CodeUnit, f: Frame) -> Failed {
        match self.context.watch {
            None => self.execute_as::<false>(code, unit, f),
            Some(_) => self.execute_as::<true>(code, unit, f),
        }
    }

    /// The same; `WATCHED`: the watch of the context notes what happens.
    pub(super) fn execute_as<const WATCHED: bool>(
        &mut self,
        code: &Arc<Code>,
        unit: &CodeUnit,
        f: Frame,
    ) -> Failed {
        for &(register, x) in &unit.numbers {
            self.put(f, register, x);
        }
        for (register, value) in &unit.values {
            self.put_value(f, *register, value.clone());
        }
        let mut at = 0;
        while let Some(&op) = unit.ops.get(at) {
            at += 1;
            let operands = if WATCHED { self.before(op, unit, f) } else { Operands::NONE };
            match op {
                Op::Jump(to) => at = to as usize,
                Op::JumpIf(when, test, to) => {
                    if WATCHED {
                        self.settle(unit, at - 1);
                    }
                    if truthy(self.num(f, test)) == when {
                        at = to as usize;
                    }
                }
                Op::JumpIfNothing(when, value, to) => {
                    if self.val(f, value).is_nothing() == when {
                        at = to as usize;
                    }
                }
                Op::Again(to, turn) => {
                    let turn = u64::from(turn);
                    if self.budget < turn {
                        self.budget = 0;
                        return Err(failure(natives::out_of_steps(), unit, at - 1));
                    }
                    self.budget -= turn;
                    at = to as usize;
                }
                Op::Return => return Ok(()),

                Op::Load(dst, field, index) => match self.host.get(field, index as usize) {
                    Some(x) => self.put(f, dst, x),
                    None => {
                        let view = View::new(field, 0, None);
                        self.note(EventKind::ReadPastEnd, unit, at - 1, view, f64::from(index));
                        self.put(f, dst, f64::NAN);
                    }
                },
                Op::LoadAt(dst, view, index) => {
                    let x = self.element(view, self.num(f, index), unit, at - 1).unwrap_or(f64::NAN);
                    self.put(f, dst, x);
                }
                Op::LoadValue(dst, view, index) => {
                    let place = (view.first as usize).saturating_add(index as usize);
                    match self.host.get(view.field, place) {
                        Some(x) => self.put_value(f, dst, Value::Number(x)),
                        None => {
                            self.note(EventKind::ReadPastEnd, unit, at - 1, view, f64::from(index));
                            self.put_value(f, dst, Value::Undefined);
                        }
                    }
                }
                Op::LoadValueAt(dst, view, index) => {
                    match self.element(view, self.num(f, index), unit, at - 1) {
                        Some(x) => self.put_value(f, dst, Value::Number(x)),
                        None => self.put_value(f, dst, Value::Undefined),
                    }
                }
                Op::BoxNumber(dst, src) => self.put_value(f, dst, Value::Number(self.num(f, src))),
                Op::Binary(dst, op, a, b) => {
                    let (a, b) = (self.num(f, a), self.num(f, b));
                    self.put(f, dst, op.on_numbers(a, b));
                }
                Op::Unary(dst, op, a) => self.put(f, dst, op.on_number(self.num(f, a))),
                Op::Select(dst, test, a, b) => {
                    self.put(f, dst, self.num(f, select(self.num(f, test), a, b)));
                }
                Op::Move(dst, src) => self.put(f, dst, self.num(f, src)),
                Op::Math(dst, function, args) => {
                    // The arguments behind all registers, where there is room for them.
                    let numbers = &mut self.context.numbers;
                    let (registers, args) = (numbers.len(), args.of(&unit.args));
                    for a in args {
                        numbers.push(numbers[f.n + *a as usize]);
                    }
                    let x = function.apply(numbers.get(registers..).unwrap_or(&[]));
                    numbers.truncate(registers);
                    self.put(f, dst, x);
                }
                Op::Formula(formula) => {
                    // `emit` makes a formula only of registers that a byte can name, and there is room for them.
                    let registers = self.context.numbers.get_mut(f.n..).and_then(<[f64]>::first_chunk_mut);
                    if let (Some((formula, _)), Some(registers)) =
                        (unit.formulas.get(formula as usize), registers)
                    {
                        match self.context.watch.as_deref_mut().filter(|_| WATCHED) {
                            None => formula.run(registers),
                            Some(watch) => formula.watched_run(registers, watch),
                        };
                    }
                }
                Op::PassNumber(k, src) => {
                    let x = self.num(f, src);
                    self.context.numbers[f.n + (unit.number_count + k) as usize] = x;
                }
                Op::PassValue(k, src) => {
                    let value = self.val(f, src).clone();
                    self.context.values[f.v + (unit.value_count + k) as usize] = value;
                }
                Op::Call(callee) => self.call(code, callee, unit, f, at - 1)?,
                Op::TakeNumber(dst) => {
                    let x = self.context.numbers[f.n + unit.number_count as usize];
                    self.put(f, dst, x);
                }
                Op::TakeValue(dst) => {
                    let value = std::mem::take(&mut self.context.values[f.v + unit.value_count as usize]);
                    self.put_value(f, dst, value);
                }
                _ => {
                    if let Err(trouble) = self.step(op, code, unit, f, at - 1) {
                        return Err(match trouble {
                            Stop::Here(trouble) => failure(trouble, unit, at - 1),
                            Stop::Inside(error) => error,
                        });
                    }
                }
            }
            if WATCHED {
                self.after(op, operands, f);
                self.settle(unit, at - 1);
            }
        }
        Ok(())
    }

    /// Calls a function of the same text; what it gets is already in its registers.
    pub(super) fn call(
        &mut self,
        code: &Arc<Code>,
        callee: u32,
        unit: &CodeUnit,
        f: Frame,
        at: usize,
    ) -> Failed {
        let frame = Frame { n: f.n + unit.number_count as usize, v: f.v + unit.value_count as usize };
        let Some(callee) = code.units.get(callee as usize) else { return Ok(()) };
        if let Err(trouble) = self.enter(callee) {
            return Err(failure(trouble, unit, at));
        }
        self.make_room(callee, frame);
        let result = self.execute(code, callee, frame);
        self.depth -= 1;
        result
    }

    /// Counts a call.
    pub(super) fn enter(&mut self, callee: &CodeUnit) -> Result<(), Trouble> {
        if self.depth >= MAX_CALLS {
            let message = format!("function calls are nested more than {MAX_CALLS} levels deep");
            return Err(Trouble::new(rules::CALL_DEPTH, message));
        }
        self.charge(callee.cost)?;
        self.depth += 1;
        Ok(())
    }

    /// Counts work.
    pub(super) fn charge(&mut self, units: u64) -> Result<(), Trouble> {
        natives::charge(&mut self.budget, units)
    }

    /// What natives work with.
    pub(super) fn env<'e>(&'e mut self, code: &'e Code) -> Env<'e> {
        Env {
            heap: &mut self.context.heap,
            host: self.host,
            views: &code.form.views,
            budget: &mut self.budget,
        }
    }

    /// Collects what no register and no variable refers to any more.
    pub(super) fn tidy(&mut self) {
        if self.context.heap.wants_collection() {
            self.context.collect(self.input);
        }
    }

    /// Everything but jumps, calls and plain arithmetic.
    #[inline(never)]
    pub(super) fn step(
        &mut self,
        op: Op,
        code: &Arc<Code>,
        unit: &CodeUnit,
        f: Frame,
        at: usize,
    ) -> Result<(), Stop> {
        match op {
            Op::Length(dst, view) => self.put(f, dst, self.length(view) as f64),
            Op::Input(dst) => self.put_value(f, dst, self.input.cloned().unwrap_or_default()),
            Op::Global(dst, slot) => self.put_value(f, dst, self.context.get(slot).clone()),
            Op::GlobalNumber(dst, slot) => {
                let value = self.context.get(slot).clone();
                let x = self.env(code).number(&value)?;
                self.put(f, dst, x);
            }
            Op::GlobalNamed(dst, name) => {
                let name = self.val(f, name).clone();
                let name = self.env(code).text(&name)?;
                self.put_value(f, dst, self.context.get_named(&name));
            }
            Op::Aggregate(dst, slot) => {
                self.put(f, dst, self.context.aggregates.get(slot as usize).copied().unwrap_or(f64::NAN));
            }

            Op::MoveValue(dst, src) => self.put_value(f, dst, self.val(f, src).clone()),
            Op::BoxBoolean(dst, src) => self.put_value(f, dst, Value::Boolean(self.num(f, src) != 0.0)),
            Op::ToNumber(dst, src) => {
                let x = match self.val(f, src) {
                    Value::Number(x) => *x,
                    value => {
                        let value = value.clone();
                        self.env(code).number(&value)?
                    }
                };
                self.put(f, dst, x);
            }
            Op::ToIndex(dst, src) => self.put(f, dst, index_of(self.val(f, src))),
            Op::Truthy(dst, src) => self.put(f, dst, truth(self.val(f, src).truthy())),
            Op::ToText(dst, src) => {
                let value = self.val(f, src).clone();
                let mut env = self.env(code);
                let text = env.text(&value)?;
                let text = env.string(text)?;
                self.put_value(f, dst, text);
            }
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
                self.env(code).spend(HOST_CALL)?;
                let mut handed = std::mem::take(&mut self.context.handed);
                handed.extend(args.of(&unit.args).iter().map(|a| self.val(f, Val(*a)).clone()));
                let before = self.host.work();
                let result = self.host.call(&mut self.context.heap, function, &handed);
                handed.clear();
                self.context.handed = handed;
                let done = self.host.work().saturating_sub(before).min(self.budget);
                self.of_host += done;
                self.charge(done)?;
                let result = result.map_err(|message| Trouble::new(rules::HOST_CALL, message))?;
                self.put_value(f, dst, result);
            }
            Op::Store(field, index, src) => self.store(field, index as usize, self.num(f, src))?,
            Op::StoreAt(view, index, src) => {
                let written = self.num(f, index);
                match self.position(view, written) {
                    Some(index) => self.store(view.field, index, self.num(f, src))?,
                    None => self.note(EventKind::StorePastEnd, unit, at, view, written),
                }
            }
            Op::StoreGlobal(slot, src) => {
                let value = self.val(f, src).clone();
                self.check_kept(&value)?;
                self.context.set(slot, value);
            }
            Op::StoreGlobalNamed(name, src) => {
                let name = self.val(f, name).clone();
                let name = self.env(code).text(&name)?;
                let value = self.val(f, src).clone();
                self.check_kept(&value)?;
                if !self.context.set_named(&name, value) {
                    return Err(Trouble::new(rules::MEMORY, "too many variables with computed names").into());
                }
            }
            Op::Fill(view, src) => {
                for index in 0..self.length(view) {
                    self.store(view.field, view.first as usize + index, self.num(f, src))?;
                }
            }
            _ => self.part(op, code, unit, f)?,
        }
        Ok(())
    }

    /// Refuses to keep an array of the simulation in `ctx`.
    pub(super) fn check_kept(&self, value: &Value) -> Result<(), Trouble> {
        if matches!(value, Value::View(_)) {
            return Err(Trouble::new(
                rules::WHOLE_ARRAY,
                "`ctx` cannot store an array of the engine; store a copy, as `list.slice()`",
            ));
        }
        Ok(())
    }

    pub(super) fn plus(&mut self, code: &Code, f: Frame, a: Val, b: Val) -> Result<Value, Trouble> {
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
        code: &Code,
        f: Frame,
        op: BinaryOp,
        a: Val,
        b: Val,
    ) -> Result<bool, Trouble> {
        let (a, b) = (self.val(f, a), self.val(f, b));
        let strict = matches!(op, BinaryOp::StrictEqual | BinaryOp::StrictNotEqual);
        let plain = a.is_primitive() && b.is_primitive();
        let equality = op.power() == 8;
        // Things are equal when they are the same thing, and never equal to nothing.
        let things = equality && (!a.is_primitive() && !b.is_primitive() || a.is_nothing() || b.is_nothing());
        if plain || strict || things {
            return Ok(op.on_values(a, b).truthy());
        }
        let (a, b) = (a.clone(), b.clone());
        let mut env = self.env(code);
        let mut primitive = |v: Value| -> Result<Value, Trouble> {
            if v.is_primitive() { Ok(v) } else { Ok(Value::String(env.text(&v)?.into())) }
        };
        let (a, b) = (primitive(a)?, primitive(b)?);
        Ok(op.on_values(&a, &b).truthy())
    }

    /// Number of elements of a view, now.
    pub(super) fn length(&self, view: View) -> usize {
        view.count().unwrap_or_else(|| self.host.len(view.field).saturating_sub(view.first as usize))
    }

    /// The element of the whole field at index `written` of a view, `None` when there is none.
    pub(super) fn position(&self, view: View, written: f64) -> Option<usize> {
        let index = whole_index(written)?;
        if index < self.length(view) { (view.first as usize).checked_add(index) } else { None }
    }

    #[inline]
    pub(super) fn element(&mut self, view: View, written: f64, unit: &CodeUnit, at: usize) -> Option<f64> {
        // No field has more elements than that. The comparison is false for NaN, and for what is not whole.
        let index = written as u32;
        let found = if f64::from(index) == written && view.count().is_none_or(|n| (index as usize) < n) {
            // Of a field without a known length the host knows where it ends.
            self.host.get(view.field, (view.first as usize).saturating_add(index as usize))
        } else {
            None
        };
        if found.is_none() {
            self.note(EventKind::ReadPastEnd, unit, at, view, written);
        }
        found
    }

    pub(super) fn store(&mut self, field: FieldKey, index: usize, x: f64) -> Result<(), Trouble> {
        self.host.set(field, index, x).map_err(|message| Trouble::new(rules::HOST_STORE, message))
    }

    #[cold]
    pub(super) fn note(&mut self, kind: EventKind, unit: &CodeUnit, at: usize, view: View, index: f64) {
        let len = self.length(view);
        self.context.note(RuntimeEvent { kind, span: span_of(unit, at), field: view.field, index, len });
    }
}

/// Why a step ends the run.
pub(super) enum Stop {
    Here(Trouble),
    /// In a function that it called.
    Inside(Box<RuntimeError>),
}

impl From<Trouble> for Stop {
    fn from(trouble: Trouble) -> Stop {
        Stop::Here(trouble)
    }
}

impl From<crate::heap::Full> for Stop {
    fn from(full: crate::heap::Full) -> Stop {
        Stop::Here(full.into())
    }
}

/// A number as an index: whole and not negative.
#[inline]
pub(super) fn whole_index(written: f64) -> Option<usize> {
    // The comparison is false for NaN; a fraction does not survive the round trip.
    let index = if written >= 0.0 { written as usize } else { return None };
    (index as f64 == written).then_some(index)
}

/// The index that a value means as the key of an element: `"1"` is 1, `null` and `"01"` are none.
pub(super) fn index_of(value: &Value) -> f64 {
    match value {
        Value::Number(x) => *x,
        Value::String(text) => {
            let x = number::from_text(text);
            if number::to_text(x) == **text { x } else { f64::NAN }
        }
        _ => f64::NAN,
    }
}

pub(super) fn span_of(unit: &CodeUnit, at: usize) -> Span {
    unit.spans.get(at).copied().unwrap_or_default()
}

#[cold]
pub(super) fn failure(trouble: Trouble, unit: &CodeUnit, at: usize) -> Box<RuntimeError> {
    Box::new(RuntimeError { rule: trouble.rule, span: span_of(unit, at), message: trouble.message })
}

/// What a value is, for a message.
pub(super) fn what(value: &Value, object: &Object) -> String {
    match (value, object) {
        (Value::Undefined | Value::Null, _) => value.to_string(),
        _ => value.type_of().describe().to_owned(),
    }
}
