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
pub const REGISTERS: usize = 256;

/// The registers of one evaluation.
pub(crate) type Registers = [f64; REGISTERS];

/// A compiled formula.
#[derive(Clone, Debug)]
pub struct Row {
    /// The elements that are read, in the order of the fields; they go to the first registers.
    pub elements: Vec<FieldElement>,
    /// The register that is loaded into the accumulator first.
    pub(super) start: u8,
    /// The operations, in the order in which they run.
    pub ops: Vec<RowOp>,
    pub(super) args: Vec<u8>,
    /// Whether the result is a boolean.
    pub(super) truth: bool,
    /// Whether no operation turns NaN into a number.
    pub(super) passes_nan: bool,
}

impl Row {
    /// The number of registers up to the last one that it changes.
    pub fn registers(&self) -> u32 {
        let registers_of =
            |op: &RowOp| if let RowOp::Keep(r) | RowOp::Put(r, _) = *op { u32::from(r) + 1 } else { 0 };
        self.ops.iter().map(registers_of).max().unwrap_or(0)
    }

    /// Returns the current value, or `None` if an element does not exist. `read` reads all elements at once.
    #[inline]
    pub fn value(
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
    pub fn watched_value(
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
