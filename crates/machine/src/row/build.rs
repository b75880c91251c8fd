//! Formulas to rows: every step gets a register, and where possible the accumulator is passed to the next operation.

use super::operation::RowOp;
use super::run::{FieldElement, REGISTERS, Row};
use crate::formula::{Formula, FormulaStep, StepId};
use crate::math::{FEW, MathEvaluation, MathFunction};
use crate::operators::BinaryOp;
use labspec_finding::order;

/// A step whose result is needed in a register.
pub struct RequestedResult {
    /// The step.
    pub step: StepId,
    /// The register.
    pub register: u8,
    /// Whether nothing after the step reads the previous value of the register.
    pub at_once: bool,
}

impl Row {
    /// Returns `None` if the formula needs too many registers.
    pub fn from_formula(formula: &Formula) -> Option<Row> {
        let load = |step: &FormulaStep| {
            if let FormulaStep::Load(field, index) = step { Some((*field, *index)) } else { None }
        };
        let mut elements: Vec<_> = formula.steps.iter().filter_map(load).collect();
        order::sort_by(&mut elements, Ord::cmp);
        let loads = u8::try_from(elements.len()).ok()?;
        let free = usize::from(loads)..REGISTERS;
        let mut row = Row::with(formula, &elements, &[], free.filter_map(|r| u8::try_from(r).ok()))?;
        (row.elements, row.start) = (elements, row.begin());
        Some(row)
    }

    /// Builds the row of a part of a program, given the registers of its inputs. Requested results go to registers of the
    /// program, intermediate results to free ones.
    pub fn part(
        formula: &Formula,
        requested: &[RequestedResult],
        free: impl Iterator<Item = u8>,
    ) -> Option<Row> {
        let mut row = Row::with(formula, &[], requested, free)?;
        row.start = row.begin();
        Some(row)
    }

    fn with(
        formula: &Formula,
        elements: &[FieldElement],
        requested: &[RequestedResult],
        mut free: impl Iterator<Item = u8>,
    ) -> Option<Row> {
        let mut homes = Vec::with_capacity(formula.steps.len());
        for (id, step) in (0..).zip(&formula.steps) {
            let home = match step {
                FormulaStep::Load(field, index) => {
                    u8::try_from(elements.binary_search(&(*field, *index)).ok()?).ok()
                }
                FormulaStep::Input(register) => u8::try_from(*register).ok(),
                _ => match requested.iter().find(|w| w.step == id && w.at_once) {
                    Some(requested) => Some(requested.register),
                    None => free.next(),
                },
            };
            homes.push(home?);
        }
        let mut build = RowBuilder { formula, homes, ops: Vec::new(), args: Vec::new(), at_hand: None };
        for (id, step) in (0..).zip(&formula.steps) {
            build.step(id, *step)?;
        }
        for requested in requested {
            if build.register_of(requested.step) == Some(requested.register) {
                continue;
            }
            build.take(requested.step)?;
            build.at_hand = Some(requested.step);
            build.ops.push(RowOp::Keep(requested.register));
        }
        if requested.is_empty() {
            build.take(formula.output)?;
        }
        build.drop_unread(requested);
        let (ops, args) = (build.ops, build.args);
        let passes_nan = ops.iter().all(|op| op.passes_nan());
        Some(Row { elements: Vec::new(), start: 0, ops, args, truth: formula.truth, passes_nan })
    }

    /// The register that the accumulator contains initially. If the first operation only loads a register that is already set,
    /// this replaces the operation.
    fn begin(&mut self) -> u8 {
        let first = self.ops.iter().position(|op| !matches!(op, RowOp::Put(..)));
        match first.and_then(|index| Some((index, *self.ops.get(index)?))) {
            Some((index, RowOp::Take(r)))
                if !self.ops.iter().any(|op| matches!(op, RowOp::Put(put, _) if *put == r)) =>
            {
                self.ops.remove(index);
                r
            }
            _ => 0,
        }
    }
}

/// The builder of the row of one formula.
struct RowBuilder<'f> {
    formula: &'f Formula,
    /// The register of each step.
    homes: Vec<u8>,
    ops: Vec<RowOp>,
    args: Vec<u8>,
    /// The step whose result is in the accumulator.
    at_hand: Option<StepId>,
}

impl RowBuilder<'_> {
    fn register_of(&self, step: StepId) -> Option<u8> {
        self.homes.get(step as usize).copied()
    }

    /// Loads a result into the accumulator.
    fn take(&mut self, step: StepId) -> Option<()> {
        if self.at_hand != Some(step) {
            self.ops.push(RowOp::Take(self.register_of(step)?));
        }
        Some(())
    }

    /// Emits a binary operation. The second operand may be in the accumulator if the operation exists with swapped operands.
    fn two(
        &mut self,
        a: StepId,
        b: StepId,
        op: impl Fn(u8) -> RowOp,
        round: impl Fn(u8) -> RowOp,
    ) -> Option<RowOp> {
        if self.at_hand == Some(b) && a != b {
            return Some(round(self.register_of(a)?));
        }
        self.take(a)?;
        Some(op(self.register_of(b)?))
    }

    /// Emits an operation, and stores its result in its register for later use.
    fn step(&mut self, id: StepId, step: FormulaStep) -> Option<()> {
        let op = match step {
            FormulaStep::Load(..) | FormulaStep::Input(_) => return Some(()),
            FormulaStep::Constant(k) => {
                self.ops.push(RowOp::Put(self.register_of(id)?, k.number()));
                return Some(());
            }
            FormulaStep::Binary(BinaryOp::Add, a, b) => self.two(a, b, RowOp::Add, RowOp::Add)?,
            FormulaStep::Binary(BinaryOp::Subtract, a, b) => {
                self.two(a, b, RowOp::Subtract, RowOp::SubtractFrom)?
            }
            FormulaStep::Binary(BinaryOp::Multiply, a, b) => {
                self.two(a, b, RowOp::Multiply, RowOp::Multiply)?
            }
            FormulaStep::Binary(BinaryOp::Divide, a, b) => {
                self.two(a, b, RowOp::Divide, RowOp::DivideInto)?
            }
            FormulaStep::Binary(op, a, b) => {
                self.two(a, b, |r| RowOp::Binary(op, r), |r| RowOp::Round(op, r))?
            }
            FormulaStep::Right(BinaryOp::Add, a, k) => self.one(a, RowOp::AddConstant(k.number()))?,
            FormulaStep::Right(BinaryOp::Multiply, a, k) => {
                self.one(a, RowOp::MultiplyConstant(k.number()))?
            }
            FormulaStep::Right(op, a, k) => self.one(a, RowOp::Right(op, k.number()))?,
            FormulaStep::Left(op, k, a) => self.one(a, RowOp::Left(op, k.number()))?,
            FormulaStep::Unary(op, a) => self.one(a, RowOp::Unary(op))?,
            FormulaStep::Select(test, yes, no) => {
                self.one(test, RowOp::Select(self.register_of(yes)?, self.register_of(no)?))?
            }
            FormulaStep::Math(function, first, count) => self.math(function, first, count)?,
        };
        self.ops.extend([op, RowOp::Keep(self.register_of(id)?)]);
        self.at_hand = Some(id);
        Some(())
    }

    fn one(&mut self, a: StepId, op: RowOp) -> Option<RowOp> {
        self.take(a)?;
        Some(op)
    }

    fn math(&mut self, function: MathFunction, first: u32, count: u32) -> Option<RowOp> {
        let args = self.formula.args(first, count);
        match (function.apply_by(), args) {
            (MathEvaluation::One(f), [a, ..]) if function.gives_boolean() => self.one(*a, RowOp::Asks(f)),
            (MathEvaluation::One(f), [a, ..]) => self.one(*a, RowOp::One(f)),
            (MathEvaluation::Two(f), [a, b, ..]) => {
                self.take(*a)?;
                Some(RowOp::Two(f, self.register_of(*b)?))
            }
            (MathEvaluation::Many(f), args) if args.len() <= FEW => {
                let first = u16::try_from(self.args.len()).ok()?;
                for &a in args {
                    self.args.push(self.homes.get(a as usize).copied()?);
                }
                Some(RowOp::Many(f, u8::try_from(args.len()).ok()?, first))
            }
            // A function with too many arguments, or a missing one, is rare, and left to the virtual machine.
            _ => None,
        }
    }

    /// Removes stores to registers that nothing reads.
    fn drop_unread(&mut self, requested: &[RequestedResult]) {
        let mut read = [false; REGISTERS];
        for r in requested.iter().map(|w| w.register).chain(self.args.iter().copied()) {
            read[usize::from(r)] = true;
        }
        for op in &self.ops {
            for r in op.reads().into_iter().flatten() {
                read[usize::from(r)] = true;
            }
        }
        self.ops.retain(|op| !matches!(*op, RowOp::Keep(r) | RowOp::Put(r, _) if !read[usize::from(r)]));
    }
}
