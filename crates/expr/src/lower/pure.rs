//! Formulas from SSA form: of a whole program without effects, where every branch becomes a selection between two evaluated
//! numbers, and of consecutive numeric operations of a longer program.

use std::collections::BTreeMap;

use crate::formula::{Formula, FormulaStep, StepId};
use crate::math::FEW;
use crate::ssa::{BasicBlock, BlockEdge, BlockId, Num, Op, Operand, Representation, SsaFunction, Terminator};

/// The formula of a program with a numeric or boolean value, or `None` if its value depends on anything other than elements of
/// fields at known indexes.
pub(crate) fn whole(unit: &SsaFunction) -> Option<Formula> {
    let loads_and_numbers = |op: &Op| op.is_numeric() || matches!(op, Op::Load(..));
    if unit.result == Representation::Value || !unit.ops.iter().all(loads_and_numbers) {
        return None;
    }
    let mut steps = Steps::new(unit);
    for block in 0..unit.blocks.len() as BlockId {
        steps.params(block)?;
        unit.range(block).try_for_each(|i| steps.op(unit.ops.get(i)?).map(|_| ()))?;
    }
    // The blocks that return are the paths to the end.
    let mut output = steps.selected_parameter(0, unit.blocks.len() as BlockId, 0)?;
    let mut formula = steps.formula;
    formula.finish(std::slice::from_mut(&mut output));
    (formula.output, formula.truth) = (output, unit.result == Representation::Boolean);
    Some(formula)
}

/// The formula of consecutive numeric operations, with the step of every number that they define. `input` returns the register
/// of a number that was defined before them.
pub(crate) fn formula_of_operations(
    unit: &SsaFunction,
    ops: &[Op],
    input: &mut dyn FnMut(Num) -> u32,
) -> Option<(Formula, Vec<(Num, StepId)>)> {
    let mut steps = Steps { input: Some(input), ..Steps::new(unit) };
    let mut given = Vec::with_capacity(ops.len());
    for op in ops {
        given.push(steps.op(op)?);
    }
    Some((steps.formula, given))
}

/// The builder of one formula.
struct Steps<'u> {
    unit: &'u SsaFunction,
    input: Option<&'u mut dyn FnMut(Num) -> u32>,
    formula: Formula,
    /// The step of each name.
    steps_by_name: BTreeMap<Num, StepId>,
}

impl<'u> Steps<'u> {
    fn new(unit: &'u SsaFunction) -> Steps<'u> {
        Steps { unit, input: None, formula: Formula::default(), steps_by_name: BTreeMap::new() }
    }

    fn find(&mut self, name: Num) -> Option<StepId> {
        let name = self.unit.same.number(name);
        if let Some(step) = self.steps_by_name.get(&name) {
            return Some(*step);
        }
        let step = match (self.unit.constant(name), &mut self.input) {
            (Some(x), _) => self.formula.constant(x),
            (None, Some(input)) => self.formula.step(FormulaStep::Input(input(name))),
            (None, None) => return None,
        };
        self.steps_by_name.insert(name, step);
        Some(step)
    }

    /// The step of an operation, and the name of its result.
    fn op(&mut self, op: &Op) -> Option<(Num, StepId)> {
        let (name, step) = match *op {
            Op::Load(name, field, index) => (name, self.formula.step(FormulaStep::Load(field, index))),
            Op::Unary(name, op, a) => {
                let a = self.find(a)?;
                (name, self.formula.unary(op, a))
            }
            Op::Binary(name, op, a, b) => {
                let (a, b) = (self.find(a)?, self.find(b)?);
                (name, self.formula.binary(op, a, b))
            }
            Op::Select(name, test, a, b) => {
                let (test, a, b) = (self.find(test)?, self.find(a)?, self.find(b)?);
                (name, self.formula.select(test, a, b))
            }
            // A function with more arguments than a row supports is left to the virtual machine.
            Op::Math(_, _, args) if args.count as usize > FEW => return None,
            Op::Math(name, function, args) => {
                let args = args
                    .operands(&self.unit.args)
                    .iter()
                    .map(|n| self.find(Num(*n)))
                    .collect::<Option<_>>()?;
                (name, self.formula.math(function, args))
            }
            _ => return None,
        };
        self.steps_by_name.insert(name, step);
        Some((name, step))
    }

    /// Determines the steps of the parameters of a block.
    fn params(&mut self, to: BlockId) -> Option<()> {
        let unit = self.unit;
        let BasicBlock { params, after, .. } = unit.blocks.get(to as usize)?;
        for (i, param) in params.iter().enumerate() {
            let Operand::Number(name) = param else { return None };
            let step = self.selected_parameter(*after, to, i)?;
            self.steps_by_name.insert(*name, step);
        }
        Some(())
    }

    /// The step of a parameter of block `to`, selected by the branches since block `after`, the last block that all paths to it
    /// passed. Edges lead forward, so the blocks are visited from the last to the first.
    fn selected_parameter(&mut self, after: BlockId, to: BlockId, param: usize) -> Option<StepId> {
        let unit = self.unit;
        let mut from: Vec<Option<StepId>> = vec![None; (to - after) as usize];
        for current in (after..to).rev() {
            let chosen_from = |from: &[Option<StepId>], block: BlockId| {
                from.get((block - after) as usize).copied().flatten()
            };
            let follow =
                |steps: &mut Self, from: &[Option<StepId>], edge: &BlockEdge| match edge.args.get(param) {
                    Some(Operand::Number(name)) if edge.to == to => steps.find(*name),
                    _ if edge.to < to => chosen_from(from, edge.to),
                    _ => None,
                };
            let found = match &unit.blocks.get(current as usize)?.end {
                Terminator::Jump(edge) => follow(self, &from, edge),
                Terminator::If(when, test, edge) => {
                    let (there, next) = (follow(self, &from, edge), chosen_from(&from, current + 1));
                    match (there, next) {
                        (Some(there), Some(next)) => {
                            let (yes, no) = if *when { (there, next) } else { (next, there) };
                            let test = self.find(*test)?;
                            Some(self.formula.select(test, yes, no))
                        }
                        (one, other) => one.or(other),
                    }
                }
                Terminator::Return(Some(Operand::Number(name))) if to as usize == unit.blocks.len() => {
                    self.find(*name)
                }
                Terminator::Return(_) => None,
                Terminator::IfNothing(..) | Terminator::Again(_) => return None,
            };
            if let Some(place) = from.get_mut((current - after) as usize) {
                *place = found;
            }
        }
        from.first().copied().flatten()
    }
}
