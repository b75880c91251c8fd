//! Iteration from bodies to the root: the degrees of freedom that move a body, or one or both of two bodies.

use crate::model::Model;

/// The last degree of freedom that moves body `b`; -1 if the body cannot move.
#[cfg_attr(not(feature = "small"), inline(always))]
pub fn last_dof(m: &Model, b: usize) -> i32 {
    let w = m.body_weldid[b] as usize;
    m.body_dofadr[w] + m.body_dofnum[w] - i32::from(m.body_dofnum[w] > 0)
}

/// A degree of freedom and its ancestors, up to the root; empty for -1.
pub fn upward(m: &Model, dof: i32) -> impl Iterator<Item = usize> + '_ {
    let some = |k: i32| usize::try_from(k).ok();
    std::iter::successors(some(dof), move |&k| some(m.dof_parentid[k]))
}

/// The degrees of freedom that move a body, in descending order.
pub(crate) fn moving(m: &Model, body: usize) -> impl Iterator<Item = usize> + '_ {
    upward(m, last_dof(m, body))
}

/// The bodies, of two, that a degree of freedom moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Side {
    First,
    Second,
    Both,
}

/// The degrees of freedom that move at least one of two bodies, in descending order. Those that move both come last.
pub(crate) fn moving_either(m: &Model, bodies: [usize; 2]) -> impl Iterator<Item = (usize, Side)> + '_ {
    let mut last = bodies.map(|b| last_dof(m, b));
    std::iter::from_fn(move || {
        // The chain with the larger degree of freedom moves up.
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

/// The degrees of freedom that move exactly one of two bodies, in descending order, each with the index (0 or 1) of
/// this body.
pub(crate) fn moving_one(m: &Model, bodies: [usize; 2]) -> impl Iterator<Item = (usize, usize)> + '_ {
    moving_either(m, bodies).map_while(|(k, side)| match side {
        Side::First => Some((k, 0)),
        Side::Second => Some((k, 1)),
        Side::Both => None,
    })
}
