//! Evaluation of numeric expressions over recorded samples. Every operation processes a block of samples at once, and a
//! field element that several expressions read is recorded once (Boncz, Zukowski and Nes, "MonetDB/X100: hyper-pipelining
//! query execution", 2005).

use std::fmt;
use std::sync::Arc;

use crate::formula::{Formula, FormulaStep};
use crate::host::Host;
use crate::math::FEW;
use crate::operation::{known_operator, select};
use crate::operators::BinaryOp;
use crate::program::Program;
use crate::types::FieldKey;

/// Samples per block: few enough that all registers fit into the first-level cache.
const BLOCK: usize = 32;

/// The values of all samples of a block.
type SampleBlock = [f64; BLOCK];

/// An expression that is evaluated over the columns of a recording.
#[derive(Clone, Debug)]
pub struct Columnar {
    formula: Arc<Formula>,
    /// The column that each operation loads; unused for operations that do not load.
    columns: Vec<usize>,
    /// The identity of the schema for which it was compiled.
    identity: u64,
}

/// Why a recording and an expression or a host do not match.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Foreign {
    /// The host, or another expression, has a different identity: the same field numbers have another meaning there.
    Identity,
    /// The recording was made for other expressions and does not contain what this one reads.
    Recording,
}

impl fmt::Display for Foreign {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Foreign::Identity => "the recording and the expressions belong to different models",
            Foreign::Recording => "the recording does not contain what the expression reads",
        })
    }
}

impl std::error::Error for Foreign {}

/// The field elements that several expressions read, recorded at every sample.
#[derive(Clone, Debug, Default)]
pub struct Recording {
    /// The identity for which the expressions were compiled, or `None` if there are no expressions.
    identity: Option<u64>,
    elements: Vec<(FieldKey, u32)>,
    columns: Vec<Vec<f64>>,
}

impl Recording {
    /// An empty recording.
    pub fn new() -> Recording {
        Recording::default()
    }

    /// Registers an expression with a numeric or boolean value (as 1 or 0). Returns `None` if its value depends on anything
    /// other than field elements at known indexes. Must be called before the first sample.
    ///
    /// # Errors
    /// The expression was compiled for another schema than the earlier ones.
    pub fn columns(&mut self, program: &Program) -> Result<Option<Columnar>, Foreign> {
        let Some(formula) = program.formula.clone().filter(|_| self.columns.iter().all(Vec::is_empty)) else {
            return Ok(None);
        };
        let identity = program.identity();
        if *self.identity.get_or_insert(identity) != identity {
            return Err(Foreign::Identity);
        }
        let mut column = |step: &FormulaStep| match *step {
            FormulaStep::Load(field, index) => self.column(field, index),
            _ => 0,
        };
        let columns = formula.steps.iter().map(&mut column).collect();
        Ok(Some(Columnar { formula, columns, identity }))
    }

    /// The column of an element.
    fn column(&mut self, field: FieldKey, index: u32) -> usize {
        self.elements.iter().position(|e| *e == (field, index)).unwrap_or_else(|| {
            self.elements.push((field, index));
            self.columns.push(Vec::new());
            self.elements.len() - 1
        })
    }

    /// Reserves memory for `samples` samples, so that recording them does not allocate.
    pub fn reserve(&mut self, samples: usize) {
        for column in &mut self.columns {
            column.reserve_exact(samples);
        }
    }

    /// Records the current values of the elements.
    ///
    /// # Errors
    /// The expressions were compiled for another host. Nothing is recorded.
    pub fn sample(&mut self, host: &dyn Host) -> Result<(), Foreign> {
        if self.identity.is_some_and(|identity| identity != host.identity()) {
            return Err(Foreign::Identity);
        }
        for (&(field, index), column) in self.elements.iter().zip(&mut self.columns) {
            column.push(host.get(field, index as usize).unwrap_or(f64::NAN));
        }
        Ok(())
    }

    /// The number of samples.
    pub fn len(&self) -> usize {
        self.columns.first().map_or(0, Vec::len)
    }

    /// Whether there are no samples.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The number of distinct elements that are recorded.
    pub fn width(&self) -> usize {
        self.elements.len()
    }
}

impl Columnar {
    /// Returns the values at all samples of a recording that contains what the expression reads.
    ///
    /// # Errors
    /// The recording is from another host or was made for other expressions.
    pub fn evaluate(&self, recording: &Recording) -> Result<Vec<f64>, Foreign> {
        let mut out = vec![0.0; recording.len()];
        self.evaluate_into(recording, &mut Vec::new(), &mut out)?;
        Ok(out)
    }

    /// As [`Columnar::evaluate`], into a slice as long as the recording. Passing the same `scratch` to
    /// every call avoids allocation.
    ///
    /// # Errors
    /// As for [`Columnar::evaluate`].
    pub fn evaluate_into(
        &self,
        recording: &Recording,
        scratch: &mut Vec<SampleBlock>,
        out: &mut [f64],
    ) -> Result<(), Foreign> {
        self.fits(recording)?;
        scratch.resize(self.formula.steps.len(), [0.0; BLOCK]);
        for (i, step) in self.formula.steps.iter().enumerate() {
            if let (FormulaStep::Constant(x), Some(register)) = (step, scratch.get_mut(i)) {
                *register = [x.number(); BLOCK];
            }
        }
        for (block, out) in out.chunks_mut(BLOCK).enumerate() {
            for i in 0..self.formula.steps.len() {
                let (before, rest) = scratch.split_at_mut(i);
                if let Some(dst) = rest.first_mut() {
                    self.block(i, before, dst, recording, block * BLOCK);
                }
            }
            if let Some(result) = scratch.get(self.formula.output as usize).and_then(|r| r.get(..out.len())) {
                out.copy_from_slice(result);
            }
        }
        Ok(())
    }

    /// Checks that a recording has the same identity and contains all loaded elements in the expected columns.
    fn fits(&self, recording: &Recording) -> Result<(), Foreign> {
        if recording.identity.is_some_and(|identity| identity != self.identity) {
            return Err(Foreign::Identity);
        }
        let held = |(step, &column): (&FormulaStep, &usize)| match *step {
            FormulaStep::Load(field, index) => recording.elements.get(column) == Some(&(field, index)),
            _ => true,
        };
        let all = self.formula.steps.iter().zip(&self.columns).all(held);
        if all { Ok(()) } else { Err(Foreign::Recording) }
    }

    /// Evaluates one operation for the block that begins at a sample. The operands are results of earlier operations.
    #[inline]
    fn block(
        &self,
        i: usize,
        before: &[SampleBlock],
        dst: &mut SampleBlock,
        recording: &Recording,
        start: usize,
    ) {
        let column = |step: u32| &before[step as usize];
        match self.formula.steps[i] {
            FormulaStep::Constant(_) | FormulaStep::Input(_) => {}
            FormulaStep::Load(..) => {
                let column = self.columns.get(i).and_then(|&c| recording.columns.get(c));
                let samples = column.and_then(|c| c.get(start..)).unwrap_or(&[]);
                let n = samples.len().min(BLOCK);
                dst[..n].copy_from_slice(&samples[..n]);
            }
            FormulaStep::Unary(op, a) => one(dst, column(a), |x| op.on_number(x)),
            FormulaStep::Binary(op, a, b) => {
                known_operator!(op, |op: BinaryOp| two(dst, column(a), column(b), |a, b| op
                    .on_numbers(a, b)));
            }
            FormulaStep::Right(op, a, k) => {
                let k = k.number();
                known_operator!(op, |op: BinaryOp| one(dst, column(a), |x| op.on_numbers(x, k)));
            }
            FormulaStep::Left(op, k, a) => {
                let k = k.number();
                known_operator!(op, |op: BinaryOp| one(dst, column(a), |x| op.on_numbers(k, x)));
            }
            FormulaStep::Select(test, yes, no) => {
                let branches = column(yes).iter().zip(column(no));
                for ((d, test), (yes, no)) in dst.iter_mut().zip(column(test)).zip(branches) {
                    *d = select(*test, *yes, *no);
                }
            }
            FormulaStep::Math(function, first, count) => {
                let args = self.formula.args(first, count);
                let mut row = [0.0; FEW];
                for (sample, d) in dst.iter_mut().enumerate() {
                    for (x, &a) in row.iter_mut().zip(args) {
                        *x = column(a)[sample];
                    }
                    *d = function.apply(row.get(..args.len()).unwrap_or(&row));
                }
            }
        }
    }
}

/// A loop over a whole block, which the compiler vectorizes.
#[inline(always)]
fn one(dst: &mut SampleBlock, a: &SampleBlock, f: impl Fn(f64) -> f64) {
    for i in 0..BLOCK {
        dst[i] = f(a[i]);
    }
}

#[inline(always)]
fn two(dst: &mut SampleBlock, a: &SampleBlock, b: &SampleBlock, f: impl Fn(f64, f64) -> f64) {
    for i in 0..BLOCK {
        dst[i] = f(a[i], b[i]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mock::{Mock, World};
    use crate::{Compiler, Context, FunctionId, Globals, Heap, Value};

    #[test]
    fn columns_give_the_results_of_rows() {
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
        let columnar: Vec<Columnar> =
            programs.iter().map(|p| recording.columns(p).unwrap().unwrap()).collect();
        assert_eq!(recording.width(), 6); // time, three of qpos, a mass, a velocity
        let (mut world, mut context) = (World::new(), Context::new());
        let mut rows: Vec<Vec<f64>> = vec![Vec::new(); sources.len()];
        for i in 0..100 {
            world.fields[0][0] = f64::from(i) * 0.37;
            world.fields[1][2] = 3.0 - f64::from(i);
            recording.sample(&world).unwrap();
            for (row, program) in rows.iter_mut().zip(&programs) {
                row.push(program.run(&mut world, &mut context, None).unwrap().to_number());
            }
        }
        for ((row, columnar), source) in rows.iter().zip(&columnar).zip(sources) {
            let bits = |v: &[f64]| v.iter().map(|x| x.to_bits()).collect::<Vec<_>>();
            assert_eq!(bits(row), bits(&columnar.evaluate(&recording).unwrap()), "{source}");
        }
    }

    /// A world with the same fields as another, but a different identity.
    struct OtherWorld(World);

    impl Host for OtherWorld {
        fn get(&self, field: FieldKey, index: usize) -> Option<f64> {
            self.0.get(field, index)
        }

        fn set(&mut self, field: FieldKey, index: usize, value: f64) -> Result<(), String> {
            self.0.set(field, index, value)
        }

        fn len(&self, field: FieldKey) -> usize {
            self.0.len(field)
        }

        fn call(&mut self, heap: &mut Heap, function: FunctionId, args: &[Value]) -> Result<Value, String> {
            self.0.call(heap, function, args)
        }

        fn identity(&self) -> u64 {
            7
        }
    }

    #[test]
    fn mismatched_recordings_and_programs_are_errors() {
        let mut globals = Globals::new();
        let mut compiler = Compiler::new(&Mock, &mut globals);
        let mut program = |text: &str| compiler.expression(text).program.unwrap();
        let (height, time) = (program("data.qpos[2]"), program("data.time"));
        let [mut one, mut other] = [Recording::new(), Recording::new()];
        let of_height = one.columns(&height).unwrap().unwrap();
        let of_time = other.columns(&time).unwrap().unwrap();
        // Samples of a world with another identity are refused.
        assert_eq!(one.sample(&OtherWorld(World::new())), Err(Foreign::Identity));
        assert!(one.is_empty());
        one.sample(&World::new()).unwrap();
        other.sample(&World::new()).unwrap();
        // The first columns of the two recordings hold different elements.
        assert_eq!(of_height.evaluate(&one), Ok(vec![102.0]));
        assert_eq!(of_height.evaluate(&other), Err(Foreign::Recording));
        assert_eq!(of_time.evaluate(&one), Err(Foreign::Recording));
        // Programs that were compiled for different schemas cannot share a recording.
        let foreign = Program { identity: 7, ..height.clone() };
        let mut both = Recording::new();
        both.columns(&time).unwrap().unwrap();
        assert_eq!(both.columns(&foreign).unwrap_err(), Foreign::Identity);
        let mut foreign_recording = Recording::new();
        foreign_recording.columns(&foreign).unwrap().unwrap();
        foreign_recording.sample(&OtherWorld(World::new())).unwrap();
        assert_eq!(of_height.evaluate(&foreign_recording), Err(Foreign::Identity));
    }

    #[test]
    fn programs_that_need_the_machine_have_no_columns() {
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
            assert!(recording.columns(&program).unwrap().is_none(), "{source}");
            assert_eq!(recording.width(), 0, "{source}");
        }
    }
}
