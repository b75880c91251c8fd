//! Growth: detects that a running simulation gains energy that no force supplied.
//!
//! With constant inputs, the equations of motion conserve or dissipate energy. With the kinetic energy ½ vᵀ M v and the
//! potential V of gravity, springs and servos,
//!
//! > d/dt (½ vᵀ M v + V) = -(power of dampers and friction) + (power of constraints) ≤ 0,
//!
//! because constraints return at most the energy that they absorbed or that the initial state gave them. Any energy beyond
//! that was created by the integrator. A sufficiently short timestep creates little. The energy of a symplectic method
//! oscillates about its initial value (Hairer, Lubich, Wanner, "Geometric Numerical Integration", chapter IX), with a large
//! amplitude just below the stability limit. The available energy at a time is the initial energy, plus the energy that
//! gravity, springs and servos have released since or store now. A gain is reported as growth when it could lift all bodies
//! by a quarter of the size of the scene, and in addition
//!
//! * the gain within one step is three times the available energy; near the stability limit of a spring or a servo the
//!   factor is 1.5 times the energy ratio of its oscillation (see [`stability::swing`]), at most ten;
//! * or the gain exceeds the available energy for 32 steps, or is a thousand times the available energy without the energy
//!   of springs.
//!
//! Computing the energy costs a considerable part of a step. The monitor therefore first tests a bound on the kinetic
//! energy. With m_k on the diagonal of M,
//!
//! > ½ vᵀ M v ≤ ½ (Σ √m_k |v_k|)²,
//!
//! because |M_jk| ≤ √(m_j m_k). Energy that the integrator creates appears as kinetic energy at least once per oscillation.
//! While this bound is below half of the smallest reportable gain, the monitor computes nothing else. The factor is one
//! half because m_k are values of an earlier evaluation. The monitor also skips three steps after an evaluation that found
//! only a small gain, while the bound, which is tested in every step, is at most 2.25 times its value at that evaluation. A gain
//! of three times the available energy that appears and vanishes within these steps is missed only if the bound hardly grows.
//!
//! In a run that computes all poses, the energy of a state is evaluated one step later: the step that starts from this state
//! has then computed its poses. Other runs compute the poses in separate data.
//!
//! A step in which a body rotates by more than half a turn cannot resolve the motion. If nothing in the scene is elastic, a
//! gain that is observed a few times in such steps is growth, whether it persists or not. An example is a pendulum with a
//! timestep of one second.
//!
//! A joint with negative damping is an unlimited motor. The energy that it supplies is a gain like any other and is
//! reported with the name of the joint. If the damping becomes positive at larger speeds, as in a self-sustained
//! oscillator, the energy is bounded, and the monitor stops.
//!
//! A servo or motor without states acts along its length x with the force clip(a - k x), which has a potential in closed
//! form. The monitor stops if anything else can supply energy (other actuators, applied forces, wind, moving surfaces,
//! other dampers with negative coefficients), because a false alarm is worse than a missed report.

use super::{slides, stability};
use labspec_core::math::{MINVAL, norm, rows};
use labspec_core::{Data, Energy, Fields, Model, Plan, Planned, Scope, disable};
use labspec_core::{copy_poses, energy_of_poses, exhausted, forward, limit, mass_matrix, mechanical_energy};
use labspec_core::{mul_m, state, steps_compute_poses, work_left};

/// Bounds of the factor by which the gain of one step must exceed the available energy: the usual value, and the largest
/// value, which applies near the stability limit of a spring. `OSCILLATION_FACTOR` is the factor on the energy ratio of
/// the stiffest spring.
const STEP_GAIN_FACTORS: [f64; 2] = [3.0, 10.0];
const OSCILLATION_FACTOR: f64 = 1.5;
/// A gain of this factor times the available energy, without the energy of springs, cannot be an oscillation of a spring.
const CERTAIN_GAIN_FACTOR: f64 = 1e3;
/// The smallest reportable gain, as a fraction of the energy that lifts all bodies by the size of the scene.
const MIN_LIFT_FRACTION: f64 = 0.25;
/// Number of steps for which a gain above the available energy must persist.
const MIN_GAIN_STEPS: u32 = 32;
/// Number of steps that are skipped after an evaluation whose gain is below the fraction `SKIP_FRACTION` of the available energy,
/// while the speeds are at most `SKIP_SPEED_FACTOR` times as large.
const SKIPPED_STEPS: u32 = 3;
const SKIP_FRACTION: f64 = 0.25;
const SKIP_SPEED_FACTOR: f64 = 1.5;
/// A rotation per step that a step cannot resolve, rad, and the number of gains in such steps that is reported.
const MAX_RESOLVED_ROTATION: f64 = std::f64::consts::PI;
const MIN_UNRESOLVED_GAINS: u32 = 4;
/// Motion below the fraction `MIN_MOTION_FRACTION` of the smallest reportable gain is not evaluated. In scenes with more
/// than `MAX_DOFS_PER_STEP_INERTIA` degrees of freedom, the diagonal of M is recomputed only once per
/// `EVALUATIONS_PER_UPDATE` evaluations.
const MIN_MOTION_FRACTION: f64 = 0.5;
const MAX_DOFS_PER_STEP_INERTIA: usize = 12;
const EVALUATIONS_PER_UPDATE: u32 = 64;
/// Speed at which a scene at rest may drift, as a fraction of its size per second.
const DRIFT: f64 = 0.01;

/// A gain of energy that no force supplied.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Growth {
    /// Time at which the gain began, s.
    pub time: f64,
    /// Energy gained since the start, at the time when the growth is certain, J.
    pub gain: f64,
    /// Initial energy plus the energy that lifts all bodies by the size of the scene, J.
    pub available_energy: f64,
    /// The degree of freedom with the largest part of the kinetic energy.
    pub dof: usize,
    /// The source of the energy.
    pub source: Source,
}

/// The source of a gain of energy.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Source {
    /// The integrator: the force of a step overshoots by more than the deviation that it corrects.
    Steps,
    /// Long steps: a body rotates by this angle in one step, rad.
    LongSteps(f64),
    /// The negative damping of this degree of freedom.
    Damper(usize),
}

/// Monitors the energy of a run. It contains the initial energy, and separate data so that evaluations do not change the
/// run.
#[derive(Clone, Debug)]
pub struct GrowthMonitor {
    copied: Data<Planned>,
    start: Option<StartEnergy>,
    /// Whether the steps of the run compute the poses, and whether the state in `copied` is to be evaluated with those of the next
    /// step.
    poses_of_steps: bool,
    pending: bool,
    /// Square roots of the diagonal of M, the largest observed values, and the number of evaluations until the next update.
    roots: Vec<f64>,
    evaluations_until_update: u32,
    /// Factor by which the gain of one step must exceed the available energy.
    sudden: f64,
    /// Number of steps to skip, and Σ √m_k |v_k| at the last evaluation.
    rest: u32,
    speed: f64,
    /// Number of steps for which a gain has persisted, and the time of the first.
    lasted: u32,
    since: f64,
    /// Number of gains observed in steps whose rotation exceeds `MAX_RESOLVED_ROTATION`.
    leaps: u32,
    found: Option<Growth>,
}

#[derive(Clone, Copy, Debug)]
struct StartEnergy {
    energy: Energy,
    /// The initial energy, and the energy that lifts all bodies by the size of the scene, J.
    available_energy: f64,
    lift: f64,
}

/// Starts monitoring a run in state `d`. This is the only function of the monitor that allocates.
pub fn watch<S: Scope>(m: &Model, d: &Data<S>) -> GrowthMonitor {
    let mut w = GrowthMonitor {
        copied: Data::planned(m, Plan::awake()),
        start: None,
        poses_of_steps: false,
        pending: false,
        roots: vec![0.0; m.nv],
        evaluations_until_update: 0,
        sudden: 0.0,
        rest: 0,
        speed: 0.0,
        lasted: 0,
        since: 0.0,
        leaps: 0,
        found: None,
    };
    restart(&mut w, m, d);
    w
}

/// Restarts the monitor in state `d` after the state or the model was changed from outside. A reported gain is kept.
pub fn restart<S: Scope>(w: &mut GrowthMonitor, m: &Model, d: &Data<S>) {
    (w.start, w.pending, w.lasted, w.leaps, w.rest) = (None, false, 0, 0, 0);
    if m.nv == 0 || has_energy_source(m, d) {
        return;
    }
    let (to, from) = (w.copied.edit(), d.fields());
    to.ctrl.copy_from_slice(&from.ctrl);
    to.mocap_pos.copy_from_slice(&from.mocap_pos);
    to.mocap_quat.copy_from_slice(&from.mocap_quat);
    to.eq_active.copy_from_slice(&from.eq_active);
    take(&mut w.copied, m, d);
    limit(&mut w.copied, work_left(d));
    if forward(m, &mut w.copied).is_ok() && !exhausted(&w.copied) {
        let energy = mechanical_energy(m, &mut w.copied).ok().flatten();
        w.start = energy.map(|energy| start(m, &w.copied, energy));
        w.roots.fill(0.0);
        w.evaluations_until_update = 0;
        w.sudden = step_gain_factor(m);
        w.poses_of_steps = steps_compute_poses(m, d);
        update_inertia_scale(w, m, false);
    }
}

/// Factor by which the gain of one step must exceed the available energy.
fn step_gain_factor(m: &Model) -> f64 {
    let swing = OSCILLATION_FACTOR * stability::swing(m);
    if swing.is_finite() {
        swing.clamp(STEP_GAIN_FACTORS[0], STEP_GAIN_FACTORS[1])
    } else {
        STEP_GAIN_FACTORS[1]
    }
}

/// Updates the square roots of the diagonal of M where they have increased. `has_mass_matrix`: M of these poses is at hand.
fn update_inertia_scale(w: &mut GrowthMonitor, m: &Model, has_mass_matrix: bool) {
    w.evaluations_until_update = w.evaluations_until_update.saturating_sub(1);
    if w.evaluations_until_update > 0 {
        return;
    }
    w.evaluations_until_update = if m.nv <= MAX_DOFS_PER_STEP_INERTIA { 1 } else { EVALUATIONS_PER_UPDATE };
    if !has_mass_matrix {
        let filled = mass_matrix(m, &mut w.copied);
        debug_assert!(filled.is_ok(), "the data belong to the model, and their plan keeps every stage");
    }
    let elements = &w.copied.fields().M;
    // A row of M ends with its diagonal.
    for ((root, &start), &length) in w.roots.iter_mut().zip(&m.M_rowadr).zip(&m.M_rownnz) {
        if let Some(diagonal) = elements.get((start + length - 1) as usize) {
            *root = root.max(diagonal.max(0.0).sqrt());
        }
    }
}

/// Call after each step. It does not modify the run, and it costs little while all motion is slow.
#[inline]
pub fn observe<S: Scope>(w: &mut GrowthMonitor, m: &Model, d: &Data<S>) -> Option<Growth> {
    let Some(start) = w.start.filter(|_| w.found.is_none()) else { return w.found };
    if w.pending && evaluate_pending(w, m, d, start) {
        return w.found;
    }
    let qvel = &d.fields().qvel;
    let speed: f64 = w.roots.iter().zip(qvel.iter()).map(|(root, v)| root * v.abs()).sum();
    // The comparison is false for NaN, so NaN is evaluated.
    if w.lasted == 0
        && 0.5 * speed * speed
            < MIN_MOTION_FRACTION * (start.available_energy + MIN_LIFT_FRACTION * start.lift)
    {
        return None;
    }
    if w.rest > 0 && speed <= SKIP_SPEED_FACTOR * w.speed {
        w.rest -= 1;
        return None;
    }
    w.speed = speed;
    evaluate(w, m, d, start)
}

/// Compares the energy of the current state with that of the start, or leaves the state to the next step.
fn evaluate<S: Scope>(w: &mut GrowthMonitor, m: &Model, d: &Data<S>, start: StartEnergy) -> Option<Growth> {
    let (copied, current) = (w.copied.fields(), d.fields());
    if copied.ctrl != current.ctrl || scene_changed(w, d) || applied(d) {
        restart(w, m, d);
        return None;
    }
    take(&mut w.copied, m, d);
    if w.poses_of_steps {
        w.pending = true;
        return None;
    }
    let energy = mechanical_energy(m, &mut w.copied).ok().flatten()?;
    compare(w, m, energy, start, false)
}

/// Compares the energy of the state that was left to this step with that of the start. Returns whether the monitor has restarted or
/// has found growth.
fn evaluate_pending<S: Scope>(w: &mut GrowthMonitor, m: &Model, d: &Data<S>, start: StartEnergy) -> bool {
    w.pending = false;
    if scene_changed(w, d) {
        restart(w, m, d);
        return true;
    }
    // A step that finds bad numbers starts from the reset state.
    let steps = (d.time() - w.copied.time()) / m.opt.timestep;
    let computed = (0.5..1.5).contains(&steps) && copy_poses(m, &mut w.copied, d).is_ok();
    let energy =
        if computed { energy_of_poses(m, &mut w.copied) } else { mechanical_energy(m, &mut w.copied) };
    let Ok(Some(energy)) = energy else { return false };
    compare(w, m, energy, start, computed).is_some()
}

/// The growth that the last state of a run shows, if it was left to a step that was not made.
pub fn evaluate_last(w: &GrowthMonitor, m: &Model) -> Option<Growth> {
    let start = w.start.filter(|_| w.pending && w.found.is_none())?;
    let mut last = w.clone();
    let energy = mechanical_energy(m, &mut last.copied).ok().flatten()?;
    compare(&mut last, m, energy, start, false)
}

/// Whether positions of mocap bodies or active equality constraints differ from those of the start.
fn scene_changed<S: Scope>(w: &GrowthMonitor, d: &Data<S>) -> bool {
    let (copied, current) = (w.copied.fields(), d.fields());
    copied.mocap_pos != current.mocap_pos
        || copied.mocap_quat != current.mocap_quat
        || copied.eq_active != current.eq_active
}

/// Compares the energy of the state in `copied` with that of the start.
fn compare(
    w: &mut GrowthMonitor,
    m: &Model,
    current: Energy,
    start: StartEnergy,
    has_mass_matrix: bool,
) -> Option<Growth> {
    let StartEnergy { energy: before, available_energy, lift } = start;
    update_inertia_scale(w, m, has_mass_matrix);
    let given = before.potential() - current.potential();
    let gain = current.kinetic - before.kinetic - given;
    let there = available_energy + given.max(current.elastic.abs());
    let dof_of_negative_damping = dof_of_negative_damping(m, w.copied.fields());
    let sudden = if dof_of_negative_damping.is_some() { 1.0 } else { w.sudden };
    // A gain of NaN exceeds no bound.
    let above = |times: f64, there: f64| gain > times * there + MIN_LIFT_FRACTION * lift;
    let sure = gain > CERTAIN_GAIN_FACTOR * (available_energy + given.max(0.0) + lift);
    let (seen, leapt) = (sure || above(1.0, there), sure || above(sudden, there));
    w.rest = if gain < SKIP_FRACTION * there { SKIPPED_STEPS } else { 0 };
    if !seen {
        w.lasted = 0;
        return None;
    }
    // Elastic energy oscillates with a large amplitude just below the stability limit, and returns.
    let stiff = before.elastic != 0.0 || current.elastic != 0.0;
    let turn = if stiff { 0.0 } else { largest_rotation(m, w.copied.fields()) };
    if w.lasted == 0 && w.leaps == 0 {
        w.since = w.copied.time();
    }
    w.lasted += 1;
    w.leaps += u32::from(turn > MAX_RESOLVED_ROTATION);
    if leapt || w.lasted >= MIN_GAIN_STEPS || w.leaps >= MIN_UNRESOLVED_GAINS {
        let source = match dof_of_negative_damping {
            Some(dof) => Source::Damper(dof),
            None if turn > MAX_RESOLVED_ROTATION => Source::LongSteps(turn),
            None => Source::Steps,
        };
        let dof = most_energetic_dof(m, &mut w.copied);
        w.found =
            Some(Growth { time: w.since, gain, available_energy: available_energy + lift, dof, source });
    }
    w.found
}

/// The largest rotation of a joint in one step, rad.
fn largest_rotation(m: &Model, d: &Fields) -> f64 {
    let mut first = 0;
    let of_joint = |dofs: &[i32]| {
        let start = first;
        first += dofs.len();
        (start..first).filter(|&dof| !slides(m, dof)).map(|dof| d.qvel[dof] * d.qvel[dof]).sum::<f64>()
    };
    // The degrees of freedom of a joint follow each other.
    let joints = m.dof_jntid.chunk_by(|a, b| a == b);
    m.opt.timestep * joints.map(of_joint).fold(0.0, f64::max).sqrt()
}

/// The degree of freedom whose negative damping supplies the most power.
fn dof_of_negative_damping(m: &Model, d: &Fields) -> Option<usize> {
    let power = |k: &usize| -m.dof_damping[*k] * d.qvel[*k] * d.qvel[*k];
    let pushing = (0..m.nv).filter(|&k| m.dof_damping[k] < 0.0 && !m.opt.disabled(disable::DAMPER));
    pushing.max_by(|a, b| power(a).total_cmp(&power(b)))
}

/// Copies the positions and velocities of a run.
fn take<S: Scope>(copied: &mut Data<Planned>, m: &Model, d: &Data<S>) {
    let copied = state::copy(m, d, copied, state::TIME | state::QPOS | state::QVEL);
    debug_assert!(copied.is_ok(), "both data belong to the model");
}

/// The initial energies: kinetic energy, elastic energy, and the energy stored in violated constraints.
fn start(m: &Model, d: &Data<Planned>, energy: Energy) -> StartEnergy {
    let d = d.fields();
    let places = d.efc_pos.iter().zip(&d.efc_margin).map(|(pos, margin)| pos - margin);
    let stored = places.zip(rows::<4>(&d.efc_KBIP)).zip(&d.efc_diagA);
    let stored: f64 = stored.map(|((x, kbip), a)| 0.5 * kbip[0] * x * x / a.max(MINVAL)).sum();
    let (mass, size) = (m.body_mass.iter().sum::<f64>(), size(m, d));
    let drift = 0.5 * mass * (DRIFT * size) * (DRIFT * size);
    let weight = if m.opt.disabled(disable::GRAVITY) { 0.0 } else { mass * norm(m.opt.gravity) };
    let available_energy = energy.kinetic + energy.elastic.abs() + stored + drift;
    StartEnergy { energy, available_energy, lift: weight * size }
}

/// The diagonal of a box around all bodies and the origin, plus the radius of the largest moving geom, m.
fn size(m: &Model, d: &Fields) -> f64 {
    let along = |k: usize| {
        let ends = rows::<3>(&d.xipos).iter().fold([0.0_f64; 2], |[lo, hi], x| [lo.min(x[k]), hi.max(x[k])]);
        ends[1] - ends[0]
    };
    let radii = m.geom_rbound.iter().zip(&m.geom_bodyid).filter(|&(_, &b)| b > 0).map(|(&r, _)| r);
    norm([0, 1, 2].map(along)) + radii.fold(0.0, f64::max)
}

/// The degree of freedom whose part v (M v) of the kinetic energy is the largest.
fn most_energetic_dof(m: &Model, d: &mut Data<Planned>) -> usize {
    let mut momentum = vec![0.0; m.nv];
    let filled = mass_matrix(m, d);
    let qvel = &d.fields().qvel;
    if filled.and_then(|()| mul_m(m, d, qvel, &mut momentum)).is_err() {
        return 0;
    }
    let part = |k: usize| (qvel[k] * momentum[k]).abs();
    (0..qvel.len()).max_by(|&a, &b| part(a).total_cmp(&part(b))).unwrap_or(0)
}

/// Whether external forces are applied.
fn applied<S: Scope>(d: &Data<S>) -> bool {
    let d = d.fields();
    d.qfrc_applied.iter().chain(&d.xfrc_applied).any(|&f| f != 0.0)
}

/// Whether something other than actuators can supply energy, or limits of joints and tendons clip actuator forces.
fn has_energy_source<S: Scope>(m: &Model, d: &Data<S>) -> bool {
    let some = |list: &[f64]| list.iter().any(|&x| x != 0.0);
    let pushes = |list: &[f64]| list.iter().any(|&x| x < 0.0);
    let wind = some(&m.opt.wind) && (m.opt.density != 0.0 || m.opt.viscosity != 0.0);
    // The damper of a joint is handled above if it supplies energy, unless it dissipates at other speeds.
    let turns =
        m.dof_damping.iter().zip(rows::<2>(&m.dof_dampingpoly)).any(|(&b, poly)| b < 0.0 && some(poly));
    let dampers = [
        &m.dof_dampingpoly,
        &m.tendon_damping,
        &m.tendon_dampingpoly,
        &m.actuator_damping,
        &m.actuator_dampingpoly,
    ];
    let cut =
        m.nactuator > 0 && (m.jnt_actfrclimited.contains(&true) || m.tendon_actfrclimited.contains(&true));
    applied(d)
        || wind
        || turns
        || cut
        || some(&m.geom_surfacevel)
        || some(&m.geom_adhesion)
        || some(&m.actuator_delay)
        || dampers.iter().any(|list| pushes(list))
}

#[cfg(test)]
#[allow(clippy::unwrap_used)] // a panic is the report of a failed test
#[path = "growth_tests.rs"]
mod tests;
