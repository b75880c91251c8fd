//! A formula for the state at hand: what it reads is fetched by one call of the host, then operations work on one
//! number at hand, each with a register or a constant as its other operand. The number so stays in a register of the
//! processor from operation to operation; only what is needed again later goes to memory.

use crate::formula::{ARGS, At, Formula, Step};
use crate::math::{Apply, Function};
use crate::operators::BinaryOp;
use crate::program::Host;
use crate::schema::FieldKey;
use crate::value::{Value, truthy};

/// Number of registers: a byte names each of them, so none can be out of range.
const REGISTERS: usize = 256;

/// The registers of a run.
type Registers = [f64; REGISTERS];

/// One operation on the number at hand, `x`; `r` is a register and `k` a constant.
#[derive(Clone, Copy, Debug)]
enum Op {
    /// x = r
    Take(u8),
    /// r = x
    Keep(u8),
    /// r = k
    Put(u8, f64),
    /// x + r
    Add(u8),
    /// x - r
    Subtract(u8),
    /// r - x
    SubtractFrom(u8),
    /// x r
    Multiply(u8),
    /// x / r
    Divide(u8),
    /// r / x
    DivideInto(u8),
    /// x + k
    AddConstant(f64),
    /// k - x
    SubtractFromConstant(f64),
    /// x k
    MultiplyConstant(f64),
    /// x / k
    DivideConstant(f64),
    /// x of r
    Binary(BinaryOp, u8),
    /// x of k
    BinaryConstant(BinaryOp, f64),
    Negate,
    Not,
    BitNot,
    /// By the truth of x: the first or the second.
    Choose(u8, u8),
    /// f(x)
    One(fn(f64) -> f64),
    /// f(x, r)
    Two(fn(f64, f64) -> f64, u8),
    /// f of so many arguments, from a place in the list of arguments on.
    Many(fn(&[f64]) -> f64, u8, u16),
}

impl Op {
    /// Whether it reads the register, of those that it names itself.
    fn reads(self, register: u8) -> bool {
        match self {
            Op::Take(r) | Op::Add(r) | Op::Subtract(r) | Op::SubtractFrom(r) | Op::Multiply(r) => {
                r == register
            }
            Op::Divide(r) | Op::DivideInto(r) | Op::Binary(_, r) | Op::Two(_, r) => r == register,
            Op::Choose(yes, no) => yes == register || no == register,
            _ => false,
        }
    }
}

/// A formula, ready to run.
#[derive(Clone, Debug)]
pub(crate) struct Row {
    /// What is read, in the order of the fields; it goes into the first registers.
    elements: Vec<(FieldKey, u32)>,
    /// The register that is at hand first.
    start: u8,
    ops: Vec<Op>,
    args: Vec<u8>,
    /// It gives a truth value.
    truth: bool,
}

impl Row {
    /// `None` when it needs too many registers.
    pub(crate) fn of(formula: &Formula) -> Option<Row> {
        let load =
            |step: &Step| if let Step::Load(field, index) = step { Some((*field, *index)) } else { None };
        let mut elements: Vec<_> = formula.steps.iter().filter_map(load).collect();
        elements.sort_unstable();
        let mut other = elements.len()..REGISTERS;
        let place = |step: &Step| {
            let at = match load(step) {
                Some(element) => elements.binary_search(&element).ok(),
                None => other.next(),
            };
            u8::try_from(at?).ok()
        };
        let homes = formula.steps.iter().map(place).collect::<Option<Vec<u8>>>()?;
        let loads = u8::try_from(elements.len()).ok()?;
        let mut build = Build { formula, homes, loads, ops: Vec::new(), args: Vec::new(), at_hand: None };
        for (at, step) in (0..).zip(&formula.steps) {
            build.step(at, *step)?;
        }
        build.take(formula.output)?;
        build.drop_unread();
        let start = build.start();
        Some(Row { elements, start, ops: build.ops, args: build.args, truth: formula.truth })
    }

    /// The value now; `None` when an element does not exist.
    #[inline]
    pub(crate) fn value(&self, host: &dyn Host, numbers: &mut Vec<f64>) -> Option<Value> {
        if numbers.len() < REGISTERS {
            make_room(numbers);
        }
        let r: &mut Registers = numbers.first_chunk_mut()?;
        if !host.read(&self.elements, r.get_mut(..self.elements.len())?) {
            return None;
        }
        let mut x = r[usize::from(self.start)];
        for op in &self.ops {
            x = match *op {
                Op::Take(a) => r[usize::from(a)],
                Op::Keep(a) => {
                    r[usize::from(a)] = x;
                    x
                }
                Op::Put(a, k) => {
                    r[usize::from(a)] = k;
                    x
                }
                Op::Add(a) => x + r[usize::from(a)],
                Op::Subtract(a) => x - r[usize::from(a)],
                Op::SubtractFrom(a) => r[usize::from(a)] - x,
                Op::Multiply(a) => x * r[usize::from(a)],
                Op::Divide(a) => x / r[usize::from(a)],
                Op::DivideInto(a) => r[usize::from(a)] / x,
                Op::AddConstant(k) => x + k,
                Op::SubtractFromConstant(k) => k - x,
                Op::MultiplyConstant(k) => x * k,
                Op::DivideConstant(k) => x / k,
                Op::Binary(op, a) => op.on_numbers(x, r[usize::from(a)]),
                Op::BinaryConstant(op, k) => op.on_numbers(x, k),
                Op::Negate => -x,
                Op::Not => f64::from(u8::from(!truthy(x))),
                Op::BitNot => f64::from(!crate::number::to_int32(x)),
                Op::Choose(yes, no) => r[usize::from(if truthy(x) { yes } else { no })],
                Op::One(f) => f(x),
                Op::Two(f, a) => f(x, r[usize::from(a)]),
                Op::Many(f, count, first) => self.many(f, first, count, r),
            };
        }
        Some(if self.truth { Value::Boolean(x != 0.0) } else { Value::Number(x) })
    }

    #[inline(never)]
    fn many(&self, f: fn(&[f64]) -> f64, first: u16, count: u8, r: &Registers) -> f64 {
        let args = self.args.get(usize::from(first)..).unwrap_or(&[]);
        let mut row = [0.0; ARGS];
        for (x, a) in row.iter_mut().zip(args) {
            *x = r[usize::from(*a)];
        }
        f(row.get(..usize::from(count)).unwrap_or(&row))
    }
}

/// Once for all runs in a context.
#[cold]
#[inline(never)]
fn make_room(numbers: &mut Vec<f64>) {
    numbers.resize(REGISTERS, 0.0);
}

/// The work on one formula.
struct Build<'f> {
    formula: &'f Formula,
    /// The register of each step.
    homes: Vec<u8>,
    /// Registers below this one hold what was read.
    loads: u8,
    ops: Vec<Op>,
    args: Vec<u8>,
    /// The step whose result is the number at hand.
    at_hand: Option<At>,
}

impl Build<'_> {
    fn home(&self, at: At) -> Option<u8> {
        self.homes.get(at as usize).copied()
    }

    fn constant(&self, at: At) -> Option<f64> {
        match self.formula.steps.get(at as usize) {
            Some(Step::Constant(k)) => Some(*k),
            _ => None,
        }
    }

    /// Makes a result the number at hand.
    fn take(&mut self, at: At) -> Option<()> {
        if self.at_hand != Some(at) {
            self.ops.push(Op::Take(self.home(at)?));
        }
        Some(())
    }

    /// An operation of two operands: the second may be the number at hand when there is a way round for it.
    fn two(&mut self, a: At, b: At, op: impl Fn(u8) -> Op, round: Option<fn(u8) -> Op>) -> Option<Op> {
        match round {
            Some(round) if self.at_hand == Some(b) && a != b => Some(round(self.home(a)?)),
            _ => {
                self.take(a)?;
                Some(op(self.home(b)?))
            }
        }
    }

    /// An operation, kept for later in its register.
    fn step(&mut self, at: At, step: Step) -> Option<()> {
        let op = match step {
            Step::Load(..) => return Some(()),
            Step::Constant(k) => {
                self.ops.push(Op::Put(self.home(at)?, k));
                return Some(());
            }
            Step::Add(a, b) => self.two(a, b, Op::Add, Some(Op::Add))?,
            Step::Subtract(a, b) => self.two(a, b, Op::Subtract, Some(Op::SubtractFrom))?,
            Step::Multiply(a, b) => self.two(a, b, Op::Multiply, Some(Op::Multiply))?,
            Step::Divide(a, b) => match self.constant(b) {
                Some(k) => self.one(a, Op::DivideConstant(k))?,
                None => self.two(a, b, Op::Divide, Some(Op::DivideInto))?,
            },
            Step::Binary(op, a, b) => match self.constant(b) {
                Some(k) => self.one(a, Op::BinaryConstant(op, k))?,
                None => self.two(a, b, |r| Op::Binary(op, r), None)?,
            },
            Step::AddConstant(a, k) => self.one(a, Op::AddConstant(k))?,
            Step::MultiplyConstant(a, k) => self.one(a, Op::MultiplyConstant(k))?,
            Step::SubtractFrom(k, a) => self.one(a, Op::SubtractFromConstant(k))?,
            Step::Negate(a) => self.one(a, Op::Negate)?,
            Step::Not(a) => self.one(a, Op::Not)?,
            Step::BitNot(a) => self.one(a, Op::BitNot)?,
            Step::Choose(test, yes, no) => self.one(test, Op::Choose(self.home(yes)?, self.home(no)?))?,
            Step::Math(function, first, count) => self.math(function, first, count)?,
        };
        self.ops.extend([op, Op::Keep(self.home(at)?)]);
        self.at_hand = Some(at);
        Some(())
    }

    fn one(&mut self, a: At, op: Op) -> Option<Op> {
        self.take(a)?;
        Some(op)
    }

    fn math(&mut self, function: Function, first: u32, count: u32) -> Option<Op> {
        let args = self.formula.args(first, count);
        match (function.apply_by(), args) {
            (Apply::One(f), [a, ..]) => self.one(*a, Op::One(f)),
            (Apply::Two(f), [a, b, ..]) => self.two(*a, *b, |r| Op::Two(f, r), None),
            (Apply::Many(f), args) => {
                let first = u16::try_from(self.args.len()).ok()?;
                for &a in args {
                    self.args.push(self.homes.get(a as usize).copied()?);
                }
                Some(Op::Many(f, u8::try_from(args.len()).ok()?, first))
            }
            // An argument is missing: rare enough for the machine.
            _ => None,
        }
    }

    /// The register that the first operation on a number takes, if it does nothing else: that needs no operation.
    fn start(&mut self) -> u8 {
        let first = self.ops.iter().position(|op| !matches!(op, Op::Put(..)));
        match first.and_then(|at| Some((at, *self.ops.get(at)?))) {
            Some((at, Op::Take(r))) if r < self.loads => {
                self.ops.remove(at);
                r
            }
            _ => 0,
        }
    }

    /// Leaves out what goes to registers that nothing reads.
    fn drop_unread(&mut self) {
        let read = |r: u8| self.args.contains(&r) || self.ops.iter().any(|op| op.reads(r));
        let unread = |op: &Op| matches!(*op, Op::Keep(r) | Op::Put(r, _) if !read(r));
        self.ops = self.ops.iter().filter(|op| !unread(op)).copied().collect();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
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
                let ours = row.value(&world, &mut Vec::new()).unwrap();
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
        assert!(!row.ops.iter().any(|op| matches!(op, Op::Keep(_) | Op::Put(..))), "{:?}", row.ops);
        assert_eq!(row.ops.len(), 5, "{:?}", row.ops);
    }
}
