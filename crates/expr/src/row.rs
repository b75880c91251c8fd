//! A formula for the state at hand: what it reads is fetched by one call of the host, then operations work on one
//! number at hand, each with a register or a constant as its other operand. The number so stays in a register of the
//! processor from operation to operation; only what is needed again later goes to memory.

use crate::formula::{Formula, Step, StepId};
use crate::math::{Apply, FEW, Function};
use crate::operation::select;
use crate::operators::{BinaryOp, UnaryOp};
use crate::types::FieldKey;
use crate::value::Value;
use crate::watch::Watch;

/// An element of a field, by its place in the whole field.
pub(crate) type Element = (FieldKey, u32);

/// Number of registers: a byte names each of them, so none can be out of range.
pub(crate) const REGISTERS: usize = 256;

/// The registers of a run.
pub(crate) type Registers = [f64; REGISTERS];

/// One operation on the number at hand, `x`; `r` is a register and `k` a constant. The most frequent have a place of their
/// own, and so does each order of their operands.
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
    /// x k
    MultiplyConstant(f64),
    /// x of r
    Binary(BinaryOp, u8),
    /// r of x
    Round(BinaryOp, u8),
    /// x of k
    Right(BinaryOp, f64),
    /// k of x
    Left(BinaryOp, f64),
    Unary(UnaryOp),
    /// By the truth of x: the first or the second.
    Select(u8, u8),
    /// f(x)
    One(fn(f64) -> f64),
    /// f(x), which says whether x is a number.
    Asks(fn(f64) -> f64),
    /// f(x, r)
    Two(fn(f64, f64) -> f64, u8),
    /// f of so many arguments, from a place in the list of arguments on.
    Many(fn(&[f64]) -> f64, u8, u16),
}

impl Op {
    /// The registers that it reads, of those that it names itself.
    fn reads(self) -> [Option<u8>; 2] {
        match self {
            Op::Take(r) | Op::Add(r) | Op::Subtract(r) | Op::SubtractFrom(r) | Op::Multiply(r) => {
                [Some(r), None]
            }
            Op::Divide(r) | Op::DivideInto(r) | Op::Binary(_, r) => [Some(r), None],
            Op::Round(_, r) | Op::Two(_, r) => [Some(r), None],
            Op::Select(yes, no) => [Some(yes), Some(no)],
            _ => [None, None],
        }
    }

    /// Whether the result is NaN wherever an operand is, as far as it is known.
    fn passes_nan(self) -> bool {
        use BinaryOp::{Add, Divide, Multiply, Remainder, Subtract};
        match self {
            Op::Binary(op, _) | Op::Round(op, _) | Op::Right(op, _) | Op::Left(op, _) => {
                matches!(op, Add | Subtract | Multiply | Divide | Remainder)
            }
            Op::Unary(op) => matches!(op, UnaryOp::Minus | UnaryOp::Plus),
            Op::One(f) => f(f64::NAN).is_nan(),
            Op::Select(..) | Op::Two(..) | Op::Many(..) => false,
            _ => true,
        }
    }
}

/// A formula, ready to run.
#[derive(Clone, Debug)]
pub(crate) struct Row {
    /// What is read, in the order of the fields; it goes into the first registers.
    elements: Vec<Element>,
    /// The register that is at hand first.
    start: u8,
    ops: Vec<Op>,
    args: Vec<u8>,
    /// It gives a truth value.
    truth: bool,
    /// No operation makes a number of what is none.
    passes_nan: bool,
}

/// A step whose result is wanted in a register.
pub(crate) struct Wanted {
    pub(crate) step: StepId,
    pub(crate) register: u8,
    /// Nothing reads behind the step what stood in the register before.
    pub(crate) at_once: bool,
}

impl Row {
    /// `None` when it needs too many registers.
    pub(crate) fn of(formula: &Formula) -> Option<Row> {
        let load =
            |step: &Step| if let Step::Load(field, index) = step { Some((*field, *index)) } else { None };
        let mut elements: Vec<_> = formula.steps.iter().filter_map(load).collect();
        elements.sort_unstable();
        let loads = u8::try_from(elements.len()).ok()?;
        let free = usize::from(loads)..REGISTERS;
        let mut row = Row::with(formula, &elements, &[], free.filter_map(|r| u8::try_from(r).ok()))?;
        (row.elements, row.start) = (elements, row.begin());
        Some(row)
    }

    /// A part of a program, with the registers of its inputs. Results that are wanted go to registers of the program; what
    /// else it keeps goes to free ones.
    pub(crate) fn part(formula: &Formula, wanted: &[Wanted], free: impl Iterator<Item = u8>) -> Option<Row> {
        let mut row = Row::with(formula, &[], wanted, free)?;
        row.start = row.begin();
        Some(row)
    }

    fn with(
        formula: &Formula,
        elements: &[Element],
        wanted: &[Wanted],
        mut free: impl Iterator<Item = u8>,
    ) -> Option<Row> {
        let mut homes = Vec::with_capacity(formula.steps.len());
        for (at, step) in (0..).zip(&formula.steps) {
            let home = match step {
                Step::Load(field, index) => {
                    u8::try_from(elements.binary_search(&(*field, *index)).ok()?).ok()
                }
                Step::Input(register) => u8::try_from(*register).ok(),
                _ => match wanted.iter().find(|w| w.step == at && w.at_once) {
                    Some(wanted) => Some(wanted.register),
                    None => free.next(),
                },
            };
            homes.push(home?);
        }
        let mut build = Build { formula, homes, ops: Vec::new(), args: Vec::new(), at_hand: None };
        for (at, step) in (0..).zip(&formula.steps) {
            build.step(at, *step)?;
        }
        for wanted in wanted {
            if build.home(wanted.step) == Some(wanted.register) {
                continue;
            }
            build.take(wanted.step)?;
            build.at_hand = Some(wanted.step);
            build.ops.push(Op::Keep(wanted.register));
        }
        if wanted.is_empty() {
            build.take(formula.output)?;
        }
        build.drop_unread(wanted);
        let (ops, args) = (build.ops, build.args);
        let passes_nan = ops.iter().all(|op| op.passes_nan());
        Some(Row { elements: Vec::new(), start: 0, ops, args, truth: formula.truth, passes_nan })
    }

    /// The register that the first operation on a number takes, if it does nothing else and the register holds something
    /// already: that needs no operation.
    fn begin(&mut self) -> u8 {
        let first = self.ops.iter().position(|op| !matches!(op, Op::Put(..)));
        match first.and_then(|at| Some((at, *self.ops.get(at)?))) {
            Some((at, Op::Take(r)))
                if !self.ops.iter().any(|op| matches!(op, Op::Put(put, _) if *put == r)) =>
            {
                self.ops.remove(at);
                r
            }
            _ => 0,
        }
    }

    /// Registers up to the last that it changes.
    pub(crate) fn registers(&self) -> u32 {
        let kept = |op: &Op| if let Op::Keep(r) | Op::Put(r, _) = *op { u32::from(r) + 1 } else { 0 };
        self.ops.iter().map(kept).max().unwrap_or(0)
    }

    /// The value now; `None` when an element does not exist. `read` fetches all elements at once.
    #[inline]
    pub(crate) fn value(
        &self,
        read: impl FnOnce(&[Element], &mut [f64]) -> bool,
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

    /// The value now, as [`Row::value`]; the watch notes what happens on the way.
    pub(crate) fn watched_value(
        &self,
        read: impl FnOnce(&[Element], &mut [f64]) -> bool,
        numbers: &mut Vec<f64>,
        watch: &mut Watch,
    ) -> Option<Value> {
        // There is nothing to note.
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
                Op::Take(a) => register(a),
                Op::Keep(a) => {
                    r[usize::from(a)] = x;
                    x
                }
                Op::Put(a, k) => {
                    r[usize::from(a)] = k;
                    x
                }
                // Arithmetic passes NaN on.
                Op::Add(a) => x + register(a),
                Op::Subtract(a) => x - register(a),
                Op::SubtractFrom(a) => register(a) - x,
                Op::Multiply(a) => x * register(a),
                Op::Divide(a) => x / register(a),
                Op::DivideInto(a) => register(a) / x,
                Op::AddConstant(k) => x + k,
                Op::MultiplyConstant(k) => x * k,
                Op::Binary(op, a) => watch.binary(op, x, register(a)),
                Op::Round(op, a) => watch.binary(op, register(a), x),
                Op::Right(op, k) => watch.binary(op, x, k),
                Op::Left(op, k) => watch.binary(op, k, x),
                Op::Unary(op) => watch.unary(op, x),
                Op::Select(yes, no) => {
                    watch.test(x);
                    register(select(x, yes, no))
                }
                Op::Asks(f) => f(x),
                Op::One(f) => {
                    let y = f(x);
                    watch.kept(x.is_nan(), y);
                    y
                }
                Op::Two(f, a) => {
                    let y = f(x, register(a));
                    watch.kept(x.is_nan() || register(a).is_nan(), y);
                    y
                }
                Op::Many(f, count, first) => {
                    let args = self.args.get(usize::from(first)..).unwrap_or(&[]);
                    let nan = args.iter().take(usize::from(count)).any(|a| register(*a).is_nan());
                    let y = self.many(f, first, count, r);
                    watch.kept(nan, y);
                    y
                }
            };
        }
        x
    }

    /// The number that is at hand last.
    #[inline]
    pub(crate) fn run(&self, r: &mut Registers) -> f64 {
        use BinaryOp::{Add, Divide, Multiply, Subtract};
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
                Op::Add(a) => Add.on_numbers(x, r[usize::from(a)]),
                Op::Subtract(a) => Subtract.on_numbers(x, r[usize::from(a)]),
                Op::SubtractFrom(a) => Subtract.on_numbers(r[usize::from(a)], x),
                Op::Multiply(a) => Multiply.on_numbers(x, r[usize::from(a)]),
                Op::Divide(a) => Divide.on_numbers(x, r[usize::from(a)]),
                Op::DivideInto(a) => Divide.on_numbers(r[usize::from(a)], x),
                Op::AddConstant(k) => Add.on_numbers(x, k),
                Op::MultiplyConstant(k) => Multiply.on_numbers(x, k),
                Op::Binary(op, a) => op.on_numbers(x, r[usize::from(a)]),
                Op::Round(op, a) => op.on_numbers(r[usize::from(a)], x),
                Op::Right(op, k) => op.on_numbers(x, k),
                Op::Left(op, k) => op.on_numbers(k, x),
                Op::Unary(op) => op.on_number(x),
                Op::Select(yes, no) => r[usize::from(select(x, yes, no))],
                Op::One(f) | Op::Asks(f) => f(x),
                Op::Two(f, a) => f(x, r[usize::from(a)]),
                Op::Many(f, count, first) => self.many(f, first, count, r),
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
    ops: Vec<Op>,
    args: Vec<u8>,
    /// The step whose result is the number at hand.
    at_hand: Option<StepId>,
}

impl Build<'_> {
    fn home(&self, at: StepId) -> Option<u8> {
        self.homes.get(at as usize).copied()
    }

    /// Makes a result the number at hand.
    fn take(&mut self, at: StepId) -> Option<()> {
        if self.at_hand != Some(at) {
            self.ops.push(Op::Take(self.home(at)?));
        }
        Some(())
    }

    /// An operation of two operands: the second may be the number at hand when there is a way round for it.
    fn two(&mut self, a: StepId, b: StepId, op: impl Fn(u8) -> Op, round: impl Fn(u8) -> Op) -> Option<Op> {
        if self.at_hand == Some(b) && a != b {
            return Some(round(self.home(a)?));
        }
        self.take(a)?;
        Some(op(self.home(b)?))
    }

    /// An operation, kept for later in its register.
    fn step(&mut self, at: StepId, step: Step) -> Option<()> {
        let op = match step {
            Step::Load(..) | Step::Input(_) => return Some(()),
            Step::Constant(k) => {
                self.ops.push(Op::Put(self.home(at)?, k.number()));
                return Some(());
            }
            Step::Binary(BinaryOp::Add, a, b) => self.two(a, b, Op::Add, Op::Add)?,
            Step::Binary(BinaryOp::Subtract, a, b) => self.two(a, b, Op::Subtract, Op::SubtractFrom)?,
            Step::Binary(BinaryOp::Multiply, a, b) => self.two(a, b, Op::Multiply, Op::Multiply)?,
            Step::Binary(BinaryOp::Divide, a, b) => self.two(a, b, Op::Divide, Op::DivideInto)?,
            Step::Binary(op, a, b) => self.two(a, b, |r| Op::Binary(op, r), |r| Op::Round(op, r))?,
            Step::Right(BinaryOp::Add, a, k) => self.one(a, Op::AddConstant(k.number()))?,
            Step::Right(BinaryOp::Multiply, a, k) => self.one(a, Op::MultiplyConstant(k.number()))?,
            Step::Right(op, a, k) => self.one(a, Op::Right(op, k.number()))?,
            Step::Left(op, k, a) => self.one(a, Op::Left(op, k.number()))?,
            Step::Unary(op, a) => self.one(a, Op::Unary(op))?,
            Step::Select(test, yes, no) => self.one(test, Op::Select(self.home(yes)?, self.home(no)?))?,
            Step::Math(function, first, count) => self.math(function, first, count)?,
        };
        self.ops.extend([op, Op::Keep(self.home(at)?)]);
        self.at_hand = Some(at);
        Some(())
    }

    fn one(&mut self, a: StepId, op: Op) -> Option<Op> {
        self.take(a)?;
        Some(op)
    }

    fn math(&mut self, function: Function, first: u32, count: u32) -> Option<Op> {
        let args = self.formula.args(first, count);
        match (function.apply_by(), args) {
            (Apply::One(f), [a, ..]) if function.gives_boolean() => self.one(*a, Op::Asks(f)),
            (Apply::One(f), [a, ..]) => self.one(*a, Op::One(f)),
            (Apply::Two(f), [a, b, ..]) => {
                self.take(*a)?;
                Some(Op::Two(f, self.home(*b)?))
            }
            (Apply::Many(f), args) if args.len() <= FEW => {
                let first = u16::try_from(self.args.len()).ok()?;
                for &a in args {
                    self.args.push(self.homes.get(a as usize).copied()?);
                }
                Some(Op::Many(f, u8::try_from(args.len()).ok()?, first))
            }
            // Too many arguments, or one is missing: rare enough for the machine.
            _ => None,
        }
    }

    /// Leaves out what goes to registers that nothing reads.
    fn drop_unread(&mut self, wanted: &[Wanted]) {
        let mut read = [false; REGISTERS];
        for r in wanted.iter().map(|w| w.register).chain(self.args.iter().copied()) {
            read[usize::from(r)] = true;
        }
        for op in &self.ops {
            for r in op.reads().into_iter().flatten() {
                read[usize::from(r)] = true;
            }
        }
        self.ops.retain(|op| !matches!(*op, Op::Keep(r) | Op::Put(r, _) if !read[usize::from(r)]));
    }
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
        assert!(!row.ops.iter().any(|op| matches!(op, Op::Keep(_) | Op::Put(..))), "{:?}", row.ops);
        assert_eq!(row.ops.len(), 5, "{:?}", row.ops);
    }
}
