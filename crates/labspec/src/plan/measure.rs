//! What a step of a lab costs, stage by stage, and what one with more stages would: the lab's own run, again and again, all
//! variants in turn, so that what else the machine does meets them all.
//!
//! Stages are measured by a clock between them. What looking at the clock takes is measured as well, and taken off; a stage of
//! a few nanoseconds is known to a few nanoseconds. What a stage would cost that does not run is the difference of two runs.

use super::parts::Seen;
use super::reader::Reader;
use crate::bind::Programs;
use crate::interrupt;
use crate::run::{RunError, Session, count_steps};
use crate::spec::Lab;
use labspec_core::reflect::FieldSet;
use labspec_core::{self as core, Data, Demand, Model, Plan};
use std::sync::OnceLock;
use std::time::Instant;

/// How often everything is measured.
pub const REPEATS: usize = 7;
/// A run is cut off after so much work, which is about nanoseconds, and repeated until it took so many nanoseconds.
const MOST_WORK: u64 = 10_000_000;
const LONG_ENOUGH: f64 = 1e6;

/// What a stage costs.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Cost {
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
pub struct Step {
    /// Steps of the run that was measured.
    pub steps: usize,
    /// A step with the lab's controller, in the middle of the repeats, ns; a quarter of them is quicker, a quarter slower.
    pub ns: f64,
    /// The quarters.
    pub quarters: [f64; 2],
    /// The same where every stage runs.
    pub full: f64,
    /// What all stages leave: the integrator, and the look for numbers that are none.
    pub integrator: Cost,
    /// The lab's controller, where it has one.
    pub controller: Option<Cost>,
    /// All work of a step, as the engine counts it.
    pub work: f64,
    /// What was seen.
    pub seen: Seen,
}

/// All that was measured, stages in the order of the plan.
pub(super) struct Measured {
    pub(super) step: Step,
    pub(super) seen: Seen,
    pub(super) stages: Vec<Option<Cost>>,
    pub(super) forced: Vec<Option<f64>>,
    pub(super) readers: Vec<f64>,
}

/// Nanoseconds since somebody asked first.
fn nanoseconds() -> u64 {
    static START: OnceLock<Instant> = OnceLock::new();
    START.get_or_init(Instant::now).elapsed().as_nanos() as u64
}

/// What a look at the clock takes, ns.
fn look() -> f64 {
    let mut times: Vec<f64> = Vec::new();
    for _ in 0..9 {
        let start = nanoseconds();
        let last = (0..100).map(|_| nanoseconds()).last().unwrap_or(start);
        times.push((last - start) as f64 / 100.0);
    }
    quarters(&mut times)[1]
}

/// A quarter of the way, the middle, and three quarters; NaN of nothing.
fn quarters(times: &mut [f64]) -> [f64; 3] {
    times.sort_by(f64::total_cmp);
    let n = times.len();
    [n / 4, n / 2, (3 * n) / 4].map(|i| times.get(i).copied().unwrap_or(f64::NAN))
}

fn middle(times: impl Iterator<Item = f64>) -> f64 {
    quarters(&mut times.collect::<Vec<f64>>())[1]
}

/// A lab, and the run of it that is measured.
struct Case<'a> {
    lab: &'a Lab,
    model: &'a Model,
    programs: &'a Programs,
    steps: usize,
    /// How often the run is made in a repeat.
    runs: usize,
}

impl<'a> Case<'a> {
    fn start(&self, plan: Plan) -> Session<'a> {
        let data = Data::planned(self.model, plan);
        Session::start_with(self.programs, self.model, self.lab.keyframe(), data)
    }

    /// A step, ns.
    fn time(&self, plan: &Plan) -> f64 {
        let mut time = 0;
        for _ in 0..self.runs {
            let mut session = self.start(plan.clone());
            let start = nanoseconds();
            (0..self.steps).for_each(|_| session.step());
            time += nanoseconds() - start;
        }
        time as f64 / (self.runs * self.steps).max(1) as f64
    }

    /// Each stage of a step, ns, and the controller.
    fn laps(&self, plan: &Plan) -> (Vec<f64>, f64) {
        let look = look();
        let mut stages = vec![0.0; plan.decisions().len()];
        let (mut programs, mut clocked) = (0.0, 0.0);
        for _ in 0..self.runs {
            let mut session = self.start(plan.clone());
            let mut engine = 0;
            let start = nanoseconds();
            for _ in 0..self.steps {
                session.step_by(|m, d| {
                    let start = nanoseconds();
                    let done = core::step(m, d);
                    engine += nanoseconds() - start;
                    done
                });
            }
            programs += (nanoseconds() - start - engine) as f64 - self.steps as f64 * look;
            clocked += 1.0;
            let mut session = self.start(plan.clone());
            core::clock(&mut session.world.data, nanoseconds);
            (0..self.steps).for_each(|_| session.step());
            let nothing = core::lap(&session.world.data, None);
            let looking = nothing.time as f64 / nothing.runs.max(1) as f64;
            for (sum, decision) in stages.iter_mut().zip(plan.decisions()) {
                let lap = core::lap(&session.world.data, Some(decision.stage));
                *sum += (lap.time as f64 - lap.runs as f64 * looking).max(0.0);
            }
        }
        let per_step = (clocked * self.steps as f64).max(1.0);
        stages.iter_mut().for_each(|sum| *sum /= per_step);
        (stages, (programs / per_step).max(0.0))
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
    readers: &[Reader],
) -> Result<Option<Measured>, RunError> {
    let plan = Plan::new(model, &programs.demand);
    let mut case = Case { lab, model, programs, steps: 0, runs: 1 };
    let (mut step, works) = look_at(&mut case, &plan)?;
    let first = case.time(&plan);
    case.runs = (LONG_ENOUGH / (first * case.steps.max(1) as f64)).ceil().clamp(1.0, 100.0) as usize;

    let full = Plan::new(model, &Demand { reads: FieldSet::ALL, ..programs.demand });
    let stages: Vec<_> = plan.decisions().iter().map(|d| d.stage).collect();
    let left_out = stages.iter().filter(|s| !plan.keeps(**s));
    let mut variants = vec![plan.clone(), full];
    variants.extend(left_out.map(|s| Plan::with(model, &programs.demand, *s)));
    variants.extend(readers.iter().map(|r| Plan::new(model, &r.demand)));
    let mut times: Vec<Vec<f64>> = vec![Vec::new(); variants.len()];
    let mut laps: Vec<(Vec<f64>, f64)> = Vec::new();
    for _ in 0..REPEATS {
        if interrupt::requested() || case.steps == 0 {
            break;
        }
        for (variant, times) in variants.iter().zip(&mut times) {
            times.push(case.time(variant));
        }
        laps.push(case.laps(&plan));
    }

    if laps.is_empty() {
        return Ok(None);
    }
    let planned = times.first().cloned().unwrap_or_default();
    let more = |i: usize| {
        let of = times.get(i).map_or(&[][..], Vec::as_slice);
        middle(of.iter().zip(&planned).map(|(a, b)| a - b))
    };
    let [low, ns, high] = quarters(&mut planned.clone());
    let of_stage = |i: usize| middle(laps.iter().filter_map(|(stages, _)| stages.get(i).copied()));
    let nanoseconds: Vec<f64> = (0..stages.len()).map(of_stage).collect();
    let controller = programs.controller.as_ref().map(|_| middle(laps.iter().map(|(_, c)| *c)));
    let known: f64 = nanoseconds.iter().sum::<f64>() + controller.unwrap_or(0.0);
    // Stages that are measured one by one may be slower than in a row.
    let whole = ns.max(known);
    let cost = |ns: f64, work: f64| Cost { ns, share: ns / whole, work };
    step.ns = ns;
    step.quarters = [low, high];
    step.full = middle(times.get(1).into_iter().flatten().copied());
    step.integrator = cost(whole - known, 0.0);
    step.controller = controller.map(|ns| cost(ns, 0.0));
    let costs = stages.iter().zip(&nanoseconds).zip(&works);
    let costs = costs.map(|((stage, ns), work)| plan.keeps(*stage).then(|| cost(*ns, *work))).collect();
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

/// Runs the lab once, to see how many steps are measured and what happens in them. The work of each stage comes with it.
fn look_at(case: &mut Case<'_>, plan: &Plan) -> Result<(Step, Vec<f64>), RunError> {
    let mut session = case.start(plan.clone());
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
    let works =
        plan.decisions().iter().map(|d| core::lap(&session.world.data, Some(d.stage)).work as f64 / steps);
    let step = Step {
        steps: case.steps,
        work: (core::cost(&session.world.data) - before) as f64 / steps,
        seen: Seen { in_reach, contacts, rows, iterations },
        ..Step::default()
    };
    Ok((step, works.collect()))
}
