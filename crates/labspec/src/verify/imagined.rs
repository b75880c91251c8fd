//! Imagined runs: every quantity that a measure reads has a random value, drawn for each sample. Measures of the same run
//! read the same samples, so relations between them are preserved: the maximum of a trace is never below its minimum,
//! whatever is simulated. A claim that is true for every imagined run is true for any run.

use super::aggregate::AggregateKind;
use super::anything::{Anything, DrawMode, DrawSource, between};
use super::bound::BoundVerify;
use super::bound_run::CompiledText;
use super::compiled_claim::{ClaimInputs, CompiledClaim, reads_ctx};
use super::condition::numbers_in;
use super::draws::Draws;
use super::evidence::{ClaimValue, reach};
use super::layout::Slot;
use super::measure::Measure;
use super::sample::Sample;
use super::value_kind::ValueKind;
use crate::bind::Programs;
use crate::source::{SourceMap, Text};
use labspec_expr::{Context, Program, Value};

/// An imagined run.
struct ImaginedRun<'w> {
    host: Anything<'w>,
    context: Context,
}

/// Work budget of a program at an imagined sample.
const PROGRAM_WORK: u64 = 20_000;

impl Sample for ImaginedRun<'_> {
    fn time(&self) -> f64 {
        self.host.time.unwrap_or(0.0)
    }

    fn context(&mut self) -> &mut Context {
        &mut self.context
    }

    fn evaluate(&mut self, program: &Program, _: &Text) -> Option<Value> {
        self.context.allow(PROGRAM_WORK);
        program.run(&mut self.host, &mut self.context, None).ok()
    }
}

impl ImaginedRun<'_> {
    /// Executes the programs that compute variables of `ctx` at every step: the controller, the traces and the readouts.
    fn execute(&mut self, programs: &Programs) {
        let probes = programs.probes.iter().filter_map(|probe| probe.bound.as_ref());
        for bound in programs.controller.iter().chain(probes) {
            if writes_ctx(&bound.program) {
                self.context.allow(PROGRAM_WORK);
                // A program that throws leaves what it has stored until then, as in a run.
                let _ = bound.program.run(&mut self.host, &mut self.context, None);
            }
        }
    }
}

fn writes_ctx(program: &Program) -> bool {
    let effects = program.effects();
    effects.any_ctx || effects.calls_values || !effects.ctx_writes.is_empty() || !effects.ctx_reads.is_empty()
}

/// Number of samples, and of pairs of runs, that decide whether variables of `ctx` are results of the simulation.
const CTX_SAMPLES: u64 = 6;
const CTX_PAIRS: u64 = 4;

/// Number of sets of imagined runs, and how many of them must decide a claim.
const MAX_RUN_SETS: u64 = 200;
const DECIDED: usize = 24;
/// Number of samples of an imagined run, and the maximum for runs in which something is counted.
const SAMPLES: [usize; 3] = [3, 8, 20];
const MOST_SAMPLES: f64 = 4096.0;
/// Maximum number of evaluations of measures at samples for one claim. The sets evaluated by then decide.
const MAX_EVALUATIONS: usize = 40_000;

impl BoundVerify<'_> {
    /// Whether a measure, or the aggregates of a claim, depend on variables of `ctx` that the lab computes from the simulation:
    /// they differ between two imagined runs with the same times.
    pub(super) fn depends_on_simulated_ctx(&self, scene: usize, program: &Program, text: &Text) -> bool {
        let Some(bound) = self.scenes.get(scene).filter(|_| reads_ctx(program)) else { return false };
        let programs = &bound.scene.programs;
        let results = |seed: u64| {
            self.idle_in(scene, |session| {
                let world = &session.world;
                let source = DrawSource { seeds: [seed, 0], manner: DrawMode::Any };
                let host = Anything { world, source, toward: None, time: Some(0.0) };
                let mut imagined = ImaginedRun { host, context: session.context.copy() };
                let mut measure = Measure::new(program, text);
                for sample in 0..CTX_SAMPLES {
                    imagined.host.source = source.at_sample(sample);
                    imagined.host.time = Some(sample as f64);
                    imagined.execute(programs);
                    measure.sample(&mut imagined);
                }
                let parts = measure.parts();
                parts.into_iter().map(f64::to_bits).collect::<Vec<_>>()
            })
        };
        (0..CTX_PAIRS).any(|pair| results(2 * pair + 1) != results(2 * pair + 2))
    }

    /// Whether some set of imagined runs gives a claim an outcome other than `current`. Also `true` where too few sets decide
    /// it.
    pub(super) fn differs_somewhere(
        &self,
        claim: &CompiledClaim,
        nominal: &ClaimInputs,
        current: ClaimValue,
        says: &mut dyn FnMut(&ClaimInputs) -> Option<ClaimValue>,
    ) -> bool {
        if claim.measured(self).is_empty() {
            return true;
        }
        let measures = self.measures_of(claim);
        let programs = measures.iter().map(|(.., m)| &m.program).chain(&claim.program);
        let counts = programs.clone().flat_map(Program::aggregates).any(|a| {
            matches!(AggregateKind::of_aggregate(a), Some(AggregateKind::Count | AggregateKind::Crossings))
        });
        let texts = measures.iter().flat_map(|(.., m)| numbers_in(m.text.as_str()));
        let measured: Vec<f64> = claim.measured(self).iter().filter_map(|place| nominal.at(*place)).collect();
        let reach = reach(&measured);
        let numbers = texts.chain(claim.constants.iter().copied());
        let numbers: Vec<f64> = numbers.filter(|x| *x != 0.0 && x.abs() <= reach).collect();
        // A count must be able to reach the numbers that it is compared with.
        let largest = numbers.iter().fold(1.0, |most: f64, x| most.max(x.abs()));
        if counts && 8.0 * largest > MOST_SAMPLES {
            return true;
        }
        let (mut decided, mut looks) = (Vec::new(), 0);
        for set in 0..MAX_RUN_SETS {
            let long = counts && set % 5 == 4;
            let samples = if long { 8 * largest as usize } else { SAMPLES[set as usize % SAMPLES.len()] };
            looks += samples * (1 + measures.len());
            if looks > MAX_EVALUATIONS {
                break;
            }
            let drawn = DrawnSet { set, toward: None, samples };
            let Some(inputs) = self.draw_inputs(claim, nominal, &numbers, drawn) else { return true };
            let Some(then) = says(&inputs) else { continue };
            if then.differs(current) {
                return true;
            }
            decided.push((drawn, inputs));
        }
        decided.len() < DECIDED
            || self.differs_between(claim, &decided, current, &mut |drawn| {
                let inputs = self.draw_inputs(claim, nominal, &numbers, drawn)?;
                Some((says(&inputs)?, inputs))
            })
    }

    /// The measures that a claim reads, with their positions among the numbers and their runs.
    fn measures_of(&self, claim: &CompiledClaim) -> Vec<(usize, usize, &CompiledText<'_>)> {
        let one = |place: &usize| match *self.layout().slots.get(*place)? {
            Slot::Measure(run, m) if self.is_simulated(run, m) => {
                Some((*place, run, self.measure_at(run, m)?))
            }
            _ => None,
        };
        claim.reads.iter().filter_map(one).collect()
    }

    /// The inputs of a claim from one set of imagined runs; `None` where they cannot be evaluated.
    fn draw_inputs(
        &self,
        claim: &CompiledClaim,
        nominal: &ClaimInputs,
        numbers: &[f64],
        drawn: DrawnSet,
    ) -> Option<ClaimInputs> {
        let mut inputs = nominal.clone();
        let mut draws = SetDraws::new(drawn);
        for place in &claim.reads {
            match self.layout().slots.get(*place) {
                Some(Slot::Warnings(_)) => inputs.set_value(*place, draws.next(&|d| 4.0 * d.unit()).floor()),
                Some(Slot::Found(_)) => {
                    inputs.set_value(*place, ValueKind::ANY.nearest(draws.next(&Draws::any)));
                }
                _ => {}
            }
        }
        let measures = self.measures_of(claim);
        let on_the_spot = claim.program.as_ref().filter(|p| !p.aggregates().is_empty());
        let mut runs: Vec<usize> =
            measures.iter().map(|(_, run, _)| *run).chain(on_the_spot.map(|_| 0)).collect();
        runs.sort_unstable();
        runs.dedup();
        let nowhere = Text { map: SourceMap::whole(0, 0..0), value: String::new() };
        for run in runs {
            let (source, toward) = draws.sources(run, numbers);
            let here = || measures.iter().filter(|(_, owner, _)| *owner == run);
            let scene = self.runs.get(run)?.scene;
            let texts = here().map(|(.., m)| &m.program).chain(on_the_spot.filter(|_| run == 0));
            let programs = texts.into_iter().any(reads_ctx).then(|| self.scenes.get(scene)).flatten();
            self.idle_in(scene, |session| {
                let host = Anything { world: &session.world, source, toward, time: Some(0.0) };
                let mut imagined = ImaginedRun { host, context: session.context.copy() };
                let mut running: Vec<Measure<'_>> =
                    here().map(|(.., m)| Measure::new(&m.program, &m.text)).collect();
                let mut parts = on_the_spot.filter(|_| run == 0).map(|p| Measure::new(p, &nowhere));
                let mut time = 0.0;
                for sample in 0..drawn.samples as u64 {
                    imagined.host.source = source.at_sample(sample);
                    imagined.host.toward = toward.map(|(other, f)| (other.at_sample(sample), f));
                    imagined.host.time = Some(time);
                    if let Some(bound) = programs {
                        imagined.execute(&bound.scene.programs);
                    }
                    running.iter_mut().chain(&mut parts).for_each(|m| m.sample(&mut imagined));
                    time += draws.next(&|d| d.any().abs());
                }
                for (measure, (place, ..)) in running.into_iter().zip(here()) {
                    inputs.set_value(*place, measure.finish(&mut imagined).value);
                }
                if let Some(parts) = parts {
                    inputs.parts = parts.parts();
                }
            })?;
        }
        Some(inputs)
    }
}

/// A set of imagined runs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct DrawnSet {
    /// The number of the set, which is the seed of its draws.
    pub(super) set: u64,
    /// Another set and a fraction: every drawn value lies that far between the values of the two sets.
    pub(super) toward: Option<(u64, f64)>,
    /// Number of samples of each run.
    pub(super) samples: usize,
}

/// The draws of a set of imagined runs.
struct SetDraws {
    drawn: DrawnSet,
    draws: Draws,
    other: Option<Draws>,
}

impl SetDraws {
    fn new(drawn: DrawnSet) -> SetDraws {
        let of = |set: u64| {
            let mut draws = Draws::new(5 + set);
            draws.unit();
            draws
        };
        SetDraws { drawn, draws: of(drawn.set), other: drawn.toward.map(|(set, _)| of(set)) }
    }

    /// The next drawn number.
    fn next(&mut self, draw: &dyn Fn(&mut Draws) -> f64) -> f64 {
        let x = draw(&mut self.draws);
        match (&mut self.other, self.drawn.toward) {
            (Some(other), Some((_, fraction))) => between(x, draw(other), fraction),
            _ => x,
        }
    }

    /// The sources of the values of a run.
    fn sources(&mut self, run: usize, numbers: &[f64]) -> (DrawSource, Option<(DrawSource, f64)>) {
        let source = |set: u64, draws: &mut Draws| {
            let seed = set.wrapping_mul(0x1_0001) ^ (run as u64) << 20;
            DrawSource { seeds: [seed, 0], manner: manner(draws, numbers) }
        };
        let first = source(self.drawn.set, &mut self.draws);
        let other = self.other.as_mut().zip(self.drawn.toward);
        (first, other.map(|(draws, (set, fraction))| (source(set, draws), fraction)))
    }
}

fn manner(draws: &mut Draws, numbers: &[f64]) -> DrawMode {
    let choice = draws.unit();
    if choice < 0.4 {
        return DrawMode::Any;
    }
    if choice < 0.5 {
        return DrawMode::Zero;
    }
    if choice < 0.6 {
        return DrawMode::ConstantPerRun;
    }
    let which = (draws.unit() * (numbers.len() + 1) as f64) as usize;
    DrawMode::Near(numbers.get(which).copied().unwrap_or_else(|| draws.any()))
}
