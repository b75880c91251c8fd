//! `labspec bench`: the cost of a step, as JSON. This is also what an instruction counter runs.

use super::common::{Failure, ModelOptions, Outcome, interrupted};
use super::stdio::print_json;
use super::target;
use clap::builder::{PossibleValuesParser, TypedValueParser};
use labspec::report::{report, set_number};
use labspec::run::{Session, Start};
use labspec_core::reflect::FieldSet;
use labspec_core::{AccessSet, Plan, TreeAlgorithm, TreeAlgorithms};
use serde_json::json;
use std::time::Instant;

/// Arguments of `bench`.
#[derive(clap::Args, Debug)]
pub(super) struct Arguments {
    /// MODEL.xml, or a lab as for `run`
    lab: String,
    #[command(flatten)]
    models: ModelOptions,
    /// Steps of each repetition
    #[arg(long, value_name = "N", default_value_t = 20_000)]
    steps: usize,
    /// Steps before the first repetition
    #[arg(long, value_name = "N", default_value_t = 1_000)]
    warm: usize,
    /// Repetitions
    #[arg(long, value_name = "N", default_value_t = 7)]
    repeat: usize,
    /// Compute every field in every step, read or not. Without it a model alone is planned for its state,
    /// a lab for what it reads
    #[arg(long)]
    full: bool,
    /// Compute trees without this specialized algorithm; may be given several times
    #[arg(long, value_name = "ALGORITHM", value_parser = specialized_algorithm())]
    without: Vec<TreeAlgorithm>,
    /// Start every repetition from the reset state, so that all compute the same motion
    #[arg(long)]
    reset: bool,
}

/// A short way of computing trees, by its name.
fn specialized_algorithm() -> impl TypedValueParser<Value = TreeAlgorithm> {
    PossibleValuesParser::new(TreeAlgorithm::short().map(TreeAlgorithm::name)).try_map(|name| {
        TreeAlgorithm::short().find(|way| way.name() == name).ok_or("this algorithm does not exist")
    })
}

pub(super) fn bench(a: &Arguments) -> Result<Outcome, Failure> {
    let target = target::open(&a.lab, &a.models)?;
    let demand = if a.full {
        AccessSet { reads: FieldSet::ALL, ..target.programs.demand }
    } else {
        target.programs.demand
    };
    let ways = a.without.iter().fold(TreeAlgorithms::ALL, |ways, &short| ways.without(short));
    let plan = Plan::by_algorithms(&target.model, &demand, ways);
    let start = Start { key: target.lab.keyframe(), plan: Some(plan), ..Start::default() };
    let mut session = Session::start(&target.programs, &target.model, start);
    let steps = a.steps.clamp(1, labspec::run::MAX_STEPS);
    let lab = !target.programs.probes.is_empty() || target.programs.controller.is_some();
    // Inlined here, so that a counter of `advance` does not see it.
    run_steps(&mut session, a.warm.min(labspec::run::MAX_STEPS), lab);
    let start = session.world.data.clone();
    let mut nanoseconds = Vec::new();
    for _ in 0..a.repeat.clamp(1, 1000) {
        if interrupted() {
            break;
        }
        if a.reset {
            session.world.data.clone_from(&start);
        }
        let clock = Instant::now();
        advance(&mut session, steps, lab);
        // A repetition that was cut short is no measurement.
        if interrupted() {
            break;
        }
        nanoseconds.push(clock.elapsed().as_nanos() as f64 / steps as f64);
    }
    nanoseconds.sort_by(f64::total_cmp);
    let d = session.world.data.fields();
    let mut value = json!({
        "minNs": nanoseconds.first(),
        "medianNs": nanoseconds.get(nanoseconds.len() / 2),
        "steps": steps,
        "nv": target.model.nv,
        "ncon": d.ncon,
        "nefc": d.nefc,
    });
    set_number(&mut value, "time", d.time);
    print_json(&report("bench", value), false)?;
    Ok(Outcome::Clean)
}

/// The measured steps. Not inlined, so that a profiler can count from here.
#[inline(never)]
fn advance(session: &mut Session<'_>, steps: usize, lab: bool) {
    run_steps(session, steps, lab);
}

/// Whole steps: of the engine for a model alone, of the session with its controller for a lab.
#[inline(always)]
fn run_steps(session: &mut Session<'_>, steps: usize, lab: bool) {
    // Ctrl-C is asked for now and then, so that asking costs nothing that can be measured.
    for first in (0..steps).step_by(256) {
        let some = 256.min(steps - first);
        if lab {
            (0..some).for_each(|_| session.step());
        } else {
            let world = &mut session.world;
            // Data and model of a session belong together: no step is refused.
            (0..some).for_each(|_| drop(labspec_core::step(&world.model, &mut world.data)));
        }
        if interrupted() {
            break;
        }
    }
}
