//! Dimension analysis of one function: its blocks in source order, repeated while a loop changes a measure, and the
//! functions that it calls, analysed with the measures of the arguments. The measure of a name only becomes less certain,
//! so the iteration terminates.

use std::cell::Cell;
use std::collections::BTreeMap;

use super::measured::{Aggregates, DimensionClash, KnownDimensions, TextDimensions};
use crate::analysis::effects::{element, whole};
use crate::dimension::Measure;
use crate::effects::Access;
use crate::schema::Schema;
use crate::ssa::{Num, Operand, SsaFunction, SsaProgram, Terminator, Val};
use crate::tables::UnitId;
use crate::value::{Value, View};
use labspec_finding::Span;

/// Operations analysed for one program. Without the limit, nested calls and loops would multiply.
const MAX_OPERATIONS: usize = 100_000;
/// Iterations over a function with loops. `DEEP` limits the nesting of function calls.
const ROUNDS: usize = 8;
const DEEP: usize = 8;

/// Returns the dimensions in a program.
pub(crate) fn measured(
    form: &SsaProgram,
    schema: &dyn Schema,
    given: &KnownDimensions,
    aggregates: &Aggregates,
) -> TextDimensions {
    let around = MeasureContext { form, schema, given, aggregates, left: Cell::new(MAX_OPERATIONS) };
    let mut all = TextDimensions::default();
    for (id, unit) in form.units.iter().enumerate() {
        let mut work = MeasureWalk::new(&around, id as u32, unit);
        work.iterate_to_fixpoint();
        let found = work.found;
        if id == 0 {
            all.value = found.value;
        }
        for (slot, measure) in found.variables {
            let measure_so_far = all.variables.entry(slot).or_insert(Measure::Anything);
            *measure_so_far = measure_so_far.or(measure);
        }
        all.stores.extend(found.stores);
        all.clashes.extend(found.clashes);
        all.angles.extend(found.angles);
    }
    all
}

/// The inputs of the analysis of a program.
pub(super) struct MeasureContext<'f> {
    pub(super) form: &'f SsaProgram,
    pub(super) schema: &'f dyn Schema,
    pub(super) given: &'f KnownDimensions,
    pub(super) aggregates: &'f Aggregates,
    /// Operations that may still be analysed.
    pub(super) left: Cell<usize>,
}

/// The analysis of one function of a program.
pub(super) struct MeasureWalk<'f> {
    pub(super) around: &'f MeasureContext<'f>,
    pub(super) unit: &'f SsaFunction,
    /// The function and those that called it, outermost first. A function that is analysed alone is the only entry.
    stack: Vec<UnitId>,
    pub(super) numbers: BTreeMap<u32, Measure>,
    pub(super) values: BTreeMap<u32, Measure>,
    /// Values that are functions of the program, each with the captured values that it uses.
    pub(super) closures: BTreeMap<u32, (UnitId, Vec<Val>)>,
    /// The arguments of the next call, by register, and the results of the last call.
    pub(super) passed: [BTreeMap<u32, Operand>; 2],
    pub(super) result_measure: Measure,
    /// An unknown function was called: it may have changed every shared variable.
    pub(super) wild: bool,
    pub(super) found: TextDimensions,
}

impl<'f> MeasureWalk<'f> {
    pub(super) fn new(around: &'f MeasureContext<'f>, id: UnitId, unit: &'f SsaFunction) -> MeasureWalk<'f> {
        MeasureWalk {
            around,
            unit,
            stack: vec![id],
            numbers: BTreeMap::new(),
            values: BTreeMap::new(),
            closures: BTreeMap::new(),
            passed: Default::default(),
            result_measure: Measure::Unknown,
            wild: false,
            found: TextDimensions::default(),
        }
    }

    /// Repeats the analysis until nothing changes.
    fn iterate_to_fixpoint(&mut self) {
        if !self.unit.blocks.iter().any(|b| matches!(b.end, Terminator::Again(_))) {
            return self.round();
        }
        for _ in 0..ROUNDS {
            let before = (self.numbers.clone(), self.values.clone(), self.wild);
            self.round();
            if same(&before.0, &self.numbers) && same(&before.1, &self.values) && before.2 == self.wild {
                return;
            }
        }
        let variables = self.found.variables.keys().map(|slot| (*slot, Measure::Unknown)).collect();
        self.found = TextDimensions { variables, ..TextDimensions::default() };
    }

    /// Analyses all operations once, in source order.
    fn round(&mut self) {
        self.found = TextDimensions { value: Measure::Anything, ..TextDimensions::default() };
        let unit = self.unit;
        for (id, block) in unit.blocks.iter().enumerate() {
            for i in unit.range(id as u32) {
                if let (Some(op), Some(span)) = (unit.ops.get(i), unit.spans.get(i)) {
                    self.op(op, span);
                }
            }
            match &block.end {
                Terminator::Jump(edge)
                | Terminator::If(_, _, edge)
                | Terminator::IfNothing(_, _, edge)
                | Terminator::Again(edge) => {
                    let params = unit.blocks.get(edge.to as usize).map_or(&[][..], |b| &b.params);
                    for (param, arg) in params.iter().zip(&edge.args) {
                        let measure = self.at(*arg);
                        self.join(*param, measure);
                    }
                }
                Terminator::Return(Some(value)) => self.found.value = self.found.value.or(self.at(*value)),
                Terminator::Return(None) => {}
            }
        }
        self.around.left.set(self.around.left.get().saturating_sub(unit.ops.len()));
    }

    /// Returns the measure of the result of a function, and the measures of its parameters and captured variables after the
    /// call.
    pub(super) fn call(&mut self, id: UnitId, given: &[Measure]) -> (Measure, Vec<Measure>) {
        let unknown = || (Measure::Unknown, vec![Measure::Unknown; given.len()]);
        let around = self.around;
        let Some(unit) = around.form.units.get(id as usize) else { return unknown() };
        if self.stack.contains(&id) || self.stack.len() >= DEEP || around.left.get() == 0 {
            self.wild = true;
            return unknown();
        }
        let stack = self.stack.iter().copied().chain([id]).collect();
        let mut work = MeasureWalk { stack, ..MeasureWalk::new(around, id, unit) };
        let places: Vec<Operand> = places(unit).collect();
        for (operand, measure) in places.iter().zip(given) {
            work.set(*operand, *measure);
        }
        work.iterate_to_fixpoint();
        self.wild |= work.wild;
        (work.found.value, places.iter().map(|operand| work.at(*operand)).collect())
    }

    /// Adds a possible measure to an operand.
    pub(super) fn join(&mut self, operand: Operand, measure: Measure) {
        let before = self.slot(operand).copied().unwrap_or(Measure::Anything);
        self.set(operand, before.or(measure));
    }

    fn slot(&self, operand: Operand) -> Option<&Measure> {
        match self.unit.same.at(operand) {
            Operand::Number(n) => self.numbers.get(&n.0),
            Operand::Value(v) => self.values.get(&v.0),
        }
    }

    pub(super) fn set(&mut self, operand: Operand, measure: Measure) {
        match self.unit.same.at(operand) {
            Operand::Number(n) => self.numbers.insert(n.0, measure),
            Operand::Value(v) => self.values.insert(v.0, measure),
        };
    }

    pub(super) fn at(&self, operand: Operand) -> Measure {
        match operand {
            Operand::Number(n) => self.number(n),
            Operand::Value(v) => self.value(v),
        }
    }

    pub(super) fn number(&self, n: Num) -> Measure {
        let n = self.unit.same.number(n);
        match self.unit.constant(n) {
            Some(_) => Measure::Anything,
            None => self.numbers.get(&n.0).copied().unwrap_or_default(),
        }
    }

    pub(super) fn value(&self, v: Val) -> Measure {
        match self.unit.constant_value(v) {
            Some(Value::Number(_) | Value::Null | Value::Undefined | Value::String(_)) => Measure::Anything,
            Some(Value::View(view)) => self.access(whole(*view)),
            Some(_) => Measure::Unknown,
            None => self.values.get(&self.unit.same.value(v).0).copied().unwrap_or_default(),
        }
    }

    /// The constant value of a number, if it has one.
    pub(super) fn literal(&self, n: Num) -> Option<f64> {
        self.unit.constant(self.unit.same.number(n))
    }

    pub(super) fn access(&self, access: Access) -> Measure {
        self.around.schema.measure(access.field, access.first, access.count)
    }

    pub(super) fn element(&self, view: View, index: Num) -> Measure {
        self.access(element(view, self.literal(index)))
    }

    pub(super) fn variable(&self, slot: u32) -> Measure {
        // A function of the program may run at any time, so the measure from before the program remains possible.
        let before = self.around.given.variables.get(&slot).copied().unwrap_or(Measure::Anything);
        let stored = self.found.variables.get(&slot).filter(|_| self.stack == [0]);
        stored.map_or(before, |stored| before.or(*stored))
    }

    pub(super) fn clash(&mut self, span: &Span, a: Measure, b: Measure) {
        if let (Measure::Dimension(left), Measure::Dimension(right)) = (a, b)
            && a.clashes(b)
        {
            self.found.clashes.push(DimensionClash { span: *span, left, right });
        }
    }
}

/// The operands of the parameters of a function, followed by those of its captured variables.
fn places(unit: &SsaFunction) -> impl Iterator<Item = Operand> {
    use crate::ssa::Representation;
    let (mut numbers, mut values) = (0, 0);
    unit.params.iter().chain(&unit.captures).map(move |slot| match slot {
        Representation::Number | Representation::Boolean => {
            numbers += 1;
            Operand::Number(Num(numbers))
        }
        Representation::Value => {
            values += 1;
            Operand::Value(Val(values))
        }
    })
}

fn same(a: &BTreeMap<u32, Measure>, b: &BTreeMap<u32, Measure>) -> bool {
    a.len() == b.len() && a.iter().zip(b).all(|((i, x), (j, y))| i == j && x.is(*y))
}
