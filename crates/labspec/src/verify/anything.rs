//! An imagined simulation: every value that a program reads of the data is drawn at random.

use super::draws::Draws;
use crate::bind::{World, functions};
use labspec_core::reflect::{Elem, FieldId, Object, data};
use labspec_expr::{FieldKey, FunctionId, Heap, Host, Value};

/// How the values of an imagined run are drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum DrawMode {
    /// Each value has any magnitude.
    Any,
    /// Each value has about the magnitude of this number, which comes from the text or was drawn.
    Near(f64),
    /// Nothing moves: all values are zero.
    Zero,
    /// Each value is constant during the run.
    ConstantPerRun,
}

/// The source of the values of a sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct DrawSource {
    /// Seeds of the run and of the sample.
    pub(super) seeds: [u64; 2],
    pub(super) manner: DrawMode,
}

impl DrawSource {
    /// The source of one sample of a run.
    pub(super) fn at_sample(self, sample: u64) -> DrawSource {
        let [run, _] = self.seeds;
        DrawSource { seeds: [run, run ^ (sample + 1) << 40], ..self }
    }

    /// The value with the key `what`.
    fn draw(self, what: u64) -> f64 {
        let [run, sample] = self.seeds;
        let mut draws = Draws::new(what ^ if self.manner == DrawMode::ConstantPerRun { run } else { sample });
        draws.unit();
        match self.manner {
            DrawMode::Any | DrawMode::ConstantPerRun => draws.any(),
            DrawMode::Near(x) => x * (4.0 * draws.unit() - 2.0),
            DrawMode::Zero => 0.0,
        }
    }
}

/// The number between two others: `a` for the fraction 0, `b` for 1.
pub(super) fn between(a: f64, b: f64, fraction: f64) -> f64 {
    if fraction == 0.0 { a } else { (1.0 - fraction) * a + fraction * b }
}

/// An imagined simulation: every value that is read of the data is drawn at random.
pub(super) struct Anything<'w> {
    pub(super) world: &'w World,
    pub(super) source: DrawSource,
    /// Another source and a fraction: each value lies that far between the values of the two sources.
    pub(super) toward: Option<(DrawSource, f64)>,
    /// Time of the sample, s, for samples in sequence.
    pub(super) time: Option<f64>,
}

impl<'w> Anything<'w> {
    /// A single sample.
    pub(super) fn sample_of(world: &'w World, seed: u64) -> Anything<'w> {
        let source = DrawSource { seeds: [seed; 2], manner: DrawMode::Any };
        Anything { world, source, toward: None, time: None }
    }

    /// Draws the value with the key `what`.
    fn draw(&self, what: u64) -> f64 {
        let x = self.source.draw(what);
        self.toward.map_or(x, |(other, fraction)| between(x, other.draw(what), fraction))
    }
}

impl Host for Anything<'_> {
    fn get(&self, field: FieldKey, index: usize) -> Option<f64> {
        let actual = self.world.get(field, index);
        let Some(id) = FieldId::new(field.0 as usize) else { return actual };
        let info = id.info();
        if info.object != Object::Data || actual.is_none() && index > 4096 {
            return actual;
        }
        if let Some(time) = self.time.filter(|_| id == data::time) {
            return Some(time);
        }
        let x = self.draw((u64::from(field.0) << 32) ^ index as u64);
        let kinetic = id == data::energy && index == 1;
        Some(if info.elem != Elem::F64 {
            x.abs().round()
        } else if id == data::time || kinetic {
            x.abs()
        } else {
            x
        })
    }

    fn set(&mut self, _: FieldKey, _: usize, _: f64) -> Result<(), String> {
        Ok(())
    }

    fn len(&self, field: FieldKey) -> usize {
        self.world.len(field)
    }

    fn call(&mut self, _: &mut Heap, function: FunctionId, args: &[Value]) -> Result<Value, String> {
        if functions::name(function) == Some("abs") {
            return Ok(Value::Number(args.first().map_or(f64::NAN, Value::to_number).abs()));
        }
        let seed =
            args.iter().fold(u64::from(function.0), |h, a| h.wrapping_mul(31) ^ a.to_number().to_bits());
        // A function that reads nothing has the same result for the same arguments in every run.
        let x = if functions::reads(function) { self.draw(seed) } else { Draws::new(seed).any() };
        Ok(match functions::name(function) {
            Some("contact") => Value::Boolean(x > 0.0),
            _ => Value::Number(x),
        })
    }

    fn identity(&self) -> u64 {
        self.world.identity()
    }
}
