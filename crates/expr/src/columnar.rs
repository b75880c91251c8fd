//! Numeric expressions over recorded samples: every operation runs over a block of samples at once, and what several
//! expressions read is recorded once (Boncz, Zukowski and Nes, "MonetDB/X100: hyper-pipelining query execution", 2005).

use std::collections::BTreeMap;

use crate::math;
use crate::operators::BinaryOp;
use crate::program::{Host, Program};
use crate::schema::FieldKey;
use crate::vm::{Num, Op, Slot};

/// Samples that an operation takes at once: few enough that all registers stay in the nearest cache.
const BLOCK: usize = 32;

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
    /// on more than elements of fields at known indexes, or when it chooses between operations.
    ///
    /// To be asked before the first sample.
    pub fn columns(&mut self, program: &Program) -> Option<Columnar> {
        let unit = program.code.units.first()?;
        if unit.result == Slot::Value || !self.columns.iter().all(Vec::is_empty) {
            return None;
        }
        let mut build =
            Build { recording: self, steps: Vec::new(), args: Vec::new(), registers: BTreeMap::new() };
        for &(register, x) in &unit.numbers {
            let at = build.step(Step::Constant(x));
            build.registers.insert(register.0, at);
        }
        for op in &unit.ops {
            if matches!(op, Op::Return) {
                let output = build.at(Num(0))?;
                return Some(Columnar { steps: build.steps, args: build.args, output });
            }
            build.op(op)?;
        }
        None
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

/// The work on one expression.
struct Build<'r> {
    recording: &'r mut Recording,
    steps: Vec<Step>,
    args: Vec<usize>,
    /// The operation that last stored into a register of the machine.
    registers: BTreeMap<u32, usize>,
}

impl Build<'_> {
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

    fn at(&self, register: Num) -> Option<usize> {
        self.registers.get(&register.0).copied()
    }

    fn op(&mut self, op: &Op) -> Option<()> {
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
                let at = self.at(src)?;
                self.registers.insert(dst.0, at);
                return Some(());
            }
            Op::Add(dst, a, b) => (dst, Step::Add(self.at(a)?, self.at(b)?)),
            Op::Subtract(dst, a, b) => (dst, Step::Subtract(self.at(a)?, self.at(b)?)),
            Op::Multiply(dst, a, b) => (dst, Step::Multiply(self.at(a)?, self.at(b)?)),
            Op::Divide(dst, a, b) => (dst, Step::Divide(self.at(a)?, self.at(b)?)),
            Op::Less(dst, a, b) => (dst, Step::Binary(BinaryOp::Less, self.at(a)?, self.at(b)?)),
            Op::Binary(dst, op, a, b) => (dst, Step::Binary(op, self.at(a)?, self.at(b)?)),
            Op::Negate(dst, a) => (dst, Step::Negate(self.at(a)?)),
            Op::Not(dst, a) => (dst, Step::Not(self.at(a)?)),
            Op::BitNot(dst, a) => (dst, Step::BitNot(self.at(a)?)),
            Op::Math(dst, function, first, count) => {
                let from = self.args.len();
                for i in 0..count {
                    let at = self.at(Num(first.0 + i))?;
                    self.args.push(at);
                }
                (dst, Step::Math(function, from, count as usize))
            }
            _ => return None,
        };
        let at = self.step(step);
        self.registers.insert(dst.0, at);
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
            Step::Not(a) => two(a, a, &|a, _| f64::from(u8::from(!crate::value::truthy(a)))),
            Step::BitNot(a) => two(a, a, &|a, _| f64::from(!crate::number::to_int32(a))),
            Step::Math(function, first, count) => {
                let args = self.args.get(first..first + count).unwrap_or(&[]);
                let mut row = Vec::new();
                for i in 0..BLOCK {
                    row.clear();
                    row.extend(args.iter().map(|&a| before[a][i]));
                    dst[i] = function.apply(&row);
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
        for source in
            ["ctx.a", "data.qpos[data.ncon]", "data.time > 1 ? 1 : 2", "'a' + data.time", "bodyId('light')"]
        {
            let program = compiler.expression(source).program.unwrap();
            let columns = Recording::new().columns(&program);
            assert!(columns.is_none() || source.starts_with("bodyId"), "{source}");
        }
    }
}
