//! Walks from bodies up to the root: which degrees of freedom move a body, or one of two and not the other.

use crate::model::Model;

/// Last degree of freedom that moves body `b`, -1 when it cannot move.
#[cfg_attr(not(feature = "small"), inline(always))]
pub fn last_dof(m: &Model, b: usize) -> i32 {
    let w = m.body_weldid[b] as usize;
    m.body_dofadr[w] + m.body_dofnum[w] - i32::from(m.body_dofnum[w] > 0)
}

/// A degree of freedom and those that move it, up to the root; none of -1.
pub fn upward(m: &Model, dof: i32) -> impl Iterator<Item = usize> + '_ {
    let some = |k: i32| usize::try_from(k).ok();
    std::iter::successors(some(dof), move |&k| some(m.dof_parentid[k]))
}

/// The degrees of freedom that move a body, the last first.
pub(crate) fn moving(m: &Model, body: usize) -> impl Iterator<Item = usize> + '_ {
    upward(m, last_dof(m, body))
}

/// Which of two bodies a degree of freedom moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Side {
    First,
    Second,
    Both,
}

/// The degrees of freedom that move either of two bodies, the last first. Those that move both come after all others.
pub(crate) fn moving_either(m: &Model, bodies: [usize; 2]) -> impl Iterator<Item = (usize, Side)> + '_ {
    let mut last = bodies.map(|b| last_dof(m, b));
    std::iter::from_fn(move || {
        // The walk that has reached less far up goes on.
        let k = last[0].max(last[1]);
        let dof = usize::try_from(k).ok()?;
        let side = match (last[0] == k, last[1] == k) {
            (true, true) => Side::Both,
            (true, false) => Side::First,
            _ => Side::Second,
        };
        for l in &mut last {
            if *l == k {
                *l = m.dof_parentid[dof];
            }
        }
        Some((dof, side))
    })
}

/// The degrees of freedom that move one of two bodies and not the other, the last first: which, and 0 or 1 for the body.
pub(crate) fn moving_one(m: &Model, bodies: [usize; 2]) -> impl Iterator<Item = (usize, usize)> + '_ {
    moving_either(m, bodies).map_while(|(k, side)| match side {
        Side::First => Some((k, 0)),
        Side::Second => Some((k, 1)),
        Side::Both => None,
    })
}
