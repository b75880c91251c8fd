//! What a step of a lab costs, stage by stage, and what one with more stages would: the lab's own run, again and again, all
//! variants in turn, so that what else the machine does meets them all.
//!
//! The run is cut into chunks of steps, the same in every run, and of each chunk the middle of its times counts: what interrupts the
//! program now and then meets a chunk now and then. Stages are measured by a clock between them; what looking at it takes is
//! measured as well, and taken off. A stage of a few nanoseconds is known to a few nanoseconds. What a stage would cost that does
//! not run is the difference of two runs, and nothing where the clock shows no difference.

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

/// How often everything is measured.
pub const REPEATS: usize = 7;
/// A run is cut off after so much work, which is about nanoseconds, and repeated until it took so many nanoseconds.
const MOST_WORK: u64 = 10_000_000;
const LONG_ENOUGH: f64 = 1e6;
/// Nanoseconds between two looks at the clock: what interrupts a run spoils that much of it, and the same steps were measured before.
const LOOK_EVERY: f64 = 5e4;

/// What a stage costs.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct StageCost {
    /// Nanoseconds of a step.
    pub ns: f64,
    /// The part of a step.
    pub share: f64,
    /// Work of a step, as the engine counts it: the same on every machine. It counts what loops add; the rest is a number for the
    /// whole step.
    pub work: f64,
}

/// What a step costs.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct StepCost {
    /// Steps of the run that was measured.
    pub steps: usize,
    /// A step with the lab's controller, in the middle of the repeats, ns; a quarter of them is quicker, a quarter slower.
    pub ns: f64,
    /// The quarters.
    pub quarters: [f64; 2],
    /// The same where every stage runs.
    pub full: f64,
    /// What all stages leave: the integrator, and the look for numbers that are none.
    pub integrator: StageCost,
    /// The lab's controller, where it has one.
    pub controller: Option<StageCost>,
    /// All work of a step, as the engine counts it.
    pub work: f64,
    /// What was seen.
    pub seen: ConstraintCounts,
}

/// All that was measured, stages in the order of the plan.
pub(super) struct Measured {
    pub(super) step: StepCost,
    pub(super) seen: ConstraintCounts,
    pub(super) stages: Vec<Option<StageCost>>,
    pub(super) forced: Vec<Option<f64>>,
    pub(super) readers: Vec<f64>,
}

/// Nanoseconds since somebody asked first.
fn nanoseconds() -> u64 {
    static START: OnceLock<Instant> = OnceLock::new();
    START.get_or_init(Instant::now).elapsed().as_nanos() as u64
}

/// What a look at the clock takes, ns.
fn clock_cost() -> f64 {
    let mut times: Vec<f64> = Vec::new();
    for _ in 0..9 {
        let start = nanoseconds();
        let last = (0..100).fold(start, |_, _| nanoseconds());
        times.push((last - start) as f64 / 100.0);
    }
    quarters(&mut times)[1]
}

/// A quarter of the way, the middle, and three quarters.
fn quarters(times: &mut [f64]) -> [f64; 3] {
    times.sort_by(f64::total_cmp);
    let n = times.len();
    [n / 4, n / 2, (3 * n) / 4].map(|i| times.get(i).copied().unwrap_or(0.0))
}

/// What the chunks of a run took, each as often as it was measured: `chunks[i]` are the times of the same steps.
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

    /// The sums of the quarters and of the middle of each chunk: what interrupts some of its runs is not in them.
    fn sums(&self) -> [f64; 3] {
        let all = self.chunks.iter().map(|times| quarters(&mut times.clone()));
        all.fold([0.0; 3], |sum, now| [sum[0] + now[0], sum[1] + now[1], sum[2] + now[2]])
    }
}

/// A lab, and the run of it that is measured.
struct MeasuredLab<'a> {
    lab: &'a Lab,
    model: &'a Model,
    programs: &'a Programs,
    steps: usize,
    /// How often the run is made in a repeat, and steps between two looks at the clock.
    runs: usize,
    chunk: usize,
}

impl<'a> MeasuredLab<'a> {
    fn start(&self, plan: &Plan) -> Session<'a> {
        let start = Start { plan: Some(plan.clone()), ..Start::of_lab(self.lab) };
        Session::start(self.programs, self.model, start)
    }

    /// Steps of the run, chunk by chunk.
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

    /// Each stage; then what is between them, without the controller; then the controller.
    fn laps(&self, plan: &Plan, times: &mut [Times]) {
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
                let laps = core::laps(&mut session.world.data);
                let looking = laps.nothing.time as f64 / laps.nothing.runs.max(1) as f64;
                let net = |lap: core::StageTime| (lap.time as f64 - lap.runs as f64 * looking).max(0.0);
                let stages = plan.decisions().iter().map(|d| net(laps.stage_time(d.stage)));
                // The clock was looked at for the controller, too.
                let clock = if controlled { programs + 2.0 * look * steps as f64 } else { 0.0 };
                let between = (net(laps.between) - clock).max(0.0);
                for (times, time) in times.iter_mut().zip(stages.chain([between, programs])) {
                    times.add(i, time);
                }
            }
        }
    }
}

/// Measures a lab; `None` where it does not come through one step.
///
/// # Errors
/// A run that is too long.
pub(super) fn measure(
    lab: &Lab,
    model: &Model,
    programs: &Programs,
    readers: &[ExtraReader],
) -> Result<Option<Measured>, RunError> {
    let (plan, _) = plan_at_start(lab, model, programs);
    let mut case = MeasuredLab { lab, model, programs, steps: 0, runs: 1, chunk: 16 };
    let (mut step, works) = look_at(&mut case, &plan)?;
    if case.steps == 0 {
        return Ok(None);
    }
    let mut first = Times::default();
    case.time(&plan, &mut first);
    let [_, whole, _] = first.sums();
    case.runs = (LONG_ENOUGH / whole.max(1.0)).ceil().clamp(1.0, 100.0) as usize;
    case.chunk = (LOOK_EVERY * case.steps as f64 / whole.max(1.0)).clamp(1.0, 1000.0) as usize;

    let variants = variants(&case, &plan, readers);
    let (times, laps) = measure_in_turn(&case, &plan, &variants);
    let per_step = |sum: f64| sum / case.steps as f64;
    let sums: Vec<[f64; 3]> = times.iter().map(|t| t.sums().map(per_step)).collect();
    let of = |i: usize| sums.get(i).copied().unwrap_or_default();
    let [low, ns, high] = of(0);
    // A variant that runs more is not faster: a difference below zero is noise of the clock.
    let more = |i: usize| (of(i)[1] - ns).max(0.0);
    // A stage that is measured alone is a little slower than in a row: its share of all laps is what counts.
    let laps: Vec<f64> = laps.iter().map(|t| per_step(t.sums()[1])).collect();
    let all: f64 = laps.iter().sum();
    let cost = |i: usize, work: f64| {
        let share = laps.get(i).copied().unwrap_or(0.0) / all.max(f64::MIN_POSITIVE);
        StageCost { ns: share * ns, share, work }
    };
    let stages: Vec<_> = plan.decisions().iter().map(|d| d.stage).collect();
    (step.ns, step.quarters, step.full) = (ns, [low, high], of(1)[1]);
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
    Ok(Some(Measured { seen: step.seen, step, stages: costs, forced, readers }))
}

/// The plans that are measured: the lab's own, one that reads everything, one with each stage that is left out, one with each reader.
fn variants(case: &MeasuredLab<'_>, plan: &Plan, readers: &[ExtraReader]) -> Vec<Plan> {
    let access = case.programs.access;
    let full = Plan::new(case.model, &AccessSet { reads: FieldSet::ALL, ..access });
    let left_out = plan.decisions().iter().map(|d| d.stage).filter(|s| !plan.keeps(*s));
    let mut variants = vec![plan.clone(), full];
    variants.extend(left_out.map(|s| Plan::with(case.model, &access, s)));
    variants.extend(readers.iter().map(|r| Plan::new(case.model, &r.access)));
    variants
}

/// Measures all variants in turn, again and again: the times of each variant, and those of each stage of the plan.
fn measure_in_turn(case: &MeasuredLab<'_>, plan: &Plan, variants: &[Plan]) -> (Vec<Times>, Vec<Times>) {
    let mut times = vec![Times::default(); variants.len()];
    let mut laps = vec![Times::default(); plan.decisions().len() + 2];
    for _ in 0..REPEATS {
        for (variant, times) in variants.iter().zip(&mut times) {
            case.time(variant, times);
        }
        case.laps(plan, &mut laps);
        if interrupt::requested() {
            break;
        }
    }
    (times, laps)
}

/// Runs the lab once, to see how many steps are measured and what happens in them. The work of each stage comes with it.
fn look_at(case: &mut MeasuredLab<'_>, plan: &Plan) -> Result<(StepCost, Vec<f64>), RunError> {
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
        for ([sum, most], now) in seen.iter_mut().zip([reach, d.ncon, d.nefc, d.solver_niter]) {
            *sum += now as f64;
            *most = most.max(now as f64);
        }
    }
    let steps = case.steps.max(1) as f64;
    let [in_reach, contacts, rows, iterations] = seen.map(|[sum, most]| [sum / steps, most]);
    let laps = core::laps(&mut session.world.data);
    let works = plan.decisions().iter().map(|d| laps.stage_time(d.stage).work as f64 / steps);
    let step = StepCost {
        steps: case.steps,
        work: (core::cost(&session.world.data) - before) as f64 / steps,
        seen: ConstraintCounts { in_reach, contacts, rows, iterations },
        ..StepCost::default()
    };
    Ok((step, works.collect()))
}
