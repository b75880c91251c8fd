//! The state of the virtual machine, and its main loop.

use std::sync::Arc;

use super::operands::Operands;
use crate::code::{MachineCode, MachineFunction};
use crate::context::Context;
use crate::host::Host;
use crate::math;
use crate::natives::{self, Env, NativeError};
use crate::operation::{select, truthy};
use crate::row::REGISTERS;
use crate::rules;
use crate::runtime_event::RuntimeError;
use crate::ssa::{Num, Op, Representation, Val};
use crate::value::Value;
use labspec_finding::Span;

/// The work limit of a run. A unit is about a nanosecond on a fast machine.
pub const MAX_WORK: u64 = 200_000_000;
/// Limit on the depth of nested calls.
pub(super) const MAX_CALLS: usize = 200;
/// Registers for the arguments of a call.
pub(super) const MAX_ARGUMENTS: usize = 64;

/// Runs a program once. Not inlined, so that the code paths of formulas stay short.
#[inline(never)]
pub fn run(
    code: &Arc<MachineCode>,
    host: &mut dyn Host,
    context: &mut Context,
    input: Option<&Value>,
) -> Result<Value, RuntimeError> {
    context.events.clear();
    if let Some(watch) = &mut context.watch {
        watch.begin();
    }
    if context.heap.needs_collection() {
        // The values that the last run left in registers are no longer needed.
        context.values.clear();
        context.collect(input);
    }
    let budget = context.allowed.map_or(MAX_WORK, |left| left.min(MAX_WORK));
    let mut machine = Machine { host, context, input, budget, depth: 0, of_host: 0 };
    let done = machine.whole(code);
    let Machine { context, budget: left, of_host, .. } = machine;
    context.work += budget.saturating_sub(left).saturating_sub(of_host);
    match done {
        Ok(slot) => Ok(result_value(slot, context.numbers.first(), context.values.first())),
        Err(error) => Err(*error),
    }
}

/// The result that a function left in its first registers. It is built by the caller, because returning a `Value` is slow.
#[inline(always)]
pub(super) fn result_value(slot: Representation, number: Option<&f64>, value: Option<&Value>) -> Value {
    let x = number.copied().unwrap_or(f64::NAN);
    match (slot, value) {
        (Representation::Number, _) => Value::Number(x),
        (Representation::Boolean, _) => Value::Boolean(x != 0.0),
        (Representation::Value, Some(Value::Number(x))) => Value::Number(*x),
        (Representation::Value, value) => value.cloned().unwrap_or_default(),
    }
}

/// The first registers of a function.
#[derive(Clone, Copy)]
pub(super) struct RegisterFrame {
    pub(super) n: usize,
    pub(super) v: usize,
}

/// The state of a run. Registers and jump targets come from `emit`, which only uses existing ones.
pub(super) struct Machine<'a> {
    pub(super) host: &'a mut dyn Host,
    pub(super) context: &'a mut Context,
    pub(super) input: Option<&'a Value>,
    /// The remaining work budget.
    pub(super) budget: u64,
    pub(super) depth: usize,
    /// The work of the host.
    pub(super) of_host: u64,
}

/// The result of an operation, or an error with its location.
pub(super) type RunResult = Result<(), Box<RuntimeError>>;

impl Machine<'_> {
    /// Runs the program itself, and returns the representation of its result.
    #[inline]
    pub(super) fn whole(&mut self, code: &Arc<MachineCode>) -> Result<Representation, Box<RuntimeError>> {
        let Some(unit) = code.units.first() else { return Ok(Representation::Value) };
        let frame = RegisterFrame { n: 0, v: 0 };
        self.make_room(unit, frame);
        self.budget = self.budget.saturating_sub(unit.cost);
        self.execute(code, unit, frame)?;
        Ok(unit.result)
    }

    pub(super) fn make_room(&mut self, unit: &MachineFunction, frame: RegisterFrame) {
        let numbers = frame.n + (unit.number_count as usize + MAX_ARGUMENTS).max(REGISTERS);
        if self.context.numbers.len() < numbers {
            self.context.numbers.resize(numbers, 0.0);
        }
        let values = frame.v + unit.value_count as usize + MAX_ARGUMENTS;
        if self.context.values.len() < values {
            self.context.values.resize(values, Value::Undefined);
        }
    }

    #[inline]
    pub(super) fn num(&self, f: RegisterFrame, register: Num) -> f64 {
        self.context.numbers[f.n + register.0 as usize]
    }

    #[inline]
    pub(super) fn val(&self, f: RegisterFrame, register: Val) -> &Value {
        &self.context.values[f.v + register.0 as usize]
    }

    #[inline]
    pub(super) fn put(&mut self, f: RegisterFrame, register: Num, x: f64) {
        self.context.numbers[f.n + register.0 as usize] = x;
    }

    #[inline]
    pub(super) fn put_value(&mut self, f: RegisterFrame, register: Val, value: Value) {
        self.context.values[f.v + register.0 as usize] = value;
    }

    /// Runs a function whose arguments are in its registers.
    #[inline]
    pub(super) fn execute(
        &mut self,
        code: &Arc<MachineCode>,
        unit: &MachineFunction,
        f: RegisterFrame,
    ) -> RunResult {
        match self.context.watch {
            None => self.execute_as::<false>(code, unit, f),
            Some(_) => self.execute_as::<true>(code, unit, f),
        }
    }

    /// As [`Machine::execute`]; with `WATCHED`, the watch of the context records the run. One loop over one `match`: a split
    /// would cost an additional jump for each operation.
    #[expect(
        clippy::too_many_lines,
        reason = "one loop over one match: a split costs a jump for each operation that runs"
    )]
    fn execute_as<const WATCHED: bool>(
        &mut self,
        code: &Arc<MachineCode>,
        unit: &MachineFunction,
        f: RegisterFrame,
    ) -> RunResult {
        self.put_constants(unit, f);
        let mut pc = 0;
        while let Some(&op) = unit.ops.get(pc) {
            pc += 1;
            let operands = if WATCHED { self.before(op, unit, f) } else { Operands::NONE };
            match op {
                Op::Jump(to) => pc = to as usize,
                Op::JumpIf(when, test, to) => {
                    if WATCHED {
                        self.settle(unit, pc - 1);
                    }
                    if truthy(self.num(f, test)) == when {
                        pc = to as usize;
                    }
                }
                Op::JumpIfNothing(when, value, to) => {
                    if self.val(f, value).is_nothing() == when {
                        pc = to as usize;
                    }
                }
                Op::Again(to, turn) => {
                    self.count_iteration(u64::from(turn), unit, pc - 1)?;
                    pc = to as usize;
                }
                Op::Return => return Ok(()),

                Op::Load(dst, field, index) => self.load(dst, field, index, unit, f, pc - 1),
                Op::LoadAt(dst, view, index) => {
                    let x = self.element(view, self.num(f, index), unit, pc - 1).unwrap_or(f64::NAN);
                    self.put(f, dst, x);
                }
                Op::LoadValue(dst, view, index) => self.load_value(dst, view, index, unit, f, pc - 1),
                Op::LoadValueAt(dst, view, index) => self.load_value_at(dst, view, index, unit, f, pc - 1),
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
                Op::Math(dst, function, args) => self.apply_math(dst, function, args.operands(&unit.args), f),
                Op::Formula(formula) => self.run_formula::<WATCHED>(formula, unit, f),
                Op::PassNumber(k, src) => {
                    let x = self.num(f, src);
                    self.context.numbers[f.n + (unit.number_count + k) as usize] = x;
                }
                Op::PassValue(k, src) => {
                    let value = self.val(f, src).clone();
                    self.context.values[f.v + (unit.value_count + k) as usize] = value;
                }
                Op::Call(callee) => self.call(code, callee, unit, f, pc - 1)?,
                Op::TakeNumber(dst) => self.put(f, dst, self.num(f, Num(unit.number_count))),
                Op::TakeValue(dst) => {
                    let value = std::mem::take(&mut self.context.values[f.v + unit.value_count as usize]);
                    self.put_value(f, dst, value);
                }
                _ => {
                    if let Err(stop) = self.step(op, code, unit, f, pc - 1) {
                        return Err(stop.at(unit, pc - 1));
                    }
                }
            }
            if WATCHED {
                self.after(op, operands, f);
                self.settle(unit, pc - 1);
            }
        }
        Ok(())
    }

    #[inline(always)]
    fn put_constants(&mut self, unit: &MachineFunction, f: RegisterFrame) {
        for &(register, x) in &unit.numbers {
            self.put(f, register, x);
        }
        for (register, value) in &unit.values {
            self.put_value(f, *register, value.clone());
        }
    }

    /// Applies a function of `Math`. The arguments are copied to the free space after all registers.
    #[inline(always)]
    fn apply_math(&mut self, dst: Num, function: math::MathFunction, args: &[u32], f: RegisterFrame) {
        let numbers = &mut self.context.numbers;
        let registers = numbers.len();
        for a in args {
            numbers.push(numbers[f.n + *a as usize]);
        }
        let x = function.apply(numbers.get(registers..).unwrap_or(&[]));
        numbers.truncate(registers);
        self.put(f, dst, x);
    }

    /// Evaluates a formula. `emit` uses only registers below 256 in formulas, and these exist.
    #[inline(always)]
    fn run_formula<const WATCHED: bool>(&mut self, formula: u32, unit: &MachineFunction, f: RegisterFrame) {
        let registers = self.context.numbers.get_mut(f.n..).and_then(<[f64]>::first_chunk_mut);
        if let (Some((formula, _)), Some(registers)) = (unit.formulas.get(formula as usize), registers) {
            match self.context.watch.as_deref_mut().filter(|_| WATCHED) {
                None => formula.run(registers),
                Some(watch) => formula.watched_run(registers, watch),
            };
        }
    }

    /// Subtracts the cost of an iteration of a loop.
    #[inline(always)]
    fn count_iteration(&mut self, turn: u64, unit: &MachineFunction, pc: usize) -> RunResult {
        if self.budget < turn {
            self.budget = 0;
            return Err(failure(natives::out_of_steps(), unit, pc));
        }
        self.budget -= turn;
        Ok(())
    }

    /// Calls a function of the same program; its arguments are already in its registers.
    pub(super) fn call(
        &mut self,
        code: &Arc<MachineCode>,
        callee: u32,
        unit: &MachineFunction,
        f: RegisterFrame,
        pc: usize,
    ) -> RunResult {
        let frame = RegisterFrame { n: f.n + unit.number_count as usize, v: f.v + unit.value_count as usize };
        let Some(callee) = code.units.get(callee as usize) else { return Ok(()) };
        if let Err(fault) = self.enter(callee) {
            return Err(failure(fault, unit, pc));
        }
        self.make_room(callee, frame);
        let result = self.execute(code, callee, frame);
        self.depth -= 1;
        result
    }

    /// Checks the depth of calls, and subtracts the cost of a call.
    pub(super) fn enter(&mut self, callee: &MachineFunction) -> Result<(), NativeError> {
        if self.depth >= MAX_CALLS {
            let message = format!("function calls are nested more than {MAX_CALLS} levels deep");
            return Err(NativeError::new(rules::CALL_DEPTH, message));
        }
        self.charge(callee.cost)?;
        self.depth += 1;
        Ok(())
    }

    /// Subtracts work from the budget.
    pub(super) fn charge(&mut self, units: u64) -> Result<(), NativeError> {
        natives::charge(&mut self.budget, units)
    }

    /// The environment for methods and free functions.
    pub(super) fn env<'e>(&'e mut self, code: &'e MachineCode) -> Env<'e> {
        Env {
            heap: &mut self.context.heap,
            host: self.host,
            views: &code.form.views,
            budget: &mut self.budget,
        }
    }

    /// Frees objects to which no register and no variable refers, if enough memory was allocated.
    pub(super) fn collect_garbage(&mut self) {
        if self.context.heap.needs_collection() {
            self.context.collect(self.input);
        }
    }
}

/// The error of an operation.
pub(super) enum StepError {
    Here(NativeError),
    /// The error occurred inside a called function.
    Inside(Box<RuntimeError>),
}

impl StepError {
    /// The error with the location of the operation.
    #[cold]
    fn at(self, unit: &MachineFunction, pc: usize) -> Box<RuntimeError> {
        match self {
            StepError::Here(fault) => failure(fault, unit, pc),
            StepError::Inside(error) => error,
        }
    }
}

impl From<NativeError> for StepError {
    fn from(fault: NativeError) -> StepError {
        StepError::Here(fault)
    }
}

impl From<crate::heap::Full> for StepError {
    fn from(full: crate::heap::Full) -> StepError {
        StepError::Here(full.into())
    }
}

pub(super) fn span_of(unit: &MachineFunction, pc: usize) -> Span {
    unit.spans.get(pc).copied().unwrap_or_default()
}

#[cold]
fn failure(fault: NativeError, unit: &MachineFunction, pc: usize) -> Box<RuntimeError> {
    Box::new(RuntimeError { rule: fault.rule, span: span_of(unit, pc), message: fault.message })
}
