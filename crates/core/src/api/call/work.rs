//! What was spent on data: work, which is counted and limited, and time, where the caller brings a clock.

use super::{Data, Scope};
use crate::model::stopwatch::StageTimes;
use crate::step::reset;

/// The work that was done with these data since they were made: about nanoseconds of a fast machine.
pub fn cost<S: Scope>(d: &Data<S>) -> u64 {
    d.fields.meter.cost
}

/// What a forward pass costs without pairs and constraints, in the same unit.
pub fn cost_of_pass<S: Scope>(d: &Data<S>) -> u64 {
    d.fields.meter.pass()
}

/// Measures the stages from here on, from nothing, by a clock that the caller brings: it counts up in any unit. Each run of a
/// stage then costs two looks at the clock more; numbers stay the same.
pub fn clock<S: Scope>(d: &mut Data<S>, clock: fn() -> u64) {
    reset::clock(&mut d.fields, &mut d.scratch, clock);
}

/// What the stages took since [`clock`], or since this was asked last; nothing without a clock.
pub fn laps<S: Scope>(d: &mut Data<S>) -> StageTimes {
    let Some(watch) = &mut d.scratch.watch else { return StageTimes::default() };
    watch.ended = None;
    std::mem::take(&mut watch.laps)
}

/// Lets the engine do so much more work and no more. Beyond that its results are of no use: see [`exhausted`].
pub fn limit<S: Scope>(d: &mut Data<S>, units: u64) {
    d.fields.meter.set_left(units);
}

/// What is left of the limit.
pub fn work_left<S: Scope>(d: &Data<S>) -> u64 {
    d.fields.meter.left()
}

/// Whether the limit is passed, and results with it are of no use.
pub fn exhausted<S: Scope>(d: &Data<S>) -> bool {
    d.fields.meter.over()
}

/// Counts work that was done on the data by others.
pub fn charge<S: Scope>(d: &mut Data<S>, units: u64) {
    d.fields.meter.add(units);
}
