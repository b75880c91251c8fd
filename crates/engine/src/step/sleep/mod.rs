//! Sleeping: trees at rest are not simulated until something disturbs them.
//!
//! See MuJoCo's documentation, "Computation: Sleeping islands"; details measured on MuJoCo 3.14.0. An island of trees whose
//! degrees of freedom are slower than `opt.sleep_tolerance` for [`SLOW_STEPS`] steps falls asleep. Its velocity becomes zero, its
//! positions do not change, its smooth forces and accelerations keep their values, and no constraint acts on it. It wakes as a
//! whole when its state or the forces applied to it change, or when a contact, an equality or a tendon at its limit connects it
//! to an awake tree.

mod rest;
mod wake;

use std::ops::Range;

use crate::constraint;
use crate::kinds::joint;
use crate::model::asleep::{self, awake, policy};
use crate::model::{Fields, Model};

pub(crate) use rest::{fall_asleep, freeze_sleeping_trees, keep, put_back};
pub(crate) use wake::{wake, wake_by_equalities, wake_by_tendons, wake_touched};

/// The number of steps for which a tree must be slow.
const SLOW_STEPS: i32 = 10;
/// `tree_asleep` of a tree that was not slow in the last step. The value counts up to -1. The value of a sleeping tree is the
/// index of the next tree of those that fell asleep together, which form a cycle.
const AWAKE: i32 = -(1 + SLOW_STEPS);

/// The memory of the stage between steps, and its scratch.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct SleepScratch {
    /// Coordinates at the last position stage.
    seen: Vec<f64>,
    /// Smooth forces and accelerations, saved to restore those of sleeping trees.
    qfrc_smooth: Vec<f64>,
    qacc_smooth: Vec<f64>,
    act_dot: Vec<f64>,
    /// The positions at the start of a step, and its acceleration.
    pub(in crate::step) start: Vec<f64>,
    pub(in crate::step) acceleration: Vec<f64>,
    /// Whether there was no forward pass since the reset.
    fresh: bool,
}

impl SleepScratch {
    pub(crate) fn new(m: &Model) -> SleepScratch {
        let (q, v, a) = (vec![0.0; m.nq], vec![0.0; m.nv], vec![0.0; m.na]);
        SleepScratch {
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

/// Whether there was no forward pass since the reset. Another plan may then change whether trees start asleep.
pub(crate) fn is_fresh(w: &SleepScratch) -> bool {
    w.fresh
}

/// Records that a forward pass was made.
pub(crate) fn passed(w: &mut SleepScratch) {
    w.fresh = false;
}

/// The coordinates of a tree.
fn coordinates(m: &Model, tree: usize) -> Range<usize> {
    let dofs = m.tree_dofs(tree);
    let joint = |k: usize| m.dof_jntid[k] as usize;
    let (first, last) = (joint(dofs.start), joint(dofs.end - 1));
    m.jnt_qposadr[first] as usize..m.jnt_qposadr[last] as usize + joint::nq(m.jnt_type[last])
}

/// Computes `tree_awake`, `body_awake` and the counts from `tree_asleep`.
pub(crate) fn update(m: &Model, d: &mut Fields) {
    for (awake, asleep) in d.tree_awake.iter_mut().zip(&d.tree_asleep) {
        *awake = i32::from(*asleep < 0);
    }
    (d.nbody_awake, d.nparent_awake) = (0, 0);
    for b in 0..m.nbody {
        d.body_awake[b] = match usize::try_from(m.body_treeid[b]) {
            Ok(tree) if d.tree_awake[tree] == 0 => awake::NO,
            Ok(_) => awake::YES,
            // Mocap bodies may be moved by the user at any time.
            Err(_) if m.body_mocapid[m.body_rootid[b] as usize] >= 0 => awake::YES,
            Err(_) => awake::STATIC,
        };
        let parent = d.body_awake[m.body_parentid[b] as usize];
        d.nbody_awake += usize::from(d.body_awake[b] != awake::NO);
        d.nparent_awake += usize::from(b > 0 && parent != awake::NO);
    }
    let of_awake = |&&tree: &&i32| d.tree_awake[tree as usize] != 0;
    d.nv_awake = m.dof_treeid.iter().filter(of_awake).count();
    d.ntree_awake = d.tree_awake.iter().filter(|&&a| a != 0).count();
}

/// Wakes all trees. Returns `true` if some start asleep: the caller must then make a forward pass for the initial state, after
/// which [`start`] puts them to sleep.
pub(crate) fn wake_all(m: &Model, d: &mut Fields) -> bool {
    d.tree_asleep.fill(AWAKE);
    update(m, d);
    asleep::on(m, d) && m.tree_sleep_policy.contains(&policy::INIT)
}

/// Puts the trees to sleep that start asleep, without forces, accelerations and contacts. The accelerations of the other trees
/// are zero too.
pub(crate) fn start(m: &Model, d: &mut Fields, c: &mut constraint::ConstraintScratch) {
    for (asleep, &policy) in d.tree_asleep.iter_mut().zip(&m.tree_sleep_policy) {
        // These trees are ready to sleep. Their island determines whether they may sleep together with the trees that they touch.
        *asleep = if policy == policy::INIT { -1 } else { AWAKE };
    }
    fall_asleep(m, d, &c.islands);
    for v in [&mut d.qfrc_smooth, &mut d.qacc_smooth, &mut d.qacc, &mut d.act_dot] {
        v.fill(0.0);
    }
    constraint::none(d, c);
    update(m, d);
}

/// Starts again from the current state.
pub(crate) fn begin(d: &Fields, w: &mut SleepScratch) {
    w.seen.copy_from_slice(&d.qpos);
    w.fresh = true;
}
