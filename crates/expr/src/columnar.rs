//! Numeric expressions over recorded samples: every operation runs over a block of samples at once, and what several
//! expressions read is recorded once (Boncz, Zukowski and Nes, "MonetDB/X100: hyper-pipelining query execution", 2005).

use std::collections::BTreeMap;

use crate::math;
use crate::operators::BinaryOp;
use crate::program::{Host, Program};
use crate::schema::FieldKey;
use crate::value::truthy;
use crate::vm::{CodeUnit, Num, Op, Slot};

/// Samples that an operation takes at once: few enough that all registers stay in the nearest cache.
const BLOCK: usize = 32;

/// Most arguments of a function of `Math`; with more of them the expression goes by row.
const ARGS: usize = 16;

/// One operation; its result has its own number.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Step {
    Constant(f64),
    /// A column of the recording.
    Column(usize),
    Add(usize, usize),
    Subtract(usize, usize),
    Multiply(usize, usize),
    Divide(usize, usize),
    Binary(BinaryOp, usize, usize),
    Negate(usize),
    Not(usize),
    BitNot(usize),
    /// By the truth of the first: the second or the third.
    Choose(usize, usize, usize),
    /// First and number of its arguments in the list of arguments.
    Math(math::Function, usize, usize),
}

/// An expression as operations over columns.
#[derive(Clone, Debug)]
pub struct Columnar {
    steps: Vec<Step>,
    args: Vec<usize>,
    output: usize,
}

/// The elements that several expressions read, recorded sample after sample.
#[derive(Clone, Debug, Default)]
pub struct Recording {
    elements: Vec<(FieldKey, u32)>,
    columns: Vec<Vec<f64>>,
}

impl Recording {
    /// Nothing is recorded yet.
    pub fn new() -> Recording {
        Recording::default()
    }

    /// The columns of an expression that gives a number or a truth value (as 1 or 0); `None` when its value depends
    /// on more than elements of fields at known indexes.
    ///
    /// To be asked before the first sample.
    pub fn columns(&mut self, program: &Program) -> Option<Columnar> {
        let unit = program.code.units.first()?;
        if unit.result == Slot::Value || !self.columns.iter().all(Vec::is_empty) {
            return None;
        }
        let known = self.elements.len();
        let mut build = Build { recording: self, unit, steps: Vec::new(), args: Vec::new(), choices: 0 };
        let mut registers = BTreeMap::new();
        for &(register, x) in &unit.numbers {
            registers.insert(register.0, build.step(Step::Constant(x)));
        }
        let output = build.follow(0, registers);
        let Build { steps, args, .. } = build;
        if output.is_none() {
            self.elements.truncate(known);
            self.columns.truncate(known);
        }
        Some(Columnar { steps, args, output: output? })
    }

    /// Makes room for so many samples, so that recording them allocates nothing.
    pub fn reserve(&mut self, samples: usize) {
        for column in &mut self.columns {
            column.reserve_exact(samples);
        }
    }

    /// Records the elements as they are now.
    pub fn sample(&mut self, host: &dyn Host) {
        for (&(field, index), column) in self.elements.iter().zip(&mut self.columns) {
            column.push(host.get(field, index as usize).unwrap_or(f64::NAN));
        }
    }

    /// Number of samples.
    pub fn len(&self) -> usize {
        self.columns.first().map_or(0, Vec::len)
    }

    /// Whether there is no sample.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Number of different elements that are recorded.
    pub fn width(&self) -> usize {
        self.elements.len()
    }
}

/// Most choices of an expression that goes by columns.
const CHOICES: usize = 16;

/// The operation that last stored into each register of the machine.
type Registers = BTreeMap<u32, usize>;

/// The work on one expression.
struct Build<'r> {
    recording: &'r mut Recording,
    unit: &'r CodeUnit,
    steps: Vec<Step>,
    args: Vec<usize>,
    choices: usize,
}

impl Build<'_> {
    /// The result of the code from an operation on. Where it may go two ways, both are computed and one is chosen for
    /// each sample: nothing here has an effect, and what both have in common is one operation.
    fn follow(&mut self, mut at: usize, mut registers: Registers) -> Option<usize> {
        loop {
            let op = self.unit.ops.get(at)?;
            match *op {
                Op::Return => return registers.get(&0).copied(),
                Op::Jump(to) if to as usize > at => at = to as usize,
                Op::JumpIf(when, test, to) if to as usize > at && self.choices < CHOICES => {
                    self.choices += 1;
                    let test = *registers.get(&test.0)?;
                    let there = self.follow(to as usize, registers.clone())?;
                    let here = self.follow(at + 1, registers)?;
                    let (yes, no) = if when { (there, here) } else { (here, there) };
                    return Some(self.step(Step::Choose(test, yes, no)));
                }
                _ => {
                    self.op(op, &mut registers)?;
                    at += 1;
                }
            }
        }
    }

    /// An operation, or the same one that is there already.
    fn step(&mut self, step: Step) -> usize {
        let same = |s: &Step| match (s, &step) {
            (Step::Constant(a), Step::Constant(b)) => a.to_bits() == b.to_bits(),
            (a, b) => a == b,
        };
        if let Some(at) = self.steps.iter().position(same) {
            return at;
        }
        self.steps.push(step);
        self.steps.len() - 1
    }

    fn op(&mut self, op: &Op, registers: &mut Registers) -> Option<()> {
        let at = |register: Num| registers.get(&register.0).copied();
        let (dst, step) = match *op {
            Op::Load(dst, field, index) => {
                let elements = &mut self.recording.elements;
                let column = match elements.iter().position(|e| *e == (field, index)) {
                    Some(column) => column,
                    None => {
                        elements.push((field, index));
                        self.recording.columns.push(Vec::new());
                        self.recording.elements.len() - 1
                    }
                };
                (dst, Step::Column(column))
            }
            Op::Move(dst, src) => {
                let value = at(src)?;
                registers.insert(dst.0, value);
                return Some(());
            }
            Op::Add(dst, a, b) => (dst, Step::Add(at(a)?, at(b)?)),
            Op::Subtract(dst, a, b) => (dst, Step::Subtract(at(a)?, at(b)?)),
            Op::Multiply(dst, a, b) => (dst, Step::Multiply(at(a)?, at(b)?)),
            Op::Divide(dst, a, b) => (dst, Step::Divide(at(a)?, at(b)?)),
            Op::Less(dst, a, b) => (dst, Step::Binary(BinaryOp::Less, at(a)?, at(b)?)),
            Op::Binary(dst, op, a, b) => (dst, Step::Binary(op, at(a)?, at(b)?)),
            Op::Negate(dst, a) => (dst, Step::Negate(at(a)?)),
            Op::Not(dst, a) => (dst, Step::Not(at(a)?)),
            Op::BitNot(dst, a) => (dst, Step::BitNot(at(a)?)),
            Op::Math(_, _, _, count) if count as usize > ARGS => return None,
            Op::Math(dst, function, first, count) => {
                let from = self.args.len();
                for i in 0..count {
                    self.args.push(at(Num(first.0 + i))?);
                }
                (dst, Step::Math(function, from, count as usize))
            }
            _ => return None,
        };
        let value = self.step(step);
        registers.insert(dst.0, value);
        Some(())
    }
}

impl Columnar {
    /// The values at all samples of the recording that it was made for.
    pub fn evaluate(&self, recording: &Recording) -> Vec<f64> {
        let mut out = vec![0.0; recording.len()];
        self.evaluate_into(recording, &mut Vec::new(), &mut out);
        out
    }

    /// The same into a slice as long as the recording; `scratch` is kept from call to call, so that nothing is
    /// allocated.
    pub fn evaluate_into(&self, recording: &Recording, scratch: &mut Vec<[f64; BLOCK]>, out: &mut [f64]) {
        scratch.resize(self.steps.len(), [0.0; BLOCK]);
        for (i, step) in self.steps.iter().enumerate() {
            if let (Step::Constant(x), Some(register)) = (step, scratch.get_mut(i)) {
                *register = [*x; BLOCK];
            }
        }
        for (block, out) in out.chunks_mut(BLOCK).enumerate() {
            for (i, step) in self.steps.iter().enumerate() {
                let (before, rest) = scratch.split_at_mut(i);
                if let Some(dst) = rest.first_mut() {
                    self.block(step, before, dst, recording, block * BLOCK);
                }
            }
            if let Some(result) = scratch.get(self.output).and_then(|r| r.get(..out.len())) {
                out.copy_from_slice(result);
            }
        }
    }

    /// One operation over a block. Operands are results of operations before it.
    #[inline]
    fn block(
        &self,
        step: &Step,
        before: &[[f64; BLOCK]],
        dst: &mut [f64; BLOCK],
        recording: &Recording,
        at: usize,
    ) {
        let mut two = |a: usize, b: usize, f: &dyn Fn(f64, f64) -> f64| {
            for ((d, a), b) in dst.iter_mut().zip(&before[a]).zip(&before[b]) {
                *d = f(*a, *b);
            }
        };
        match *step {
            Step::Constant(_) => {}
            Step::Column(column) => {
                let samples = recording.columns.get(column).and_then(|c| c.get(at..)).unwrap_or(&[]);
                let n = samples.len().min(BLOCK);
                dst[..n].copy_from_slice(&samples[..n]);
            }
            Step::Add(a, b) => add(dst, &before[a], &before[b]),
            Step::Subtract(a, b) => subtract(dst, &before[a], &before[b]),
            Step::Multiply(a, b) => multiply(dst, &before[a], &before[b]),
            Step::Divide(a, b) => divide(dst, &before[a], &before[b]),
            Step::Binary(op, a, b) => two(a, b, &|a, b| op.on_numbers(a, b)),
            Step::Negate(a) => two(a, a, &|a, _| -a),
            Step::Not(a) => two(a, a, &|a, _| f64::from(u8::from(!truthy(a)))),
            Step::BitNot(a) => two(a, a, &|a, _| f64::from(!crate::number::to_int32(a))),
            Step::Choose(test, yes, no) => {
                let ways = before[yes].iter().zip(&before[no]);
                for ((d, test), (yes, no)) in dst.iter_mut().zip(&before[test]).zip(ways) {
                    *d = if truthy(*test) { *yes } else { *no };
                }
            }
            Step::Math(function, first, count) => {
                let args = self.args.get(first..first + count).unwrap_or(&[]);
                let mut row = [0.0; ARGS];
                for (i, d) in dst.iter_mut().enumerate() {
                    for (x, &a) in row.iter_mut().zip(args) {
                        *x = before[a][i];
                    }
                    *d = function.apply(&row[..args.len()]);
                }
            }
        }
    }
}

/// Loops over whole blocks, which the compiler turns into vector instructions.
macro_rules! blocks {
    ($($name:ident = $op:tt;)*) => { $(
        #[inline]
        fn $name(dst: &mut [f64; BLOCK], a: &[f64; BLOCK], b: &[f64; BLOCK]) {
            for i in 0..BLOCK {
                dst[i] = a[i] $op b[i];
            }
        }
    )* };
}
blocks! {
    add = +;
    subtract = -;
    multiply = *;
    divide = /;
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mock::{Mock, World};
    use crate::{Compiler, Context, Globals};

    #[test]
    fn columns_give_what_rows_give() {
        let mut globals = Globals::new();
        let mut compiler = Compiler::new(&Mock, &mut globals);
        let sources = [
            "1000 * (data.qpos[2] - (1 - 0.5 * 9.81 * data.time * data.time))",
            "Math.hypot(data.qpos[0], data.qpos[1], data.qpos[2]) % 7",
            "-data.qpos[2] > data.time",
            "0.5 * model.body_mass[1] * data.qvel[0] ** 2",
            "~(data.qpos[0] | 5) + Math.max(data.qpos[1], NaN)",
            "2 * Math.PI",
            "data.time > 20 ? data.qpos[2] : data.time > 10 ? -data.qpos[2] : 0.5",
            "data.qpos[2] > 0 && data.time % 2 < 1",
            "!(data.qpos[2] > 0) || data.time % 2 < 1",
            "(data.qpos[2] || 7) + (data.time < 3 ? NaN : 1)",
        ];
        let programs: Vec<Program> =
            sources.iter().map(|s| compiler.expression(s).program.unwrap()).collect();
        let mut recording = Recording::new();
        let columnar: Vec<Columnar> = programs.iter().map(|p| recording.columns(p).unwrap()).collect();
        assert_eq!(recording.width(), 6); // time, three of qpos, a mass, a velocity
        let (mut world, mut context) = (World::new(), Context::new());
        let mut rows: Vec<Vec<f64>> = vec![Vec::new(); sources.len()];
        for i in 0..100 {
            world.fields[0][0] = f64::from(i) * 0.37;
            world.fields[1][2] = 3.0 - f64::from(i);
            recording.sample(&world);
            for (row, program) in rows.iter_mut().zip(&programs) {
                row.push(program.run(&mut world, &mut context, None).unwrap().to_number());
            }
        }
        for ((row, columnar), source) in rows.iter().zip(&columnar).zip(sources) {
            let bits = |v: &[f64]| v.iter().map(|x| x.to_bits()).collect::<Vec<_>>();
            assert_eq!(bits(row), bits(&columnar.evaluate(&recording)), "{source}");
        }
    }

    #[test]
    fn what_depends_on_more_has_no_columns() {
        let mut globals = Globals::new();
        let mut compiler = Compiler::new(&Mock, &mut globals);
        let mut recording = Recording::new();
        for source in [
            "ctx.a + data.time",
            "data.qpos[data.ncon]",
            "data.time + (data.qpos[1] || 'a')",
            "say('a', 1, 2)",
        ] {
            let program = compiler.expression(source).program.unwrap();
            assert!(recording.columns(&program).is_none(), "{source}");
            assert_eq!(recording.width(), 0, "{source}");
        }
    }
}
