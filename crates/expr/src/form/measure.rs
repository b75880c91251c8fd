//! Which dimension every number of a text has, as far as it is certain, read off its form.
//!
//! Numbers of the text may stand for quantities of any dimension; what cannot be known is unknown, and so is what a loop hands on
//! from turn to turn.

use std::collections::{BTreeMap, BTreeSet};

use super::{Args, At, Block, BlockId, End, Form, Num, Op, Unit, Val};
use crate::Span;
use crate::dimension::{Dimension, Measure};
use crate::effects::Access;
use crate::math;
use crate::operators::{BinaryOp, UnaryOp};
use crate::schema::{Schema, Type};
use crate::value::{Value, View};

use super::effects::{element, whole};

/// What is known of the surroundings of a text.
#[derive(Clone, Debug, Default)]
pub struct Given {
    /// The variables, by their slots. What is not here was never stored.
    pub variables: BTreeMap<u32, Measure>,
    /// What a control gives.
    pub value: Measure,
}

/// The dimensions in a text.
#[derive(Clone, Debug, Default)]
pub struct Measured {
    /// Of its value.
    pub value: Measure,
    /// Of every variable that it stores.
    pub variables: BTreeMap<u32, Measure>,
    /// Of what it stores in fields.
    pub stores: Vec<Stored>,
    /// Sums and comparisons of what cannot be added or compared.
    pub clashes: Vec<Clash>,
}

/// A number that is stored.
#[derive(Clone, Debug, PartialEq)]
pub struct Stored {
    /// Where to.
    pub access: Access,
    /// What it is.
    pub measure: Measure,
    /// Where this stands.
    pub span: Span,
}

/// Two quantities of different dimensions that are added or compared.
#[derive(Clone, Debug, PartialEq)]
pub struct Clash {
    /// Where.
    pub span: Span,
    /// The one.
    pub left: Dimension,
    /// The other.
    pub right: Dimension,
}

/// What the aggregates of a text give, by their slots.
pub(crate) type Aggregates = BTreeMap<usize, Measure>;

/// The dimensions in a text.
pub(crate) fn measured(form: &Form, schema: &dyn Schema, given: &Given, aggregates: &Aggregates) -> Measured {
    let mut all = Measured::default();
    for (id, unit) in form.units.iter().enumerate() {
        let mut work = Work { entry: id == 0, ..Work::new(form, unit, schema, given, aggregates) };
        work.look();
        let found = work.found;
        if id == 0 {
            all.value = found.value;
        }
        for (slot, measure) in found.variables {
            let known = all.variables.entry(slot).or_insert(Measure::Anything);
            *known = known.or(measure);
        }
        all.stores.extend(found.stores);
        all.clashes.extend(found.clashes);
    }
    all
}

/// The work on one function of a text.
struct Work<'f> {
    form: &'f Form,
    unit: &'f Unit,
    schema: &'f dyn Schema,
    given: &'f Given,
    aggregates: &'f Aggregates,
    /// It is the text itself, and no function in it.
    entry: bool,
    numbers: BTreeMap<u32, Measure>,
    values: BTreeMap<u32, Measure>,
    found: Measured,
}

impl<'f> Work<'f> {
    fn new(
        form: &'f Form,
        unit: &'f Unit,
        schema: &'f dyn Schema,
        given: &'f Given,
        aggregates: &'f Aggregates,
    ) -> Work<'f> {
        Work {
            form,
            unit,
            schema,
            given,
            aggregates,
            entry: true,
            numbers: BTreeMap::new(),
            values: BTreeMap::new(),
            found: Measured::default(),
        }
    }

    /// One look at everything, in the order of the text.
    fn look(&mut self) {
        self.found = Measured { value: Measure::Anything, ..Measured::default() };
        let unit = self.unit;
        // Where some way leads back to.
        let back = |b: &Block| if let End::Again(edge) = &b.end { Some(edge.to) } else { None };
        let loops: BTreeSet<BlockId> = unit.blocks.iter().filter_map(back).collect();
        for (at, block) in unit.blocks.iter().enumerate() {
            if loops.contains(&(at as BlockId)) {
                for param in &block.params {
                    self.set(*param, Measure::Unknown);
                }
            }
            for i in unit.range(at as u32) {
                if let (Some(op), Some(span)) = (unit.ops.get(i), unit.spans.get(i)) {
                    self.op(op, span);
                }
            }
            match &block.end {
                End::Jump(edge) | End::If(_, _, edge) | End::IfNothing(_, _, edge) | End::Again(edge) => {
                    let params = unit.blocks.get(edge.to as usize).map_or(&[][..], |b| &b.params);
                    for (param, arg) in params.iter().zip(&edge.args) {
                        let measure = self.at(*arg);
                        let before = self.slot(*param).copied().unwrap_or(Measure::Anything);
                        self.set(*param, before.or(measure));
                    }
                }
                End::Return(Some(value)) => self.found.value = self.found.value.or(self.at(*value)),
                End::Return(None) => {}
            }
        }
    }

    fn slot(&mut self, at: At) -> Option<&Measure> {
        match self.unit.same.at(at) {
            At::Number(n) => self.numbers.get(&n.0),
            At::Value(v) => self.values.get(&v.0),
        }
    }

    fn set(&mut self, at: At, measure: Measure) {
        match self.unit.same.at(at) {
            At::Number(n) => self.numbers.insert(n.0, measure),
            At::Value(v) => self.values.insert(v.0, measure),
        };
    }

    fn at(&self, at: At) -> Measure {
        match at {
            At::Number(n) => self.number(n),
            At::Value(v) => self.value(v),
        }
    }

    fn number(&self, n: Num) -> Measure {
        let n = self.unit.same.number(n);
        match self.unit.known(n) {
            Some(_) => Measure::Anything,
            None => self.numbers.get(&n.0).copied().unwrap_or_default(),
        }
    }

    fn value(&self, v: Val) -> Measure {
        match self.unit.known_value(v) {
            Some(Value::Number(_) | Value::Null | Value::Undefined) => Measure::Anything,
            Some(Value::View(view)) => self.access(whole(*view)),
            Some(_) => Measure::Unknown,
            None => self.values.get(&self.unit.same.value(v).0).copied().unwrap_or_default(),
        }
    }

    /// The number that stands for itself.
    fn literal(&self, n: Num) -> Option<f64> {
        self.unit.known(self.unit.same.number(n))
    }

    fn access(&self, access: Access) -> Measure {
        self.schema.measure(access.field, access.first, access.count)
    }

    fn element(&self, view: View, index: Num) -> Measure {
        self.access(element(view, self.literal(index)))
    }

    fn variable(&self, slot: u32) -> Measure {
        // A function of the text may run at any time.
        let known = self.given.variables.get(&slot).copied().unwrap_or(Measure::Anything);
        if self.entry { self.found.variables.get(&slot).map_or(known, |own| known.or(*own)) } else { known }
    }

    fn store(&mut self, slot: u32, measure: Measure) {
        let before = self.found.variables.entry(slot).or_insert(Measure::Anything);
        *before = before.or(measure);
    }

    fn clash(&mut self, span: &Span, a: Measure, b: Measure) {
        if let (Measure::Known(left), Measure::Known(right)) = (a, b)
            && a.clashes(b)
        {
            self.found.clashes.push(Clash { span: *span, left, right });
        }
    }

    fn op(&mut self, op: &Op, span: &Span) {
        let of_number = |d: Num, m: Measure, w: &mut Self| w.set(At::Number(d), m);
        let of_value = |d: Val, m: Measure, w: &mut Self| w.set(At::Value(d), m);
        match *op {
            Op::Load(d, field, at) => {
                let m = self.access(Access { field, first: at as usize, count: Some(1) });
                of_number(d, m, self);
            }
            Op::LoadAt(d, view, index) => of_number(d, self.element(view, index), self),
            Op::LoadValue(d, view, at) => of_value(d, self.access(element(view, Some(f64::from(at)))), self),
            Op::LoadValueAt(d, view, index) => of_value(d, self.element(view, index), self),
            Op::Length(d, _) | Op::Truthy(d, _) => of_number(d, Measure::NUMBER, self),
            Op::Input(d) => of_value(d, self.given.value, self),
            Op::Global(d, slot) => of_value(d, self.variable(slot), self),
            Op::GlobalNumber(d, slot) => of_number(d, self.variable(slot), self),
            Op::BoxNumber(d, a) => of_value(d, self.number(a), self),
            Op::BoxBoolean(d, _) => of_value(d, Measure::NUMBER, self),
            Op::ToNumber(d, a) | Op::ToIndex(d, a) => of_number(d, self.value(a), self),
            Op::Unary(d, op, a) => {
                let m = match op {
                    UnaryOp::Minus | UnaryOp::Plus => self.number(a),
                    UnaryOp::Not => Measure::NUMBER,
                    UnaryOp::BitNot | UnaryOp::TypeOf => Measure::Unknown,
                };
                of_number(d, m, self);
            }
            Op::Binary(d, op, a, b) => {
                let m = self.binary(op, a, b, span);
                of_number(d, m, self);
            }
            Op::Select(d, _, a, b) => of_number(d, self.number(a).or(self.number(b)), self),
            Op::Math(d, function, args) => {
                let m = self.math(function, args, span);
                of_number(d, m, self);
            }
            Op::MathOver(d, function, list) => {
                let list = self.value(list);
                let m = if keeps(function.name()) { list } else { Measure::Unknown };
                of_number(d, m, self);
            }
            Op::Plus(d, a, b) => of_value(d, self.value(a).sum(self.value(b)), self),
            Op::Compare(d, _, a, b) => {
                self.clash(span, self.value(a), self.value(b));
                of_number(d, Measure::NUMBER, self);
            }
            Op::CallHost(d, function, args) => {
                let args = args.of(&self.unit.args);
                let number = args.first().and_then(|v| self.unit.known_value(Val(*v)));
                let gives = self.schema.gives(function, number.map(Value::to_number));
                let m = gives.of(|i| args.get(i).map_or(Measure::Unknown, |v| self.value(Val(*v))));
                of_value(d, m, self);
            }
            Op::Aggregate(d, slot) => {
                let m = self.aggregates.get(&(slot as usize)).copied().unwrap_or_default();
                of_number(d, m, self);
            }
            Op::Element(d, list, _) | Op::ElementAt(d, list, _) => of_value(d, self.value(list), self),
            Op::Member(d, of, name) => {
                let length = self.form.texts.get(name as usize).is_some_and(|t| &**t == "length");
                of_value(d, if length { Measure::NUMBER } else { self.value(of) }, self);
            }
            Op::Pick(d, table, _) => of_value(d, self.picked(table), self),
            Op::PickNumber(d, table, _) => of_number(d, self.picked(table), self),
            Op::Store(field, at, a) => {
                self.stored(Access { field, first: at as usize, count: Some(1) }, self.number(a), span);
            }
            Op::StoreAt(view, index, a) => {
                self.stored(element(view, self.literal(index)), self.number(a), span);
            }
            Op::Fill(view, a) => self.stored(whole(view), self.number(a), span),
            Op::StoreGlobal(slot, a) => self.store(slot, self.value(a)),
            _ => self.unknown(op),
        }
    }

    /// The results of everything else are unknown.
    fn unknown(&mut self, op: &Op) {
        let (mut given, mut op) = (Vec::new(), *op);
        op.each(&mut |u| match u {
            super::Use::Gives(d) => given.push(At::Number(*d)),
            super::Use::GivesValue(d) => given.push(At::Value(*d)),
            _ => {}
        });
        given.into_iter().for_each(|at| self.set(at, Measure::Unknown));
    }

    fn stored(&mut self, access: Access, measure: Measure, span: &Span) {
        self.found.stores.push(Stored { access, measure, span: *span });
    }

    /// What every member of a table is.
    fn picked(&self, table: u32) -> Measure {
        let picks = self.form.picks.get(table as usize);
        let of = picks.iter().flat_map(|picks| &picks.of).map(|(_, value)| match value {
            Value::View(view) => self.access(whole(*view)),
            _ => Measure::Unknown,
        });
        of.reduce(Measure::or).unwrap_or_default()
    }

    fn binary(&mut self, op: BinaryOp, a: Num, b: Num, span: &Span) -> Measure {
        let (left, right) = (self.number(a), self.number(b));
        match op {
            BinaryOp::Add | BinaryOp::Subtract | BinaryOp::Remainder => {
                self.clash(span, left, right);
                left.sum(right)
            }
            BinaryOp::Multiply => left.product(right, self.literal(a).or(self.literal(b))),
            BinaryOp::Divide => {
                let number = self.literal(a).or(self.literal(b).map(|x| 1.0 / x));
                left.product(right.power(-1.0), number)
            }
            BinaryOp::Power => self.power(left, right, self.literal(b)),
            op if op.is_comparison() => {
                self.clash(span, left, right);
                Measure::NUMBER
            }
            _ => Measure::Unknown,
        }
    }

    fn power(&self, base: Measure, exponent: Measure, literal: Option<f64>) -> Measure {
        match (literal, base, exponent) {
            (Some(x), ..) => base.power(x),
            (None, Measure::Known(d), _) if d.is_number() => Measure::LOOSE,
            (None, Measure::Anything, Measure::Known(_)) => Measure::LOOSE,
            _ => Measure::Unknown,
        }
    }

    /// What a function of `Math` gives.
    fn math(&mut self, function: math::Function, args: Args, span: &Span) -> Measure {
        let args: Vec<Num> = args.of(&self.unit.args).iter().map(|n| Num(*n)).collect();
        let measures: Vec<Measure> = args.iter().map(|n| self.number(*n)).collect();
        let first = measures.first().copied().unwrap_or_default();
        let mut together = || {
            for (i, m) in measures.iter().enumerate().skip(1) {
                self.clash(span, measures.get(i - 1).copied().unwrap_or_default(), *m);
            }
            measures.iter().copied().reduce(Measure::sum).unwrap_or_default()
        };
        match function.name() {
            "abs" | "ceil" | "floor" | "round" | "trunc" | "fround" => first,
            "min" | "max" | "hypot" => together(),
            "sqrt" => first.power(0.5),
            "cbrt" => first.power(1.0 / 3.0),
            "pow" => {
                let exponent = args.get(1).copied();
                let second = measures.get(1).copied().unwrap_or_default();
                self.power(first, second, exponent.and_then(|n| self.literal(n)))
            }
            "atan2" => {
                together();
                Measure::Known(Dimension::RADIAN)
            }
            "acos" | "asin" | "atan" => Measure::Known(Dimension::RADIAN),
            "isFinite" | "isNaN" => Measure::NUMBER,
            "clz32" | "imul" => Measure::Unknown,
            // Of a number without a unit.
            _ => Measure::LOOSE,
        }
    }
}

/// Whether a function of several numbers gives one of their dimension.
fn keeps(name: &str) -> bool {
    matches!(name, "min" | "max" | "hypot")
}

impl Measured {
    /// A text whose value is a truth value measures nothing.
    pub(crate) fn of_type(self, result: Type) -> Measured {
        match result {
            Type::Boolean | Type::Void => Measured { value: Measure::NUMBER, ..self },
            Type::String => Measured { value: Measure::Unknown, ..self },
            _ => self,
        }
    }
}
