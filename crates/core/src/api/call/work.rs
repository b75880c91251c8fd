//! The cost of data: work, which is counted and limited, and time, which is measured with a clock of the caller.

use super::{Data, Scope};
use crate::model::stopwatch::StageTimes;
use crate::step::reset;

/// The work that was done with these data since they were created. One unit is about a nanosecond on a fast machine.
pub fn cost<S: Scope>(d: &Data<S>) -> u64 {
    d.fields.meter.cost
}

/// The work of a forward pass without collision pairs and constraints, in the same unit.
pub fn cost_of_pass<S: Scope>(d: &Data<S>) -> u64 {
    d.fields.meter.pass()
}

/// Starts measuring the times of the stages from zero, with a clock of the caller that counts up in any unit. Each run of a
/// stage then reads the clock twice. No number of the simulation changes.
pub fn clock<S: Scope>(d: &mut Data<S>, clock: fn() -> u64) {
    reset::clock(&mut d.fields, &mut d.scratch, clock);
}

/// The time of each stage since [`clock`] or since the last call of this function. Zero without a clock.
pub fn stage_times<S: Scope>(d: &mut Data<S>) -> StageTimes {
    let Some(watch) = &mut d.scratch.watch else { return StageTimes::default() };
    watch.ended = None;
    std::mem::take(&mut watch.stage_times)
}

/// Limits the further work of the engine. Results after the limit is exceeded are not valid: see [`exhausted`].
pub fn limit<S: Scope>(d: &mut Data<S>, units: u64) {
    d.fields.meter.set_left(units);
}

/// The remaining work of the limit.
pub fn work_left<S: Scope>(d: &Data<S>) -> u64 {
    d.fields.meter.left()
}

/// Whether the limit is exceeded, so that the results are not valid.
pub fn exhausted<S: Scope>(d: &Data<S>) -> bool {
    d.fields.meter.over()
}

/// Counts work that other code did on the data.
pub fn charge<S: Scope>(d: &mut Data<S>, units: u64) {
    d.fields.meter.add(units);
}
