//! Numeric expressions without effects, as a list of operations, each on results of earlier operations. The same list is used
//! in three ways: once for the current state (`row`), over columns of recorded samples (`columnar`), and as a part of a longer
//! program, whose numbers are its inputs.

use std::collections::BTreeMap;

use crate::math;
use crate::operation::select;
use crate::operators::{BinaryOp, UnaryOp};
use crate::types::FieldKey;

/// The index of an operation, and of its result.
pub type StepId = u32;

/// A constant, identified by its bits, because zeros of both signs are equal but not identical.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct ConstantBits(u64);

impl ConstantBits {
    /// The number of these bits.
    #[inline]
    pub fn number(self) -> f64 {
        f64::from_bits(self.0)
    }
}

/// One operation.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum FormulaStep {
    /// A constant.
    Constant(ConstantBits),
    /// An element of a field, by its index in the whole field.
    Load(FieldKey, u32),
    /// A number of the enclosing program.
    Input(u32),
    /// An operator with one operand.
    Unary(UnaryOp, StepId),
    /// An operator between two results.
    Binary(BinaryOp, StepId, StepId),
    /// A binary operation with a constant on the right; `Left` has it on the left.
    Right(BinaryOp, StepId, ConstantBits),
    /// An operator between a constant and a result.
    Left(BinaryOp, ConstantBits, StepId),
    /// The second operand if the first is true, otherwise the third.
    Select(StepId, StepId, StepId),
    /// A function, with the first index and the number of its arguments in the list of arguments.
    Math(math::MathFunction, u32, u32),
}

/// An expression as a list of operations.
#[derive(Clone, Debug, Default)]
pub struct Formula {
    /// The steps; each uses earlier ones.
    pub steps: Vec<FormulaStep>,
    args: Vec<StepId>,
    /// The step whose result is the result of the formula.
    pub output: StepId,
    /// Whether the value is a boolean, as 1 or 0.
    pub truth: bool,
    /// Operations already in the list, for reuse; functions of `Math` are stored with their arguments.
    existing: BTreeMap<FormulaStep, StepId>,
    existing_math: BTreeMap<(math::MathFunction, Vec<StepId>), StepId>,
}

impl Formula {
    /// The arguments of a function of `Math`.
    pub fn args(&self, first: u32, count: u32) -> &[StepId] {
        self.args.get(first as usize..(first + count) as usize).unwrap_or(&[])
    }

    /// The value of a constant step.
    pub(crate) fn constant_at(&self, step: StepId) -> Option<f64> {
        match self.steps.get(step as usize) {
            Some(FormulaStep::Constant(k)) => Some(k.number()),
            _ => None,
        }
    }

    /// Adds an operation, or returns an identical existing one.
    pub fn step(&mut self, step: FormulaStep) -> StepId {
        if let Some(id) = self.existing.get(&step) {
            return *id;
        }
        let id = self.push(step);
        self.existing.insert(step, id);
        id
    }

    fn push(&mut self, step: FormulaStep) -> StepId {
        self.steps.push(step);
        (self.steps.len() - 1) as StepId
    }

    /// Adds a constant.
    pub fn constant(&mut self, x: f64) -> StepId {
        self.step(FormulaStep::Constant(ConstantBits(x.to_bits())))
    }

    /// Adds an operator with one operand.
    pub fn unary(&mut self, op: UnaryOp, a: StepId) -> StepId {
        self.step(FormulaStep::Unary(op, a))
    }

    /// Adds a binary operation. A constant operand becomes part of it, and the operands of commutative operations may be
    /// swapped. `x - k` becomes `x + -k` and `x ** 2` becomes `x * x`, which give the same bits.
    pub fn binary(&mut self, op: BinaryOp, a: StepId, b: StepId) -> StepId {
        let turns = matches!(op, BinaryOp::Add | BinaryOp::Multiply);
        let bits = |k: f64| ConstantBits(k.to_bits());
        let step = match (op, self.constant_at(a), self.constant_at(b)) {
            (BinaryOp::Power, _, Some(2.0)) => FormulaStep::Binary(BinaryOp::Multiply, a, a),
            (BinaryOp::Subtract, _, Some(k)) if !k.is_nan() => FormulaStep::Right(BinaryOp::Add, a, bits(-k)),
            (_, _, Some(k)) => FormulaStep::Right(op, a, bits(k)),
            (_, Some(k), _) if turns && !k.is_nan() => FormulaStep::Right(op, b, bits(k)),
            (_, Some(k), _) => FormulaStep::Left(op, bits(k), b),
            _ => FormulaStep::Binary(op, a, b),
        };
        self.step(step)
    }

    /// Adds a choice between two results.
    pub fn select(&mut self, test: StepId, yes: StepId, no: StepId) -> StepId {
        match self.constant_at(test) {
            _ if yes == no => yes,
            Some(x) if !x.is_nan() => select(x, yes, no),
            _ => self.step(FormulaStep::Select(test, yes, no)),
        }
    }

    /// Adds a function of `Math`.
    pub fn math(&mut self, function: math::MathFunction, args: Vec<StepId>) -> StepId {
        if let Some(id) = self.existing_math.get(&(function, args.clone())) {
            return *id;
        }
        let first = self.args.len() as u32;
        self.args.extend(&args);
        let id = self.push(FormulaStep::Math(function, first, args.len() as u32));
        self.existing_math.insert((function, args), id);
        id
    }

    /// Removes operations that the results do not need, and updates the indexes in `results`. The tables for reuse are cleared.
    pub fn finish(&mut self, results: &mut [StepId]) {
        self.existing = BTreeMap::new();
        self.existing_math = BTreeMap::new();
        let Formula { steps, args, .. } = self;
        let mut used = vec![false; steps.len()];
        let mark = |used: &mut Vec<bool>, id: StepId| {
            if let Some(place) = used.get_mut(id as usize) {
                *place = true;
            }
        };
        results.iter().for_each(|id| mark(&mut used, *id));
        for i in (0..steps.len()).rev() {
            if let (Some(true), Some(mut step)) = (used.get(i), steps.get(i).copied()) {
                step.each(args, &mut |id| mark(&mut used, *id));
            }
        }
        let mut used_count = 0;
        let count = |used: &bool| {
            used_count += StepId::from(*used);
            used_count.saturating_sub(1)
        };
        let places: Vec<StepId> = used.iter().map(count).collect();
        let mut moved = |id: &mut StepId| *id = places.get(*id as usize).copied().unwrap_or(*id);
        results.iter_mut().for_each(&mut moved);
        for (step, _) in steps.iter_mut().zip(&used).filter(|(_, used)| **used) {
            step.each(args, &mut moved);
        }
        let mut used = used.iter();
        steps.retain(|_| used.next() == Some(&true));
    }
}

impl FormulaStep {
    /// Calls `f` for every operand.
    fn each(&mut self, args: &mut [StepId], f: &mut impl FnMut(&mut StepId)) {
        match self {
            FormulaStep::Constant(_) | FormulaStep::Load(..) | FormulaStep::Input(_) => {}
            FormulaStep::Unary(_, a) | FormulaStep::Right(_, a, _) | FormulaStep::Left(_, _, a) => f(a),
            FormulaStep::Binary(_, a, b) => [a, b].into_iter().for_each(f),
            FormulaStep::Select(a, b, c) => [a, b, c].into_iter().for_each(f),
            FormulaStep::Math(_, first, count) => {
                let (first, count) = (*first as usize, *count as usize);
                args.get_mut(first..first + count).into_iter().flatten().for_each(f);
            }
        }
    }
}
