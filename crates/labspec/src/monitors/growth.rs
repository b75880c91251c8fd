//! Growth: whether a running simulation gains energy that nothing gave it.
//!
//! Where inputs stand still, the equations of motion lose energy or keep it. With the kinetic energy ½ vᵀ M v and the potential
//! V of gravity, springs and servos,
//!
//! > d/dt (½ vᵀ M v + V) = -(power of dampers and friction) + (power of constraints) ≤ 0,
//!
//! as constraints give back no more than they took or were given by the start. What a run has beyond that was made by its
//! steps. A step that is short enough makes little, and the energy of a symplectic method oscillates about its start (Hairer,
//! Lubich, Wanner, "Geometric Numerical Integration", chapter IX): widely just below its limit. What can be there at a moment
//! is what the start held, with what gravity, springs and servos have given since or hold now. A gain is growth when it lifts
//! everything by a quarter of the size of the scene, and
//!
//! * in one step is three times what can be there; near the limit of a spring or a servo, 1.5 times the swing that follows (see
//!   [`stability::swing`]), ten times at most;
//! * or is once that for 32 steps, or a thousand times what was there besides what springs hold.
//!
//! To know the energy takes a good part of a step. So it is first asked whether anything is fast enough: with m_k on the diagonal of M,
//!
//! > ½ vᵀ M v ≤ ½ (Σ √m_k |v_k|)²,
//!
//! as |M_jk| ≤ √(m_j m_k). What was made from nothing comes by as motion, once in each swing at least; while this bound is below half of
//! the smallest gain that counts, nothing else is computed (half, because m_k are those of an earlier look), nor for three steps after
//! a look that saw no gain worth mentioning, while the bound is no more than 2.25 times what it was: in them no gain becomes three
//! times what can be there.
//!
//! A step in which something turns by more than half a turn does not follow that motion at all: where nothing is elastic, a gain
//! that is seen a few times there is growth, whether it lasts or not. A pendulum at a step of a second throws itself about like this.
//!
//! A joint whose damping is below zero is a motor without end: what it gives is a gain like any other, and is reported by its
//! name. (Where the damping becomes positive at larger speeds, as in an oscillator that keeps itself going, the end is there, and
//! the watch is over.)
//!
//! A servo or motor without states pulls along its length x with the force clip(a - k x), whose potential is closed. Whatever
//! else may feed a scene (other actuators, applied forces, wind, moving surfaces, other dampers that push) ends the watch: a
//! false alarm is worse than none.

use super::stability;
use labspec_core::math::{MINVAL, norm, rows};
use labspec_core::{Data, Energy, Fields, Model, Plan, Planned, Scope, disable, joint};
use labspec_core::{exhausted, forward, limit, mass_matrix, mechanical_energy, mul_m, work_left};

/// How many times what can be there a gain of one step has to be, at least and near the limit of a spring, and how many times
/// the swing of the stiffest spring.
const SUDDEN: [f64; 2] = [3.0, 10.0];
const SWINGS: f64 = 1.5;
/// As many times what was there besides what springs hold is no swing of theirs.
const SURE: f64 = 1e3;
/// How many times the size of the scene a gain lifts everything.
const LIFTS: f64 = 0.25;
/// For how many steps a gain of once what can be there has to last.
const LASTS: u32 = 32;
/// Steps without a look after one that saw a gain below this part of what can be there, while speeds are at most so many times
/// as large.
const REST: u32 = 3;
const CALM: f64 = 0.25;
const FASTER: f64 = 1.5;
/// An angle that no step follows, rad, and how often a gain has to be seen then.
const TURN: f64 = std::f64::consts::PI;
const LEAPS: u32 = 4;
/// Motion that is less than this part of the smallest gain is not looked at. In scenes of more degrees of freedom than these
/// the diagonal of M is taken anew after so many looks only.
const SLOW: f64 = 0.5;
const FEW: usize = 12;
const LOOKS_PER_UPDATE: u32 = 64;
/// A scene at rest may drift by this part of its size in a second.
const DRIFT: f64 = 0.01;

/// Energy that nothing gave.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Growth {
    /// Since when, s.
    pub time: f64,
    /// How much more there is than at the start when that is certain, J.
    pub gain: f64,
    /// What the start held, with the weight of everything lifted by the size of the scene, J.
    pub held: f64,
    /// The degree of freedom that moves with the largest part of it.
    pub dof: usize,
    /// Where it comes from.
    pub source: Source,
}

/// Where energy comes from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Source {
    /// The steps push farther than they miss.
    Steps,
    /// The steps are so long that something turns by this angle in one, rad.
    LongSteps(f64),
    /// A damper below zero, of this degree of freedom: it pushes.
    Damper(usize),
}

/// What a run is held against: its start, and data of its own so that looking leaves the run alone.
#[derive(Clone, Debug)]
pub struct GrowthMonitor {
    copied: Data<Planned>,
    start: Option<StartEnergy>,
    /// Roots of the diagonal of M, the largest that were seen, and looks until they are seen again.
    roots: Vec<f64>,
    looks_until_update: u32,
    /// How large a sudden gain is, in parts of what can be there.
    sudden: f64,
    /// Steps without a look, and Σ √m_k |v_k| at the last one.
    rest: u32,
    speed: f64,
    /// Steps for which a gain has lasted, and the time of the first.
    lasted: u32,
    since: f64,
    /// How often a gain was seen in a step that nothing follows.
    leaps: u32,
    found: Option<Growth>,
}

#[derive(Clone, Copy, Debug)]
struct StartEnergy {
    energy: Energy,
    /// What it held, and what lifts everything by the size of the scene, J.
    held: f64,
    lift: f64,
}

/// A watch over a run that is now at `d`. The only call that allocates.
pub fn watch<S: Scope>(m: &Model, d: &Data<S>) -> GrowthMonitor {
    let mut w = GrowthMonitor {
        copied: Data::planned(m, Plan::awake()),
        start: None,
        roots: vec![0.0; m.nv],
        looks_until_update: 0,
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

/// From here on what was is forgotten but for what was found: something from outside has changed the state or the model.
pub fn restart<S: Scope>(w: &mut GrowthMonitor, m: &Model, d: &Data<S>) {
    (w.start, w.lasted, w.leaps, w.rest) = (None, 0, 0, 0);
    if m.nv == 0 || fed(m, d) {
        return;
    }
    let (to, from) = (w.copied.edit(), d.fields());
    to.ctrl.copy_from_slice(&from.ctrl);
    to.mocap_pos.copy_from_slice(&from.mocap_pos);
    to.mocap_quat.copy_from_slice(&from.mocap_quat);
    to.eq_active.copy_from_slice(&from.eq_active);
    take(&mut w.copied, d);
    limit(&mut w.copied, work_left(d));
    if forward(m, &mut w.copied).is_ok() && !exhausted(&w.copied) {
        let energy = mechanical_energy(m, &mut w.copied).ok().flatten();
        w.start = energy.map(|energy| start(m, &w.copied, energy));
        w.roots.fill(0.0);
        w.looks_until_update = 0;
        w.sudden = sudden(m);
        update_inertia_scale(w, m);
    }
}

/// How large a sudden gain is, in parts of what can be there.
fn sudden(m: &Model) -> f64 {
    let swing = SWINGS * stability::swing(m);
    if swing.is_finite() { swing.clamp(SUDDEN[0], SUDDEN[1]) } else { SUDDEN[1] }
}

/// Keeps the roots of the diagonal of M where they are larger than before.
fn update_inertia_scale(w: &mut GrowthMonitor, m: &Model) {
    w.looks_until_update = w.looks_until_update.saturating_sub(1);
    if w.looks_until_update > 0 {
        return;
    }
    w.looks_until_update = if m.nv <= FEW { 1 } else { LOOKS_PER_UPDATE };
    if mass_matrix(m, &mut w.copied).is_err() {
        return;
    }
    let mass_matrix = &w.copied.fields().M;
    // A row of M ends with its diagonal.
    for ((root, &start), &length) in w.roots.iter_mut().zip(&m.M_rowadr).zip(&m.M_rownnz) {
        if let Some(diagonal) = mass_matrix.get((start + length - 1) as usize) {
            *root = root.max(diagonal.max(0.0).sqrt());
        }
    }
}

/// To be called after each step: nothing of the run is touched, and little is done while nothing is fast.
#[inline]
pub fn observe<S: Scope>(w: &mut GrowthMonitor, m: &Model, d: &Data<S>) -> Option<Growth> {
    let Some(start) = w.start.filter(|_| w.found.is_none()) else { return w.found };
    let qvel = &d.fields().qvel;
    let speed: f64 = w.roots.iter().zip(qvel.iter()).map(|(root, v)| root * v.abs()).sum();
    // What is no number is looked at.
    if w.lasted == 0 && 0.5 * speed * speed < SLOW * (start.held + LIFTS * start.lift) {
        return None;
    }
    if w.rest > 0 && speed <= FASTER * w.speed {
        w.rest -= 1;
        return None;
    }
    w.speed = speed;
    compare(w, m, d, start)
}

/// Holds what moves against the start.
fn compare<S: Scope>(w: &mut GrowthMonitor, m: &Model, d: &Data<S>, start: StartEnergy) -> Option<Growth> {
    let (copied, now) = (w.copied.fields(), d.fields());
    let same = copied.ctrl == now.ctrl
        && copied.mocap_pos == now.mocap_pos
        && copied.mocap_quat == now.mocap_quat
        && copied.eq_active == now.eq_active
        && !applied(d);
    if !same {
        restart(w, m, d);
        return None;
    }
    let StartEnergy { energy: before, held, lift } = start;
    take(&mut w.copied, d);
    let now = mechanical_energy(m, &mut w.copied).ok().flatten()?;
    update_inertia_scale(w, m);
    let given = before.potential() - now.potential();
    let gain = now.kinetic - before.kinetic - given;
    let there = held + given.max(now.elastic.abs());
    let pusher = pusher(m, d.fields());
    let sudden = if pusher.is_some() { 1.0 } else { w.sudden };
    // A gain that is no number is not above anything.
    let above = |times: f64, there: f64| gain > times * there + LIFTS * lift;
    let sure = gain > SURE * (held + given.max(0.0) + lift);
    let (seen, leapt) = (sure || above(1.0, there), sure || above(sudden, there));
    w.rest = if gain < CALM * there { REST } else { 0 };
    if !seen {
        w.lasted = 0;
        return None;
    }
    // What is elastic swings widely just below its limit, and comes back.
    let stiff = before.elastic != 0.0 || now.elastic != 0.0;
    let turn = if stiff { 0.0 } else { turn(m, d.fields()) };
    if w.lasted == 0 && w.leaps == 0 {
        w.since = d.time();
    }
    w.lasted += 1;
    w.leaps += u32::from(turn > TURN);
    if leapt || w.lasted >= LASTS || w.leaps >= LEAPS {
        let source = match pusher {
            Some(dof) => Source::Damper(dof),
            None if turn > TURN => Source::LongSteps(turn),
            None => Source::Steps,
        };
        let dof = liveliest(m, &mut w.copied);
        w.found = Some(Growth { time: w.since, gain, held: held + lift, dof, source });
    }
    w.found
}

/// The largest angle by which something turns in a step, rad.
fn turn(m: &Model, d: &Fields) -> f64 {
    let of = |j: usize| {
        let first = m.jnt_dofadr[j] as usize;
        let dofs = match m.jnt_type[j] {
            joint::HINGE => first..first + 1,
            joint::BALL => first..first + 3,
            joint::FREE => first + 3..first + 6,
            _ => first..first,
        };
        dofs.filter_map(|k| d.qvel.get(k)).map(|v| v * v).sum::<f64>().sqrt()
    };
    m.opt.timestep * (0..m.njnt).map(of).fold(0.0, f64::max)
}

/// The degree of freedom whose damper pushes hardest.
fn pusher(m: &Model, d: &Fields) -> Option<usize> {
    let power = |k: &usize| -m.dof_damping[*k] * d.qvel[*k] * d.qvel[*k];
    let pushing = (0..m.nv).filter(|&k| m.dof_damping[k] < 0.0 && !m.opt.disabled(disable::DAMPER));
    pushing.max_by(|a, b| power(a).total_cmp(&power(b)))
}

/// The state of a run.
fn take<S: Scope>(copied: &mut Data<Planned>, d: &Data<S>) {
    let (to, from) = (copied.edit(), d.fields());
    to.qpos.copy_from_slice(&from.qpos);
    to.qvel.copy_from_slice(&from.qvel);
    *to.time = from.time;
}

/// A start with what it holds: its motion, what is elastic, and what the constraints that it violates push back with.
fn start(m: &Model, d: &Data<Planned>, energy: Energy) -> StartEnergy {
    let d = d.fields();
    let places = d.efc_pos.iter().zip(&d.efc_margin).map(|(pos, margin)| pos - margin);
    let stored = places.zip(rows::<4>(&d.efc_KBIP)).zip(&d.efc_diagA);
    let stored: f64 = stored.map(|((x, kbip), a)| 0.5 * kbip[0] * x * x / a.max(MINVAL)).sum();
    let (mass, size) = (m.body_mass.iter().sum::<f64>(), size(m, d));
    let drift = 0.5 * mass * (DRIFT * size) * (DRIFT * size);
    let weight = if m.opt.disabled(disable::GRAVITY) { 0.0 } else { mass * norm(m.opt.gravity) };
    let held = energy.kinetic + energy.elastic.abs() + stored + drift;
    StartEnergy { energy, held, lift: weight * size }
}

/// The diagonal of a box around all bodies and the origin, and the radius of the largest geom that moves, m.
fn size(m: &Model, d: &Fields) -> f64 {
    let along = |k: usize| {
        let ends = rows::<3>(&d.xipos).iter().fold([0.0_f64; 2], |[lo, hi], x| [lo.min(x[k]), hi.max(x[k])]);
        ends[1] - ends[0]
    };
    let radii = m.geom_rbound.iter().zip(&m.geom_bodyid).filter(|&(_, &b)| b > 0).map(|(&r, _)| r);
    norm([0, 1, 2].map(along)) + radii.fold(0.0, f64::max)
}

/// The degree of freedom whose part v (M v) of the kinetic energy is the largest.
fn liveliest(m: &Model, d: &mut Data<Planned>) -> usize {
    let mut momentum = vec![0.0; m.nv];
    let filled = mass_matrix(m, d);
    let qvel = &d.fields().qvel;
    if filled.and_then(|()| mul_m(m, d, qvel, &mut momentum)).is_err() {
        return 0;
    }
    let part = |k: usize| (qvel[k] * momentum[k]).abs();
    (0..qvel.len()).max_by(|&a, &b| part(a).total_cmp(&part(b))).unwrap_or(0)
}

/// Whether forces are applied from outside.
fn applied<S: Scope>(d: &Data<S>) -> bool {
    let d = d.fields();
    d.qfrc_applied.iter().chain(&d.xfrc_applied).any(|&f| f != 0.0)
}

/// Whether something but actuators may feed the scene, or limits of joints and tendons cut what actuators do.
fn fed<S: Scope>(m: &Model, d: &Data<S>) -> bool {
    let some = |list: &[f64]| list.iter().any(|&x| x != 0.0);
    let pushes = |list: &[f64]| list.iter().any(|&x| x < 0.0);
    let wind = some(&m.opt.wind) && (m.opt.density != 0.0 || m.opt.viscosity != 0.0);
    // A joint's own damper is known when it pushes, unless it pulls at other speeds.
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
#[allow(clippy::unwrap_used)]
#[path = "growth_tests.rs"]
mod tests;
