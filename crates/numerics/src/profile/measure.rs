//! The cost of a step of a lab, stage by stage, and the cost with further stages. The lab's own run is repeated, with all
//! variants in alternation, so that disturbances of the machine affect all of them.
//!
//! The run is divided into chunks of steps, the same in every repetition, and the median time of each chunk is used, because an
//! interruption affects only some of the repetitions of a chunk. Stages are timed by reading a clock between them; the time of
//! reading the clock is measured as well and subtracted. The time of a stage is accurate to a few nanoseconds. The cost of a
//! stage that does not run is the difference between two runs, or zero if the clock shows no difference.

use super::parts::ConstraintCounts;
use super::reader::ExtraReader;
use super::start::plan_at_start;
use labspec::bind::Programs;
use labspec::interrupt;
use labspec::run::{RunError, Session, Start, count_steps};
use labspec::spec::Lab;
use labspec_core::reflect::FieldSet;
use labspec_core::{self as core, AccessSet, Model, Plan};
use std::sync::OnceLock;
use std::time::Instant;

/// The number of repetitions of each measurement.
pub const REPEATS: usize = 7;
/// A run is cut after this much work, in units of about a nanosecond, and repeated until it takes this many nanoseconds.
const MOST_WORK: u64 = 10_000_000;
const LONG_ENOUGH: f64 = 1e6;
/// The nanoseconds between two readings of the clock: an interruption invalidates only that much of a run.
const CLOCK_INTERVAL: f64 = 5e4;

/// The cost of a stage.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct StageCost {
    /// Nanoseconds per step.
    pub ns: f64,
    /// The share of a step.
    pub share: f64,
    /// Work per step as counted by the engine, the same on every machine. It includes what loops add; the
    /// rest is a constant per step.
    pub work: f64,
}

/// The cost of a step.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct StepCost {
    /// The number of steps of the measured run.
    pub steps: usize,
    /// The median time of a step including the lab's controller, ns.
    pub ns: f64,
    /// The first and the third quartile.
    pub quartiles: [f64; 2],
    /// The time if every stage runs.
    pub full: f64,
    /// The time outside all stages: the integrator, and the check for non-finite numbers.
    pub integrator: StageCost,
    /// The lab's controller, if it has one.
    pub controller: Option<StageCost>,
    /// The total work per step as counted by the engine.
    pub work: f64,
    /// The constraints that occurred.
    pub seen: ConstraintCounts,
}

/// All measurements, with the stages in the order of the plan.
pub(super) struct Measurements {
    pub(super) step: StepCost,
    pub(super) seen: ConstraintCounts,
    pub(super) stages: Vec<Option<StageCost>>,
    pub(super) forced: Vec<Option<f64>>,
    pub(super) readers: Vec<f64>,
}

/// Nanoseconds since the first call.
fn nanoseconds() -> u64 {
    static START: OnceLock<Instant> = OnceLock::new();
    START.get_or_init(Instant::now).elapsed().as_nanos() as u64
}

/// The time of reading the clock, ns.
fn clock_cost() -> f64 {
    let mut times: Vec<f64> = Vec::new();
    for _ in 0..9 {
        let start = nanoseconds();
        let last = (0..100).fold(start, |_, _| nanoseconds());
        times.push((last - start) as f64 / 100.0);
    }
    quartiles(&mut times)[1]
}

/// The first quartile, the median and the third quartile.
fn quartiles(times: &mut [f64]) -> [f64; 3] {
    times.sort_by(f64::total_cmp);
    let n = times.len();
    [n / 4, n / 2, (3 * n) / 4].map(|i| times.get(i).copied().unwrap_or(0.0))
}

/// The times of the chunks of a run: `chunks[i]` are the repeated measurements of the same steps.
#[derive(Clone, Debug, Default)]
struct Times {
    chunks: Vec<Vec<f64>>,
}

impl Times {
    fn add(&mut self, chunk: usize, time: f64) {
        if self.chunks.len() <= chunk {
            self.chunks.resize(chunk + 1, Vec::new());
        }
        if let Some(times) = self.chunks.get_mut(chunk) {
            times.push(time);
        }
    }

    /// The sums of the quartiles and of the median of each chunk; interruptions of some repetitions
    /// have no effect on the median.
    fn sums(&self) -> [f64; 3] {
        let all = self.chunks.iter().map(|times| quartiles(&mut times.clone()));
        all.fold([0.0; 3], |sum, current| [sum[0] + current[0], sum[1] + current[1], sum[2] + current[2]])
    }
}

/// A lab, and the run of it that is measured.
struct MeasuredLab<'a> {
    lab: &'a Lab,
    model: &'a Model,
    programs: &'a Programs,
    steps: usize,
    /// The number of runs per repetition, and the steps between two readings of the clock.
    runs: usize,
    chunk: usize,
}

impl<'a> MeasuredLab<'a> {
    fn start(&self, plan: &Plan) -> Session<'a> {
        let start = Start { plan: Some(plan.clone()), ..Start::of_lab(self.lab) };
        Session::start(self.programs, self.model, start)
    }

    /// The steps of the run, chunk by chunk.
    fn chunks(&self) -> impl Iterator<Item = (usize, usize)> + use<> {
        let (steps, chunk) = (self.steps, self.chunk);
        (0..steps).step_by(chunk).map(move |first| chunk.min(steps - first)).enumerate()
    }

    fn time(&self, plan: &Plan, times: &mut Times) {
        for _ in 0..self.runs {
            let mut session = self.start(plan);
            for (i, steps) in self.chunks() {
                let start = nanoseconds();
                (0..steps).for_each(|_| session.step());
                times.add(i, (nanoseconds() - start) as f64);
            }
        }
    }

    /// Measures each stage, then the time between stages without the controller, then the controller.
    fn stage_times(&self, plan: &Plan, times: &mut [Times]) {
        let (look, controlled) = (clock_cost(), self.programs.controller.is_some());
        for _ in 0..self.runs {
            let mut session = self.start(plan);
            core::clock(&mut session.world.data, nanoseconds);
            for (i, steps) in self.chunks() {
                let mut programs = 0.0;
                for _ in 0..steps {
                    if !controlled {
                        session.step();
                        continue;
                    }
                    let (before, mut step_start) = (nanoseconds(), 0);
                    session.step_by(|m, d| {
                        step_start = nanoseconds();
                        core::step(m, d)
                    });
                    programs += (step_start.saturating_sub(before) as f64 - look).max(0.0);
                }
                let stage_times = core::stage_times(&mut session.world.data);
                let looking = stage_times.nothing.time as f64 / stage_times.nothing.runs.max(1) as f64;
                let net = |stage_time: core::StageTime| {
                    (stage_time.time as f64 - stage_time.runs as f64 * looking).max(0.0)
                };
                let stages = plan.decisions().iter().map(|d| net(stage_times.stage_time(d.stage)));
                // The clock was read for the controller as well.
                let clock = if controlled { programs + 2.0 * look * steps as f64 } else { 0.0 };
                let between = (net(stage_times.between) - clock).max(0.0);
                for (times, time) in times.iter_mut().zip(stages.chain([between, programs])) {
                    times.add(i, time);
                }
            }
        }
    }
}

/// Measures a lab. Returns `None` if it cannot perform one step.
///
/// # Errors
/// The run is too long.
pub(super) fn measure(
    lab: &Lab,
    model: &Model,
    programs: &Programs,
    readers: &[ExtraReader],
) -> Result<Option<Measurements>, RunError> {
    let (plan, _) = plan_at_start(lab, model, programs);
    let mut case = MeasuredLab { lab, model, programs, steps: 0, runs: 1, chunk: 16 };
    let (mut step, works) = observe_run(&mut case, &plan)?;
    if case.steps == 0 {
        return Ok(None);
    }
    let mut first = Times::default();
    case.time(&plan, &mut first);
    let [_, whole, _] = first.sums();
    case.runs = (LONG_ENOUGH / whole.max(1.0)).ceil().clamp(1.0, 100.0) as usize;
    case.chunk = (CLOCK_INTERVAL * case.steps as f64 / whole.max(1.0)).clamp(1.0, 1000.0) as usize;

    let variants = variants(&case, &plan, readers);
    let (times, stage_times) = measure_alternately(&case, &plan, &variants);
    let per_step = |sum: f64| sum / case.steps as f64;
    let sums: Vec<[f64; 3]> = times.iter().map(|t| t.sums().map(per_step)).collect();
    let mean = |i: usize| sums.get(i).copied().unwrap_or_default();
    let [low, ns, high] = mean(0);
    // A variant that runs more stages is not faster; a negative difference is noise.
    let more = |i: usize| (mean(i)[1] - ns).max(0.0);
    // A stage takes slightly longer when timed separately, so only its share of the total is used.
    let stage_times: Vec<f64> = stage_times.iter().map(|t| per_step(t.sums()[1])).collect();
    let all: f64 = stage_times.iter().sum();
    let cost = |i: usize, work: f64| {
        let share = stage_times.get(i).copied().unwrap_or(0.0) / all.max(f64::MIN_POSITIVE);
        StageCost { ns: share * ns, share, work }
    };
    let stages: Vec<_> = plan.decisions().iter().map(|d| d.stage).collect();
    (step.ns, step.quartiles, step.full) = (ns, [low, high], mean(1)[1]);
    step.integrator = cost(stages.len(), 0.0);
    step.controller = programs.controller.as_ref().map(|_| cost(stages.len() + 1, 0.0));
    let costs = stages.iter().zip(&works).enumerate();
    let costs = costs.map(|(i, (stage, work))| plan.keeps(*stage).then(|| cost(i, *work))).collect();
    let mut next = 1;
    let mut forced = Vec::new();
    for stage in &stages {
        forced.push((!plan.keeps(*stage)).then(|| {
            next += 1;
            more(next)
        }));
    }
    let readers = (0..readers.len()).map(|i| more(next + 1 + i)).collect();
    Ok(Some(Measurements { seen: step.seen, step, stages: costs, forced, readers }))
}

/// The plans that are measured: the lab's own, one that reads everything, one with each omitted stage, one with each reader.
fn variants(case: &MeasuredLab<'_>, plan: &Plan, readers: &[ExtraReader]) -> Vec<Plan> {
    let access = case.programs.access;
    let full = Plan::new(case.model, &AccessSet { reads: FieldSet::ALL, ..access });
    let omitted = plan.decisions().iter().map(|d| d.stage).filter(|s| !plan.keeps(*s));
    let mut variants = vec![plan.clone(), full];
    variants.extend(omitted.map(|s| Plan::with(case.model, &access, s)));
    variants.extend(readers.iter().map(|r| Plan::new(case.model, &r.access)));
    variants
}

/// Measures all variants in alternation: returns the times of each variant, and those of each stage of the plan.
fn measure_alternately(case: &MeasuredLab<'_>, plan: &Plan, variants: &[Plan]) -> (Vec<Times>, Vec<Times>) {
    let mut times = vec![Times::default(); variants.len()];
    let mut stage_times = vec![Times::default(); plan.decisions().len() + 2];
    for _ in 0..REPEATS {
        for (variant, times) in variants.iter().zip(&mut times) {
            case.time(variant, times);
        }
        case.stage_times(plan, &mut stage_times);
        if interrupt::requested() {
            break;
        }
    }
    (times, stage_times)
}

/// Runs the lab once to determine the number of steps to measure, what happens in them, and the work of each stage.
fn observe_run(case: &mut MeasuredLab<'_>, plan: &Plan) -> Result<(StepCost, Vec<f64>), RunError> {
    let mut session = case.start(plan);
    let most = count_steps(case.lab, None, None, session.world.model.opt.timestep)?;
    core::clock(&mut session.world.data, || 0);
    let before = core::cost(&session.world.data);
    let mut seen = [[0.0f64; 2]; 4];
    while case.steps < most && core::cost(&session.world.data) - before < MOST_WORK && !interrupt::requested()
    {
        session.step();
        if session.ended().is_some() {
            break;
        }
        case.steps += 1;
        let world = &session.world;
        let d = world.data.fields();
        let reach = core::pairs_in_reach(&world.model, &world.data).unwrap_or(0);
        for ([sum, most], current) in seen.iter_mut().zip([reach, d.ncon, d.nefc, d.solver_niter]) {
            *sum += current as f64;
            *most = most.max(current as f64);
        }
    }
    let steps = case.steps.max(1) as f64;
    let [in_reach, contacts, rows, iterations] = seen.map(|[sum, most]| [sum / steps, most]);
    let stage_times = core::stage_times(&mut session.world.data);
    let works = plan.decisions().iter().map(|d| stage_times.stage_time(d.stage).work as f64 / steps);
    let step = StepCost {
        steps: case.steps,
        work: (core::cost(&session.world.data) - before) as f64 / steps,
        seen: ConstraintCounts { in_reach, contacts, rows, iterations },
        ..StepCost::default()
    };
    Ok((step, works.collect()))
}
