//! Stages that may be called by themselves, where they need scratch.

use crate::dynamics::{self, rne as newton_euler};
use crate::geometry::Distance;
use crate::model::Model;
use crate::model::stopwatch::StageTimes;
use crate::step::workspace::Workspace;
use crate::{collision, constraint, query};

/// Poses of bodies, joints, geoms and sites (`mj_kinematics`).
pub(crate) fn kinematics(m: &Model, d: &mut Workspace) {
    dynamics::kinematics(m, &mut d.fields, &mut d.work.dynamics);
}

/// The generalized force (nv) that causes the acceleration `qacc` (nv), or none when it is not given: gravity, Coriolis and
/// centrifugal force then (`mj_rne`). The inertia of joints (armature) does not count. `None` when an array is shorter.
///
/// It needs the position and velocity stages of a full pipeline.
pub(crate) fn rne(m: &Model, d: &mut Workspace, qacc: Option<&[f64]>, out: &mut [f64]) -> Option<()> {
    newton_euler::rne(m, &mut d.fields, &mut d.work.dynamics, qacc, out)
}

/// The Jacobian of the constraints as a dense matrix, `nefc` x `nv`, row-major (`efc_J`).
pub(crate) fn full_j(m: &Model, d: &Workspace) -> Vec<f64> {
    constraint::full_j(m, d, &d.work.constraint.jac)
}

/// The distance of two geoms up to `most`, m, with the segment from the first to the second (`mj_geomDistance`).
///
/// Shapes with closed forms use those, at their deepest contact; two planes or height fields have no distance.
/// `None` where this build cannot find it.
pub(crate) fn geom_distance(
    m: &Model,
    d: &mut Workspace,
    geom1: usize,
    geom2: usize,
    most: f64,
) -> Option<Distance> {
    query::geom_distance(m, &mut d.fields, &mut d.work.sensor.narrow, [geom1, geom2], most)
}

/// The work that was done with these data since they were made: about nanoseconds of a fast machine.
pub(crate) fn cost(d: &Workspace) -> u64 {
    d.meter.cost
}

/// What the stages took since the stopwatch was started, or was asked last.
pub(crate) fn laps(d: &mut Workspace) -> StageTimes {
    let Some(watch) = &mut d.work.watch else { return StageTimes::default() };
    watch.ended = None;
    std::mem::take(&mut watch.laps)
}

/// How many pairs of geoms have bounds within reach of each other, where the geoms are now.
pub(crate) fn pairs_in_reach(m: &Model, d: &Workspace) -> usize {
    collision::in_reach(m, &d.fields, &d.work.collision)
}

/// What a forward pass costs without pairs and constraints, in the same unit.
pub(crate) fn cost_of_pass(d: &Workspace) -> u64 {
    2 * d.meter.half
}

/// Lets the engine do so much more work and no more. Beyond that its results are of no use: see [`exhausted`].
pub(crate) fn limit(d: &mut Workspace, units: u64) {
    d.meter.limit = d.meter.cost.saturating_add(units);
}

/// Whether the limit is passed, and results with it are of no use.
pub(crate) fn exhausted(d: &Workspace) -> bool {
    d.meter.over()
}

/// Counts work that was done on the data by others.
pub(crate) fn charge(d: &mut Workspace, units: u64) {
    d.meter.add(units);
}

/// What is left of the limit.
pub(crate) fn work_left(d: &Workspace) -> u64 {
    d.meter.left()
}
