//! Sleeping: trees at rest are not simulated until something disturbs them.
//!
//! MuJoCo's documentation, "Computation: Sleeping islands"; details measured on MuJoCo 3.14.0. An island of trees whose
//! degrees of freedom are slower than `opt.sleep_tolerance` for [`PATIENCE`] steps falls asleep: its velocity becomes zero,
//! it does not move, its smooth forces and accelerations stay what they were, and no constraint acts on it. It wakes as a
//! whole when its state or the forces applied to it change, or when a contact, an equality or a tendon at its limit ties it
//! to a tree that is awake.

mod rest;
mod state;
mod wake;

use std::ops::Range;

use crate::model::reflect::Stage;
use crate::step::forward;
use crate::{Data, Model, constraint, enable, joint};

pub(crate) use rest::{advance, keep, put_back};
pub(crate) use state::{
    actuator_sleeps, body_sleeps, equality_sleeps, pair_sleeps, sensor_sleeps, tendon_sleeps, tree_sleeps,
};
pub(crate) use wake::{wake, wake_by_equalities, wake_by_tendons, wake_touched};

/// Steps that a tree has to be slow for.
const PATIENCE: i32 = 10;
/// `tree_asleep` of a tree that was not slow in the last step. It counts up to -1; where it sleeps it is the next tree of
/// those that fell asleep together, which form a circle.
const AWAKE: i32 = -(1 + PATIENCE);

/// Values of `tree_sleep_policy`.
pub(crate) mod policy {
    pub(crate) const AUTO_NEVER: i32 = 1;
    pub(crate) const AUTO_ALLOWED: i32 = 2;
    /// The first of the three that an author can choose: never, allowed, asleep at the start.
    pub(crate) const NEVER: i32 = 3;
    pub(crate) const INIT: i32 = 5;
}

/// Values of `body_awake` (mjtSleepState).
pub(crate) mod awake {
    pub(crate) const STATIC: i32 = -1;
    pub(crate) const NO: i32 = 0;
    pub(crate) const YES: i32 = 1;
}

/// What the stage keeps from one step to the next, and scratch.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Work {
    /// Coordinates of the last position stage, and of the start of the step.
    seen: Vec<f64>,
    start: Vec<f64>,
    /// What of a sleeping tree stays as it was.
    qfrc_smooth: Vec<f64>,
    qacc_smooth: Vec<f64>,
    act_dot: Vec<f64>,
    /// The acceleration of this step.
    acceleration: Vec<f64>,
    /// Whether there has been no forward pass since the reset.
    fresh: bool,
}

impl Work {
    pub(crate) fn new(m: &Model) -> Work {
        let (q, v, a) = (vec![0.0; m.nq], vec![0.0; m.nv], vec![0.0; m.na]);
        Work {
            seen: q.clone(),
            start: q,
            qfrc_smooth: v.clone(),
            qacc_smooth: v.clone(),
            acceleration: v,
            act_dot: a,
            fresh: true,
        }
    }
}

/// Whether trees may sleep now.
#[inline(always)]
pub(crate) fn on(m: &Model, d: &Data) -> bool {
    d.plan.keeps(Stage::Sleep) && m.opt.enabled(enable::SLEEP)
}

/// Whether some tree sleeps.
#[inline(always)]
fn some(m: &Model, d: &Data) -> bool {
    d.ntree_awake < m.ntree
}

/// Before the first forward pass another plan may let trees start asleep, or not.
pub(crate) fn plan_changed(m: &Model, d: &mut Data) {
    if d.work.sleep.fresh {
        reset(m, d);
    }
}

/// After a forward pass.
pub(crate) fn passed(d: &mut Data) {
    d.work.sleep.fresh = false;
}

/// Degrees of freedom of a tree.
fn dofs(m: &Model, tree: usize) -> Range<usize> {
    let first = m.tree_dofadr[tree] as usize;
    first..first + m.tree_dofnum[tree] as usize
}

/// Coordinates of a tree.
fn coordinates(m: &Model, tree: usize) -> Range<usize> {
    let dofs = dofs(m, tree);
    let joint = |k: usize| m.dof_jntid[k] as usize;
    let (first, last) = (joint(dofs.start), joint(dofs.end - 1));
    m.jnt_qposadr[first] as usize..m.jnt_qposadr[last] as usize + joint::nq(m.jnt_type[last])
}

/// All trees are awake, but those that start asleep where sleeping is on: then the others are at rest, too. What
/// sleeps shows what a forward pass makes of the start, without forces, accelerations and contacts.
pub(crate) fn reset(m: &Model, d: &mut Data) {
    d.tree_asleep.fill(AWAKE);
    state::update(m, d);
    if on(m, d) && m.tree_sleep_policy.contains(&policy::INIT) {
        forward::forward(m, d);
        for (asleep, &policy) in d.tree_asleep.iter_mut().zip(&m.tree_sleep_policy) {
            // Those are ready; whether they may sleep together with what they touch, their island decides.
            *asleep = if policy == policy::INIT { -1 } else { AWAKE };
        }
        rest::fall_asleep(m, d);
        for v in [&mut d.qfrc_smooth, &mut d.qacc_smooth, &mut d.qacc, &mut d.act_dot] {
            v.fill(0.0);
        }
        constraint::none(d);
        state::update(m, d);
    }
    d.work.sleep.seen.copy_from_slice(&d.qpos);
    d.work.sleep.fresh = true;
}
