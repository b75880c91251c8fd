//! The measure of the result of one operation, given the measures of its operands.

use super::flow::MeasureWalk;
use super::measured::{AngleArgument, DimensionStore};
use super::natives as handed;
use crate::analysis::effects::{element, whole};
use crate::dimension::{Dimension, Measure};
use crate::effects::Access;
use crate::math;
use crate::operators::{BinaryOp, UnaryOp};
use crate::schema::Param;
use crate::ssa::{Args, Num, Op, Operand, OperandUse, Representation, Val};
use crate::tables::{MethodId, UnitId};
use crate::types::FunctionId;
use crate::value::Value;
use labspec_finding::Span;

impl MeasureWalk<'_> {
    /// Analyses an operation on numbers and variables.
    pub(super) fn op(&mut self, op: &Op, span: &Span) {
        let (number, value) = (Operand::Number, Operand::Value);
        match *op {
            Op::Load(d, field, index) => {
                let m = self.access(Access { field, first: index as usize, count: Some(1) });
                self.set(number(d), m);
            }
            Op::LoadAt(d, view, index) => self.set(number(d), self.element(view, index)),
            Op::LoadValue(d, view, index) => {
                self.set(value(d), self.access(element(view, Some(f64::from(index)))));
            }
            Op::LoadValueAt(d, view, index) => self.set(value(d), self.element(view, index)),
            Op::Length(d, _) | Op::Truthy(d, _) => self.set(number(d), Measure::NUMBER),
            Op::Input(d) => self.set(value(d), self.around.given.value),
            Op::Global(d, slot) => self.set(value(d), self.variable(slot)),
            Op::GlobalNumber(d, slot) => self.set(number(d), self.variable(slot)),
            Op::BoxNumber(d, a) => self.set(value(d), self.number(a)),
            Op::BoxBoolean(d, _) => self.set(value(d), Measure::NUMBER),
            Op::ToNumber(d, a) | Op::ToIndex(d, a) => self.set(number(d), self.value(a)),
            Op::ToText(d, a) => self.set(value(d), self.value(a)),
            Op::Unary(d, op, a) => {
                let m = match op {
                    UnaryOp::Minus | UnaryOp::Plus => self.number(a),
                    UnaryOp::Not => Measure::NUMBER,
                    UnaryOp::BitNot | UnaryOp::TypeOf => Measure::Unknown,
                };
                self.set(number(d), m);
            }
            Op::Binary(d, op, a, b) => {
                let m = self.binary(op, a, b, span);
                self.set(number(d), m);
            }
            Op::Select(d, _, a, b) => self.set(number(d), self.number(a).or(self.number(b))),
            Op::Math(d, function, args) => {
                let m = self.math(function, args, span);
                self.set(number(d), m);
            }
            Op::MathOver(d, function, list) => {
                let list = self.value(list);
                let m = if keeps(function.name()) { list } else { Measure::Unknown };
                self.set(number(d), m);
            }
            Op::Plus(d, a, b) => self.set(value(d), self.value(a).sum(self.value(b))),
            Op::Compare(d, _, a, b) => {
                self.clash(span, self.value(a), self.value(b));
                self.set(number(d), Measure::NUMBER);
            }
            _ => self.host_op(op, span),
        }
    }

    /// Analyses operations with effects outside the program: calls of the host, and stores.
    fn host_op(&mut self, op: &Op, span: &Span) {
        let (number, value) = (Operand::Number, Operand::Value);
        match *op {
            Op::CallHost(d, function, args) => {
                let args = args.operands(&self.unit.args);
                self.host_angles(function, args, span);
                let first = args.first().and_then(|v| self.unit.constant_value(Val(*v)));
                let gives = self.around.schema.gives(function, first.map(Value::to_number));
                let m = gives.resolve(|i| args.get(i).map_or(Measure::Unknown, |v| self.value(Val(*v))));
                self.set(value(d), m);
            }
            Op::Aggregate(d, slot) => {
                let m = self.around.aggregates.get(&(slot as usize)).copied().unwrap_or_default();
                self.set(number(d), m);
            }
            Op::Pick(d, table, _) => self.set(value(d), self.measure_of_members(table)),
            Op::PickNumber(d, table, _) => self.set(number(d), self.measure_of_members(table)),
            Op::Store(field, index, a) => {
                self.stored(Access { field, first: index as usize, count: Some(1) }, self.number(a), span);
            }
            Op::StoreAt(view, index, a) => {
                self.stored(element(view, self.literal(index)), self.number(a), span);
            }
            Op::Fill(view, a) => self.stored(whole(view), self.number(a), span),
            Op::StoreGlobal(slot, a) => {
                let measure = self.value(a);
                let before = self.found.variables.entry(slot).or_insert(Measure::Anything);
                *before = before.or(measure);
            }
            _ => self.collection_op(op),
        }
    }

    /// Analyses operations on lists, records and strings.
    fn collection_op(&mut self, op: &Op) {
        let value = Operand::Value;
        match *op {
            Op::List(d, args) => {
                for v in args.operands(&self.unit.args) {
                    self.join(value(d), self.value(Val(*v)));
                }
                self.join(value(d), Measure::Anything);
            }
            Op::NewRecord(d) | Op::EmptyCell(d) => self.join(value(d), Measure::Anything),
            Op::NewCell(d, a) => self.join(value(d), self.value(a)),
            Op::Append(into, a, _)
            | Op::CellSet(into, a, _)
            | Op::Put(into, _, a)
            | Op::PutAll(into, a)
            | Op::StoreItem(into, _, a, _)
            | Op::StoreMember(into, _, a, _) => self.join(value(into), self.value(a)),
            Op::Member(d, list, name) => {
                let length = self.around.form.texts.get(name as usize).is_some_and(|t| &**t == "length");
                self.set(value(d), if length { Measure::NUMBER } else { self.measure_of_elements(list) });
            }
            Op::CellGet(d, list) | Op::Element(d, list, _) | Op::ElementAt(d, list, _) => {
                self.set(value(d), self.measure_of_elements(list));
            }
            Op::Method(d, name, args) => {
                let args: Vec<Measure> =
                    args.operands(&self.unit.args).iter().map(|v| self.value(Val(*v))).collect();
                let m = handed::method(name, &args);
                if let Some(receiver) = self.receiver(op).filter(|_| changes(name)) {
                    args.iter().skip(1).for_each(|m| self.join(value(receiver), *m));
                }
                self.set(value(d), m);
            }
            Op::Native(d, function, args) => {
                let args: Vec<Measure> =
                    args.operands(&self.unit.args).iter().map(|v| self.value(Val(*v))).collect();
                self.set(value(d), handed::free(function, &args));
            }
            Op::MethodList(d, name, receiver, list) => {
                let args = [self.value(receiver), self.value(list)];
                if changes(name) {
                    self.join(value(receiver), self.value(list));
                }
                self.set(value(d), handed::method(name, &args));
            }
            Op::NativeList(d, function, list) => {
                self.set(value(d), handed::free(function, &[self.value(list)]));
            }
            _ => self.call_op(op),
        }
    }

    /// Analyses functions of the program and their calls.
    fn call_op(&mut self, op: &Op) {
        let (number, value) = (Operand::Number, Operand::Value);
        match *op {
            Op::Closure(d, unit, args) => {
                let used = args.operands(&self.unit.args).iter().map(|v| Val(*v)).collect();
                self.closures.insert(self.unit.same.value(d).0, (unit, used));
                self.set(value(d), Measure::Unknown);
            }
            Op::Invoke(d, function, args) => {
                let args = args.operands(&self.unit.args).iter().map(|v| value(Val(*v))).collect();
                match self.closures.get(&self.unit.same.value(function).0).cloned() {
                    Some((unit, used)) => self.invoke(unit, args, used.into_iter().map(value).collect()),
                    None => {
                        self.wild = true;
                        self.result_measure = Measure::Unknown;
                    }
                }
                self.set(value(d), self.result_measure);
            }
            Op::InvokeList(d, ..) => {
                self.wild = true;
                self.set(value(d), Measure::Unknown);
            }
            Op::PassNumber(register, a) => {
                self.passed[0].insert(register, number(a));
            }
            Op::PassValue(register, a) => {
                self.passed[1].insert(register, value(a));
            }
            Op::Call(unit) => {
                // Numbers and values are numbered separately, each in the order of the parameters.
                let [numbers, values] = std::mem::take(&mut self.passed);
                let (mut numbers, mut values) = (numbers.into_values(), values.into_values());
                let slots = self.around.form.units.get(unit as usize);
                let given = slots.iter().flat_map(|u| u.params.iter().chain(&u.captures));
                let given = given.filter_map(|slot| match slot {
                    Representation::Value => values.next(),
                    _ => numbers.next(),
                });
                self.invoke(unit, given.collect(), Vec::new());
            }
            Op::TakeNumber(d) => self.set(number(d), self.result_measure),
            Op::TakeValue(d) => self.set(value(d), self.result_measure),
            _ => self.unknown(op),
        }
    }

    /// Analyses a call of a function of the program. Afterwards, the measures of the lists and shared variables that it may
    /// have changed are updated. As in JavaScript, a missing argument is `undefined` and an extra argument is ignored.
    fn invoke(&mut self, unit: UnitId, args: Vec<Operand>, used: Vec<Operand>) {
        let expected = self.around.form.units.get(unit as usize).map_or(0, |u| u.params.len());
        let mut given: Vec<Option<Operand>> = args.into_iter().map(Some).collect();
        if !used.is_empty() || given.len() < expected {
            given.resize(expected, None);
        }
        given.extend(used.into_iter().map(Some));
        let measures: Vec<Measure> = given
            .iter()
            .map(|operand| operand.map_or(Measure::Anything, |operand| self.at(operand)))
            .collect();
        let (result, after) = self.call(unit, &measures);
        for (operand, measure) in given.into_iter().zip(after) {
            if let Some(operand @ Operand::Value(_)) = operand {
                self.join(operand, measure);
            }
        }
        self.result_measure = result;
    }

    /// The measure of the elements of a list or a record, or of the value of a shared variable.
    fn measure_of_elements(&self, list: Val) -> Measure {
        if self.wild && self.unit.constant_value(list).is_none() {
            Measure::Unknown
        } else {
            self.value(list)
        }
    }

    fn receiver(&self, op: &Op) -> Option<Val> {
        match op {
            Op::Method(_, _, args) => args.operands(&self.unit.args).first().map(|v| Val(*v)),
            _ => None,
        }
    }

    /// Marks the results of all other operations as unknown.
    fn unknown(&mut self, op: &Op) {
        let (mut given, mut op) = (Vec::new(), *op);
        op.each(&mut |u| match u {
            OperandUse::Gives(d) => given.push(Operand::Number(*d)),
            OperandUse::GivesValue(d) => given.push(Operand::Value(*d)),
            _ => {}
        });
        given.into_iter().for_each(|operand| self.set(operand, Measure::Unknown));
    }

    /// Records the arguments of a host function that are angles. Objects are not passed.
    fn host_angles(&mut self, function: FunctionId, args: &[u32], span: &Span) {
        let info = self.around.schema.function(function);
        let passed = info.params.iter().filter(|p| !matches!(p, Param::Object(_)));
        for (param, v) in passed.zip(args) {
            if *param == Param::Angle {
                let measure = self.value(Val(*v));
                self.found.angles.push(AngleArgument { span: *span, function: info.name.clone(), measure });
            }
        }
    }

    fn stored(&mut self, access: Access, measure: Measure, span: &Span) {
        self.found.stores.push(DimensionStore { access, measure, span: *span });
    }

    /// The measure that every member of a table has.
    fn measure_of_members(&self, table: u32) -> Measure {
        let picks = self.around.form.picks.get(table as usize);
        let measures = picks.iter().flat_map(|picks| &picks.members).map(|(_, value)| match value {
            Value::View(view) => self.access(whole(*view)),
            _ => Measure::Unknown,
        });
        measures.reduce(Measure::or).unwrap_or_default()
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
            (None, Measure::Dimension(d), _) if d.is_number() => Measure::UNCERTAIN_FACTOR,
            (None, Measure::Anything, Measure::Dimension(_)) => Measure::UNCERTAIN_FACTOR,
            _ => Measure::Unknown,
        }
    }

    /// The measure of the result of a function of `Math`.
    fn math(&mut self, function: math::MathFunction, args: Args, span: &Span) -> Measure {
        let args: Vec<Num> = args.operands(&self.unit.args).iter().map(|n| Num(*n)).collect();
        let measures: Vec<Measure> = args.iter().map(|n| self.number(*n)).collect();
        let first = measures.first().copied().unwrap_or_default();
        if matches!(function.name(), "sin" | "cos" | "tan") {
            let argument = AngleArgument { span: *span, function: function.path(), measure: first };
            self.found.angles.push(argument);
        }
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
                Measure::Dimension(Dimension::RADIAN)
            }
            "acos" | "asin" | "atan" => Measure::Dimension(Dimension::RADIAN),
            "isFinite" | "isNaN" => Measure::NUMBER,
            "clz32" | "imul" => Measure::Unknown,
            // The other functions return a number without a unit.
            _ => Measure::UNCERTAIN_FACTOR,
        }
    }
}

/// Whether a method changes the elements of its receiver.
fn changes(name: MethodId) -> bool {
    name.rows().any(|row| row.changes)
}

/// Whether the result of a function of several numbers has their dimension.
fn keeps(name: &str) -> bool {
    matches!(name, "min" | "max" | "hypot")
}
