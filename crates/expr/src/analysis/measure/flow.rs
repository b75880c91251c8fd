//! One function of a text: its blocks in the order of the text, again where a loop hands something on, and the functions that it calls
//! with what they are given there. What a name measures only ever becomes less certain, so the rounds end.

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

/// Operations that are looked at for one text; calls within calls and loops within loops would be many.
const MOST: usize = 100_000;
/// Rounds through a function with loops, and functions that call each other.
const ROUNDS: usize = 8;
const DEEP: usize = 8;

/// The dimensions in a text.
pub(crate) fn measured(
    form: &SsaProgram,
    schema: &dyn Schema,
    given: &KnownDimensions,
    aggregates: &Aggregates,
) -> TextDimensions {
    let around = MeasureContext { form, schema, given, aggregates, left: Cell::new(MOST) };
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
    }
    all
}

/// What a text is looked at with.
pub(super) struct MeasureContext<'f> {
    pub(super) form: &'f SsaProgram,
    pub(super) schema: &'f dyn Schema,
    pub(super) given: &'f KnownDimensions,
    pub(super) aggregates: &'f Aggregates,
    /// Operations that may still be looked at.
    pub(super) left: Cell<usize>,
}

/// The work on one function of a text.
pub(super) struct MeasureWalk<'f> {
    pub(super) around: &'f MeasureContext<'f>,
    pub(super) unit: &'f SsaFunction,
    /// The function, behind those that called it; of one that is looked at for itself it stands alone.
    stack: Vec<UnitId>,
    pub(super) numbers: BTreeMap<u32, Measure>,
    pub(super) values: BTreeMap<u32, Measure>,
    /// Values that are functions of the text, with the names of what these use of this one.
    pub(super) closures: BTreeMap<u32, (UnitId, Vec<Val>)>,
    /// What is passed to the function that is called next, by its registers, and what the last one gave.
    pub(super) passed: [BTreeMap<u32, Operand>; 2],
    pub(super) result_measure: Measure,
    /// A function that is not known was called: it may have changed whatever is shared.
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

    /// Looks at everything until nothing changes.
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

    /// One look at everything, in the order of the text.
    fn round(&mut self) {
        self.found = TextDimensions { value: Measure::Anything, ..TextDimensions::default() };
        let unit = self.unit;
        for (at, block) in unit.blocks.iter().enumerate() {
            for i in unit.range(at as u32) {
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

    /// What a function of the text gives, and what its parameters, and what it uses of the functions around it, measure afterwards.
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
        for (at, measure) in places.iter().zip(given) {
            work.set(*at, *measure);
        }
        work.iterate_to_fixpoint();
        self.wild |= work.wild;
        (work.found.value, places.iter().map(|at| work.at(*at)).collect())
    }

    /// A name measures one thing more.
    pub(super) fn join(&mut self, at: Operand, measure: Measure) {
        let before = self.slot(at).copied().unwrap_or(Measure::Anything);
        self.set(at, before.or(measure));
    }

    fn slot(&self, at: Operand) -> Option<&Measure> {
        match self.unit.same.at(at) {
            Operand::Number(n) => self.numbers.get(&n.0),
            Operand::Value(v) => self.values.get(&v.0),
        }
    }

    pub(super) fn set(&mut self, at: Operand, measure: Measure) {
        match self.unit.same.at(at) {
            Operand::Number(n) => self.numbers.insert(n.0, measure),
            Operand::Value(v) => self.values.insert(v.0, measure),
        };
    }

    pub(super) fn at(&self, at: Operand) -> Measure {
        match at {
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

    /// The number that stands for itself.
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
        // A function of the text may run at any time.
        let before = self.around.given.variables.get(&slot).copied().unwrap_or(Measure::Anything);
        let stored = self.found.variables.get(&slot).filter(|_| self.stack == [0]);
        stored.map_or(before, |stored| before.or(*stored))
    }

    pub(super) fn clash(&mut self, span: &Span, a: Measure, b: Measure) {
        if let (Measure::Known(left), Measure::Known(right)) = (a, b)
            && a.clashes(b)
        {
            self.found.clashes.push(DimensionClash { span: *span, left, right });
        }
    }
}

/// The names of the parameters of a function, and then of what it uses of the functions around it.
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
