//! Numeric expressions without effects: a list of operations, each on results of operations before it. One list serves
//! both ways to run it: once for the state at hand (`row`), or over columns of recorded samples (`columnar`).
//!
//! Made from the code of the machine by following it: where it may go two ways, both are computed and one is chosen.

use std::collections::BTreeMap;

use crate::math;
use crate::operators::BinaryOp;
use crate::schema::FieldKey;
use crate::vm::{CodeUnit, Num, Op, Slot};

/// Most arguments of a function of `Math`; expressions with more of them are left to the machine.
pub(crate) const ARGS: usize = 16;
/// Most operations.
const STEPS: usize = 256;
/// Most choices.
const CHOICES: usize = 16;

/// The number of an operation, and so of its result.
pub(crate) type At = u32;

/// One operation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Step {
    Constant(f64),
    Load(FieldKey, u32),
    Add(At, At),
    Subtract(At, At),
    Multiply(At, At),
    Divide(At, At),
    AddConstant(At, f64),
    MultiplyConstant(At, f64),
    /// The constant less the operand.
    SubtractFrom(f64, At),
    Binary(BinaryOp, At, At),
    Negate(At),
    Not(At),
    BitNot(At),
    /// By the truth of the first: the second or the third.
    Choose(At, At, At),
    /// First and number of its arguments in the list of arguments.
    Math(math::Function, u32, u32),
}

impl Step {
    /// The operations whose results it uses, those of functions excepted.
    fn operands(&mut self) -> [Option<&mut At>; 3] {
        match self {
            Step::Constant(_) | Step::Load(..) | Step::Math(..) => [None, None, None],
            Step::Add(a, b) | Step::Subtract(a, b) | Step::Multiply(a, b) => [Some(a), Some(b), None],
            Step::Divide(a, b) | Step::Binary(_, a, b) => [Some(a), Some(b), None],
            Step::AddConstant(a, _) | Step::MultiplyConstant(a, _) | Step::SubtractFrom(_, a) => {
                [Some(a), None, None]
            }
            Step::Negate(a) | Step::Not(a) | Step::BitNot(a) => [Some(a), None, None],
            Step::Choose(a, b, c) => [Some(a), Some(b), Some(c)],
        }
    }
}

/// An expression as a list of operations.
#[derive(Clone, Debug)]
pub(crate) struct Formula {
    /// Constants come first.
    pub(crate) steps: Vec<Step>,
    args: Vec<At>,
    pub(crate) output: At,
    /// It gives 1 or 0 for a truth value.
    pub(crate) truth: bool,
}

impl Formula {
    /// The operations of a text that gives a number or a truth value; `None` when its value depends on more than
    /// elements of fields at known indexes.
    pub(crate) fn of(unit: &CodeUnit) -> Option<Formula> {
        if unit.result == Slot::Value {
            return None;
        }
        let mut build = Build { unit, steps: Vec::new(), args: Vec::new(), choices: 0 };
        let mut registers = Registers::new();
        for &(register, x) in &unit.numbers {
            registers.insert(register.0, build.step(Step::Constant(x)));
        }
        let known = build.steps.len();
        let output = build.follow(0, registers)?;
        let truth = unit.result == Slot::Boolean;
        let mut formula = Formula { steps: build.steps, args: build.args, output, truth };
        formula.drop_unused(known);
        Some(formula)
    }

    /// Leaves out those of the `known` constants in front that became part of operations.
    fn drop_unused(&mut self, known: usize) {
        let mut used = vec![false; self.steps.len()];
        let Formula { steps, args, output, .. } = self;
        let mut mark = |at: &mut At| {
            if let Some(place) = used.get_mut(*at as usize) {
                *place = true;
            }
        };
        steps.iter_mut().for_each(|s| s.operands().into_iter().flatten().for_each(&mut mark));
        args.iter_mut().chain([&mut *output]).for_each(&mut mark);
        let mut kept = 0;
        let places: Vec<At> = used
            .iter()
            .enumerate()
            .map(|(i, used)| {
                let at = kept;
                kept += At::from(*used || i >= known);
                at
            })
            .collect();
        let mut moved = |at: &mut At| *at = places.get(*at as usize).copied().unwrap_or(*at);
        steps.iter_mut().for_each(|s| s.operands().into_iter().flatten().for_each(&mut moved));
        args.iter_mut().chain([output]).for_each(&mut moved);
        let keeps = |i: usize| i >= known || used.get(i).copied().unwrap_or(true);
        let mut at = 0..;
        steps.retain(|_| at.next().is_none_or(keeps));
    }

    /// The arguments of a function of `Math`.
    pub(crate) fn args(&self, first: u32, count: u32) -> &[At] {
        self.args.get(first as usize..(first + count) as usize).unwrap_or(&[])
    }
}

/// The operation that last stored into each register of the machine.
type Registers = BTreeMap<u32, At>;

/// The work on one expression.
struct Build<'c> {
    unit: &'c CodeUnit,
    steps: Vec<Step>,
    args: Vec<At>,
    choices: usize,
}

impl Build<'_> {
    /// The result of the code from an operation on. Nothing here has an effect, so both ways of a choice can be
    /// computed; what they have in common is one operation.
    fn follow(&mut self, mut at: usize, mut registers: Registers) -> Option<At> {
        loop {
            let op = self.unit.ops.get(at)?;
            match *op {
                _ if self.steps.len() > STEPS => return None,
                Op::Return => return registers.get(&0).copied(),
                Op::Jump(to) if to as usize > at => at = to as usize,
                Op::JumpIf(when, test, to) if to as usize > at && self.choices < CHOICES => {
                    self.choices += 1;
                    let test = *registers.get(&test.0)?;
                    let there = self.follow(to as usize, registers.clone())?;
                    let here = self.follow(at + 1, registers)?;
                    let (yes, no) = if when { (there, here) } else { (here, there) };
                    return Some(self.step(Step::Choose(test, yes, no)));
                }
                _ => {
                    self.op(op, &mut registers)?;
                    at += 1;
                }
            }
        }
    }

    /// An operation with a constant as part of it, where that gives the same bits: `x - k` is `x + -k`,
    /// and `x ** 2` is `x * x`.
    fn with_constant(&self, step: Step) -> Step {
        let known = |at: At| match self.steps.get(at as usize) {
            Some(Step::Constant(x)) if !x.is_nan() => Some(*x),
            _ => None,
        };
        match step {
            Step::Add(a, b) => match (known(a), known(b)) {
                (None, Some(k)) => Step::AddConstant(a, k),
                (Some(k), None) => Step::AddConstant(b, k),
                _ => step,
            },
            Step::Multiply(a, b) => match (known(a), known(b)) {
                (None, Some(k)) => Step::MultiplyConstant(a, k),
                (Some(k), None) => Step::MultiplyConstant(b, k),
                _ => step,
            },
            Step::Subtract(a, b) => match (known(a), known(b)) {
                (None, Some(k)) => Step::AddConstant(a, -k),
                (Some(k), None) => Step::SubtractFrom(k, b),
                _ => step,
            },
            Step::Binary(BinaryOp::Power, a, b) if known(b) == Some(2.0) => Step::Multiply(a, a),
            _ => step,
        }
    }

    /// An operation, or the same one that is there already.
    fn step(&mut self, step: Step) -> At {
        let step = self.with_constant(step);
        let args = |first: u32, n: u32| self.args.get(first as usize..(first + n) as usize);
        let same = |s: &Step| match (s, &step) {
            (Step::Constant(a), Step::Constant(b)) => a.to_bits() == b.to_bits(),
            // Zeros of both signs are equal, but not the same.
            (Step::AddConstant(a, x), Step::AddConstant(b, y))
            | (Step::MultiplyConstant(a, x), Step::MultiplyConstant(b, y))
            | (Step::SubtractFrom(x, a), Step::SubtractFrom(y, b)) => a == b && x.to_bits() == y.to_bits(),
            (Step::Math(f, a, n), Step::Math(g, b, m)) => f == g && args(*a, *n) == args(*b, *m),
            (a, b) => a == b,
        };
        let at = self.steps.iter().position(same).unwrap_or_else(|| {
            self.steps.push(step);
            self.steps.len() - 1
        });
        at as At
    }

    fn op(&mut self, op: &Op, registers: &mut Registers) -> Option<()> {
        let at = |register: Num| registers.get(&register.0).copied();
        let (dst, step) = match *op {
            Op::Load(dst, field, index) => (dst, Step::Load(field, index)),
            Op::Move(dst, src) => {
                let value = at(src)?;
                registers.insert(dst.0, value);
                return Some(());
            }
            Op::Add(dst, a, b) => (dst, Step::Add(at(a)?, at(b)?)),
            Op::Subtract(dst, a, b) => (dst, Step::Subtract(at(a)?, at(b)?)),
            Op::Multiply(dst, a, b) => (dst, Step::Multiply(at(a)?, at(b)?)),
            Op::Divide(dst, a, b) => (dst, Step::Divide(at(a)?, at(b)?)),
            Op::Less(dst, a, b) => (dst, Step::Binary(BinaryOp::Less, at(a)?, at(b)?)),
            Op::Binary(dst, op, a, b) => (dst, Step::Binary(op, at(a)?, at(b)?)),
            Op::Negate(dst, a) => (dst, Step::Negate(at(a)?)),
            Op::Not(dst, a) => (dst, Step::Not(at(a)?)),
            Op::BitNot(dst, a) => (dst, Step::BitNot(at(a)?)),
            Op::Math(_, _, _, count) if count as usize > ARGS => return None,
            Op::Math(dst, function, first, count) => {
                let from = self.args.len() as u32;
                for i in 0..count {
                    self.args.push(at(Num(first.0 + i))?);
                }
                (dst, Step::Math(function, from, count))
            }
            _ => return None,
        };
        let value = self.step(step);
        registers.insert(dst.0, value);
        Some(())
    }
}
