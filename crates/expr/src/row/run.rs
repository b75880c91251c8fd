//! A compiled formula and its evaluation.

use super::operation::RowOp;
use crate::math::FEW;
use crate::operation::select;
use crate::operators::BinaryOp;
use crate::types::FieldKey;
use crate::value::Value;
use crate::watch::Watch;

/// An element of a field, by its index in the whole field.
pub(crate) type FieldElement = (FieldKey, u32);

/// The number of registers. Registers are identified by one byte, so none can be out of range.
pub(crate) const REGISTERS: usize = 256;

/// The registers of one evaluation.
pub(crate) type Registers = [f64; REGISTERS];

/// A compiled formula.
#[derive(Clone, Debug)]
pub(crate) struct Row {
    /// The elements that are read, in the order of the fields; they go to the first registers.
    pub(super) elements: Vec<FieldElement>,
    /// The register that is loaded into the accumulator first.
    pub(super) start: u8,
    pub(super) ops: Vec<RowOp>,
    pub(super) args: Vec<u8>,
    /// Whether the result is a boolean.
    pub(super) truth: bool,
    /// Whether no operation turns NaN into a number.
    pub(super) passes_nan: bool,
}

impl Row {
    /// The number of registers up to the last one that it changes.
    pub(crate) fn registers(&self) -> u32 {
        let registers_of =
            |op: &RowOp| if let RowOp::Keep(r) | RowOp::Put(r, _) = *op { u32::from(r) + 1 } else { 0 };
        self.ops.iter().map(registers_of).max().unwrap_or(0)
    }

    /// Returns the current value, or `None` if an element does not exist. `read` reads all elements at once.
    #[inline]
    pub(crate) fn value(
        &self,
        read: impl FnOnce(&[FieldElement], &mut [f64]) -> bool,
        numbers: &mut Vec<f64>,
    ) -> Option<Value> {
        if numbers.len() < REGISTERS {
            make_room(numbers);
        }
        let r: &mut Registers = numbers.first_chunk_mut()?;
        if !read(&self.elements, r.get_mut(..self.elements.len())?) {
            return None;
        }
        let x = self.run(r);
        Some(if self.truth { Value::Boolean(x != 0.0) } else { Value::Number(x) })
    }

    /// Returns the current value, as [`Row::value`]; the watch records lost NaN values and comparisons.
    pub(crate) fn watched_value(
        &self,
        read: impl FnOnce(&[FieldElement], &mut [f64]) -> bool,
        numbers: &mut Vec<f64>,
        watch: &mut Watch,
    ) -> Option<Value> {
        // There is nothing to record.
        if self.passes_nan && !watch.notes_comparisons() {
            return self.value(read, numbers);
        }
        if numbers.len() < REGISTERS {
            make_room(numbers);
        }
        let r: &mut Registers = numbers.first_chunk_mut()?;
        if !read(&self.elements, r.get_mut(..self.elements.len())?) {
            return None;
        }
        let x = self.watched_run(r, watch);
        Some(if self.truth { Value::Boolean(x != 0.0) } else { Value::Number(x) })
    }

    /// As [`Row::run`], with a watch.
    pub(crate) fn watched_run(&self, r: &mut Registers, watch: &mut Watch) -> f64 {
        let mut x = r[usize::from(self.start)];
        for op in &self.ops {
            let register = |a: u8| r[usize::from(a)];
            x = match *op {
                RowOp::Take(a) => register(a),
                RowOp::Keep(a) => {
                    r[usize::from(a)] = x;
                    x
                }
                RowOp::Put(a, k) => {
                    r[usize::from(a)] = k;
                    x
                }
                // Arithmetic propagates NaN.
                RowOp::Add(a) => x + register(a),
                RowOp::Subtract(a) => x - register(a),
                RowOp::SubtractFrom(a) => register(a) - x,
                RowOp::Multiply(a) => x * register(a),
                RowOp::Divide(a) => x / register(a),
                RowOp::DivideInto(a) => register(a) / x,
                RowOp::AddConstant(k) => x + k,
                RowOp::MultiplyConstant(k) => x * k,
                RowOp::Binary(op, a) => watch.binary(op, x, register(a)),
                RowOp::Round(op, a) => watch.binary(op, register(a), x),
                RowOp::Right(op, k) => watch.binary(op, x, k),
                RowOp::Left(op, k) => watch.binary(op, k, x),
                RowOp::Unary(op) => watch.unary(op, x),
                RowOp::Select(yes, no) => {
                    watch.test(x);
                    register(select(x, yes, no))
                }
                RowOp::Asks(f) => f(x),
                RowOp::One(f) => {
                    let y = f(x);
                    watch.note_result(x.is_nan(), y);
                    y
                }
                RowOp::Two(f, a) => {
                    let y = f(x, register(a));
                    watch.note_result(x.is_nan() || register(a).is_nan(), y);
                    y
                }
                RowOp::Many(f, count, first) => {
                    let args = self.args.get(usize::from(first)..).unwrap_or(&[]);
                    let nan = args.iter().take(usize::from(count)).any(|a| register(*a).is_nan());
                    let y = self.many(f, first, count, r);
                    watch.note_result(nan, y);
                    y
                }
            };
        }
        x
    }

    /// Executes the operations, and returns the last value of the accumulator.
    #[inline]
    pub(crate) fn run(&self, r: &mut Registers) -> f64 {
        use BinaryOp::{Add, Divide, Multiply, Subtract};
        let mut x = r[usize::from(self.start)];
        for op in &self.ops {
            x = match *op {
                RowOp::Take(a) => r[usize::from(a)],
                RowOp::Keep(a) => {
                    r[usize::from(a)] = x;
                    x
                }
                RowOp::Put(a, k) => {
                    r[usize::from(a)] = k;
                    x
                }
                RowOp::Add(a) => Add.on_numbers(x, r[usize::from(a)]),
                RowOp::Subtract(a) => Subtract.on_numbers(x, r[usize::from(a)]),
                RowOp::SubtractFrom(a) => Subtract.on_numbers(r[usize::from(a)], x),
                RowOp::Multiply(a) => Multiply.on_numbers(x, r[usize::from(a)]),
                RowOp::Divide(a) => Divide.on_numbers(x, r[usize::from(a)]),
                RowOp::DivideInto(a) => Divide.on_numbers(r[usize::from(a)], x),
                RowOp::AddConstant(k) => Add.on_numbers(x, k),
                RowOp::MultiplyConstant(k) => Multiply.on_numbers(x, k),
                RowOp::Binary(op, a) => op.on_numbers(x, r[usize::from(a)]),
                RowOp::Round(op, a) => op.on_numbers(r[usize::from(a)], x),
                RowOp::Right(op, k) => op.on_numbers(x, k),
                RowOp::Left(op, k) => op.on_numbers(k, x),
                RowOp::Unary(op) => op.on_number(x),
                RowOp::Select(yes, no) => r[usize::from(select(x, yes, no))],
                RowOp::One(f) | RowOp::Asks(f) => f(x),
                RowOp::Two(f, a) => f(x, r[usize::from(a)]),
                RowOp::Many(f, count, first) => self.many(f, first, count, r),
            };
        }
        x
    }

    #[inline(never)]
    fn many(&self, f: fn(&[f64]) -> f64, first: u16, count: u8, r: &Registers) -> f64 {
        let args = self.args.get(usize::from(first)..).unwrap_or(&[]);
        let mut row = [0.0; FEW];
        for (x, a) in row.iter_mut().zip(args) {
            *x = r[usize::from(*a)];
        }
        f(row.get(..usize::from(count)).unwrap_or(&row))
    }
}

/// Called once for all evaluations in a context.
#[cold]
#[inline(never)]
fn make_room(numbers: &mut Vec<f64>) {
    numbers.resize(REGISTERS, 0.0);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::host::Host;
    use crate::mock::{Mock, World};
    use crate::{Compiler, Context, Globals, Program};

    fn program(source: &str) -> Program {
        let mut globals = Globals::new();
        Compiler::new(&Mock, &mut globals).expression(source).program.unwrap()
    }

    #[test]
    fn rows_give_what_the_machine_gives() {
        let (q, t) = ("data.qpos[2]", "data.time");
        let mut sources: Vec<String> = [
            "data.time",
            "2 * Math.PI",
            "-data.qpos[2] > data.time",
            "data.time * data.time * data.time",
            "(data.qpos[0] + data.qpos[2]) * (data.qpos[3] - data.qpos[2]) / (data.qpos[4] - 7)",
            "(data.qpos[2] + 1) - (data.qpos[2] + 1) * (data.qpos[2] + 1)",
            "data.time > 20 ? data.qpos[2] : data.time > 10 ? -data.qpos[2] : 0.5",
            "(data.qpos[2] || 7) + (data.time < 3 ? NaN : 1)",
            "!(data.qpos[2] > 0) || data.time % 2 < 1",
            "(data.time - 1) ** 2 + 3 ** data.qpos[2] + data.time / 7 + 7 / (data.time - 1)",
            "Math.hypot(data.qpos[2], data.time, data.qpos[1] - 3) + Math.max(data.time, data.qpos[2] * 2, 4)",
            "-0 * data.qpos[2] - 0",
        ]
        .map(String::from)
        .to_vec();
        for op in BinaryOp::ALL.map(BinaryOp::symbol) {
            let sides = [
                (q, t),
                (t, q),
                (q, "3"),
                ("3", q),
                (q, q),
                ("(data.qpos[2] + 1)", t),
                (t, "(1 / data.qpos[2])"),
            ];
            sources.extend(sides.map(|(a, b)| format!("({a} {op} {b})")));
        }
        for name in crate::math::names() {
            sources.push(format!("~Math.{name}(data.qpos[2] / 9, data.time)"));
            sources.push(format!("Math.{name}(data.qpos[2] / 9) - 1"));
        }
        let mut rows = 0;
        for source in sources {
            let mut globals = Globals::new();
            let Some(program) = Compiler::new(&Mock, &mut globals).expression(&source).program else {
                continue;
            };
            let Some(row) = &program.row else { continue };
            rows += 1;
            for i in 0..40 {
                let mut world = World::new();
                world.fields[0][0] = f64::from(i) * 0.37;
                world.fields[1][2] = 3.0 - f64::from(i) / 2.0;
                let bits = |v: Value| (v.type_of(), v.to_number().to_bits());
                let ours = row.value(|elements, out| world.read(elements, out), &mut Vec::new()).unwrap();
                let theirs = crate::vm::run(&program.code, &mut world, &mut Context::new(), None).unwrap();
                let nan = ours.to_number().is_nan() && theirs.to_number().is_nan();
                assert!(nan || bits(ours.clone()) == bits(theirs.clone()), "{source}: {ours} and {theirs}");
            }
        }
        assert!(rows > 200, "only {rows} are formulas");
    }

    #[test]
    fn the_longest_formulas_are_left_to_the_machine() {
        let sum = |tens: usize| {
            let term = |i: usize| format!("data.qpos[{}] * {i}.5", i % 14);
            let ten = |i: usize| (10 * i..10 * i + 10).map(term).collect::<Vec<_>>().join(" + ");
            (0..tens).map(|i| format!("({})", ten(i))).collect::<Vec<_>>().join(" + ")
        };
        assert!(program(&sum(5)).row.is_some());
        assert!(program(&sum(20)).row.is_none());
        let value = program(&sum(20)).run(&mut World::new(), &mut Context::new(), None).unwrap();
        let expected: f64 = (0..200).map(|i| f64::from(100 + i % 14) * (f64::from(i) + 0.5)).sum();
        assert_eq!(value, Value::Number(expected));
    }

    #[test]
    fn an_element_that_does_not_exist_is_left_to_the_machine() {
        let program = program("data.efc_force[1] + 1");
        let mut world = World::new();
        let mut context = Context::new();
        assert_eq!(program.run(&mut world, &mut context, None).unwrap(), Value::Number(602.0));
        world.fields[6].pop();
        assert!(program.run(&mut world, &mut context, None).unwrap().to_number().is_nan());
        assert_eq!(context.events().len(), 1);
    }

    #[test]
    fn nothing_is_kept_that_is_not_needed_again() {
        let program = program("1000 * (data.qpos[2] - (1 - 0.5 * 9.81 * data.time * data.time))");
        let row = program.row.unwrap();
        assert_eq!(row.elements.len(), 2);
        assert!(!row.ops.iter().any(|op| matches!(op, RowOp::Keep(_) | RowOp::Put(..))), "{:?}", row.ops);
        assert_eq!(row.ops.len(), 5, "{:?}", row.ops);
    }
}
