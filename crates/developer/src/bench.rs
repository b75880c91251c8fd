//! The run time of a step. Instruction counters run this as well.

use clap::builder::{PossibleValuesParser, TypedValueParser};
use labspec::bind::Programs;
use labspec::interrupt;
use labspec::report::{NonfiniteName, nonfinite};
use labspec::run::{MAX_STEPS, Session, Start};
use labspec::spec::Lab;
use labspec_core::reflect::FieldSet;
use labspec_core::{AccessSet, Model, Plan, TreeAlgorithm, TreeAlgorithms};
use schemars::JsonSchema;
use serde::Serialize;
use std::time::Instant;

/// The options of the measurement.
#[derive(clap::Args, Clone, Debug)]
pub struct BenchOptions {
    /// Steps of each repetition
    #[arg(long, value_name = "N", default_value_t = 20_000)]
    pub steps: usize,
    /// Steps before the first repetition
    #[arg(long, value_name = "N", default_value_t = 1_000)]
    pub warm: usize,
    /// Repetitions
    #[arg(long, value_name = "N", default_value_t = 7)]
    pub repeat: usize,
    /// Compute every field in every step, read or not. Without it a model alone is planned for its state,
    /// a lab for what it reads
    #[arg(long)]
    pub full: bool,
    /// Compute trees without this specialized algorithm; may be given several times
    #[arg(long, value_name = "ALGORITHM", value_parser = specialized_algorithm())]
    pub without: Vec<TreeAlgorithm>,
    /// Start every repetition from the reset state, so that all compute the same motion
    #[arg(long)]
    pub reset: bool,
}

/// The time of a step. Times are measured: they differ from run to run.
#[derive(Clone, Debug, Serialize, JsonSchema)]
#[serde(rename_all = "camelCase")]
pub struct StepTime {
    /// The fastest repetition, in nanoseconds for a step; null when none was finished.
    pub min_ns: Option<f64>,
    /// The median of the repetitions.
    pub median_ns: Option<f64>,
    /// Steps of each repetition.
    pub steps: usize,
    /// Degrees of freedom.
    pub nv: usize,
    /// Contacts at the end.
    pub ncon: usize,
    /// Rows of constraints at the end.
    pub nefc: usize,
    /// Time of the simulation at the end, in seconds.
    #[schemars(with = "Option<f64>")]
    pub time: f64,
    /// Under the key of a number that is null: what it was. Absent when every number is one.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(with = "NonfiniteTime")]
    pub nonfinite: Option<NonfiniteTime>,
}

/// A time that JSON cannot represent.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct NonfiniteTime {
    /// Its name.
    #[schemars(with = "NonfiniteName")]
    pub time: &'static str,
}

/// A parser for the name of a specialized tree algorithm.
fn specialized_algorithm() -> impl TypedValueParser<Value = TreeAlgorithm> {
    PossibleValuesParser::new(TreeAlgorithm::short().map(TreeAlgorithm::name)).try_map(|name| {
        let mut algorithms = TreeAlgorithm::short();
        algorithms.find(|algorithm| algorithm.name() == name).ok_or("this algorithm does not exist")
    })
}

/// Measures the steps of a lab, or of a model as a lab without displays. Ctrl-C ends the measurement after the
/// last completed repetition.
pub fn measure_steps(lab: &Lab, model: &Model, programs: &Programs, options: &BenchOptions) -> StepTime {
    let reads = if options.full { FieldSet::ALL } else { programs.access.reads };
    let access = AccessSet { reads, ..programs.access };
    let algorithms = options.without.iter().fold(TreeAlgorithms::ALL, |all, &one| all.without(one));
    let plan = Plan::by_algorithms(model, &access, algorithms);
    let start = Start { plan: Some(plan), ..Start::of_lab(lab) };
    let mut session = Session::start(programs, model, start);
    let steps = options.steps.clamp(1, MAX_STEPS);
    let has_programs = !programs.probes.is_empty() || programs.controller.is_some();
    // Inlined here, so that a counter of `advance` does not include these steps.
    run_steps(&mut session, options.warm.min(MAX_STEPS), has_programs);
    let start = session.world.data.clone();
    let mut nanoseconds = Vec::new();
    for _ in 0..options.repeat.clamp(1, 1000) {
        if interrupt::requested() {
            break;
        }
        if options.reset {
            session.world.data.clone_from(&start);
        }
        let clock = Instant::now();
        advance(&mut session, steps, has_programs);
        // An interrupted repetition is not a valid measurement.
        if interrupt::requested() {
            break;
        }
        nanoseconds.push(clock.elapsed().as_nanos() as f64 / steps as f64);
    }
    nanoseconds.sort_by(f64::total_cmp);
    let d = session.world.data.fields();
    StepTime {
        min_ns: nanoseconds.first().copied(),
        median_ns: nanoseconds.get(nanoseconds.len() / 2).copied(),
        steps,
        nv: model.nv,
        ncon: d.ncon,
        nefc: d.nefc,
        time: d.time,
        nonfinite: nonfinite(d.time).map(|time| NonfiniteTime { time }),
    }
}

/// The measured steps. Not inlined, so that a profiler can count from here.
#[inline(never)]
fn advance(session: &mut Session<'_>, steps: usize, has_programs: bool) {
    run_steps(session, steps, has_programs);
}

/// Performs whole steps: of the engine for a model, of the session with its controller for a lab.
#[inline(always)]
fn run_steps(session: &mut Session<'_>, steps: usize, has_programs: bool) {
    // Ctrl-C is checked only every 256 steps, so that the check does not affect the measurement.
    for first in (0..steps).step_by(256) {
        let some = 256.min(steps - first);
        if has_programs {
            (0..some).for_each(|_| session.step());
        } else {
            let world = &mut session.world;
            // Data and model of a session belong together, so no step is refused.
            (0..some).for_each(|_| drop(labspec_core::step(&world.model, &mut world.data)));
        }
        if interrupt::requested() {
            break;
        }
    }
}
