//! The sleep policy of each tree.

use super::inertia::describe_body;
use crate::kinds::trntype;
use crate::mjcf::layout::TreeLayout;
use crate::mjcf::rules;
use crate::mjcf::spec::BodySpec;
use crate::mjcf::text::diagnostic::Diagnostics;
use crate::model::Model;
use crate::model::asleep::policy;

/// Reports a `sleep` attribute at a body that is not the first moving body of a tree.
pub(crate) fn check_policies(bodies: &[BodySpec], layout: &TreeLayout, report: &mut Diagnostics) {
    for body in bodies.iter().skip(1).filter(|b| b.sleep != 0) {
        let carried = layout.body_tree.get(body.parent).is_some_and(|&t| t >= 0);
        if carried || body.joints.is_empty() {
            let what = if carried { "is carried by a moving body" } else { "cannot move" };
            report
                .error(
                    rules::JOINT,
                    body.span.clone(),
                    format!("{} has `sleep`, but it {what}", describe_body(body)),
                )
                .why("a tree falls asleep as a whole, and its first moving body decides")
                .help("move `sleep` to that body");
        }
    }
}

/// Fills `tree_sleep_policy`. An explicit `sleep` takes precedence. Otherwise a tree may sleep unless actuators move it, or a
/// tendon connects it to more than one other tree, or to one other tree with a spring or a damper.
pub(crate) fn policies(m: &mut Model, bodies: &[BodySpec]) {
    let mut policies = vec![policy::AUTO_ALLOWED; m.ntree];
    let mut keep_awake = |tree: i32| {
        if let Some(p) = usize::try_from(tree).ok().and_then(|t| policies.get_mut(t)) {
            *p = policy::AUTO_NEVER;
        }
    };
    for t in 0..m.ntendon {
        let forces = m.tendon_stiffness[t] != 0.0
            || m.tendon_damping[t] != 0.0
            || m.tendon_stiffnesspoly[2 * t..2 * t + 2] != [0.0; 2]
            || m.tendon_dampingpoly[2 * t..2 * t + 2] != [0.0; 2];
        if m.tendon_treenum[t] > if forces { 1 } else { 2 } {
            trees_of_tendon(m, t).for_each(&mut keep_awake);
        }
    }
    for a in 0..m.nactuator {
        let ids = [m.actuator_trnid[2 * a], m.actuator_trnid[2 * a + 1]];
        let ids = ids.into_iter().filter_map(|id| usize::try_from(id).ok());
        match m.actuator_trntype[a] {
            trntype::TENDON => ids.take(1).for_each(|t| trees_of_tendon(m, t).for_each(&mut keep_awake)),
            kind @ (trntype::SITE | trntype::SLIDERCRANK | trntype::SO3)
                if kind != trntype::SO3 || m.actuator_trnid[2 * a + 1] >= 0 =>
            {
                ids.for_each(|s| keep_awake(m.body_treeid[m.site_bodyid[s] as usize]));
            }
            trntype::BODY => ids.take(1).for_each(|b| keep_awake(m.body_treeid[b])),
            _ => ids.take(1).for_each(|j| keep_awake(m.body_treeid[m.jnt_bodyid[j] as usize])),
        }
    }
    for (body, &tree) in bodies.iter().zip(&m.body_treeid) {
        if let (1.., Some(p)) = (body.sleep, usize::try_from(tree).ok().and_then(|t| policies.get_mut(t))) {
            *p = policy::NEVER + body.sleep - 1;
        }
    }
    m.tree_sleep_policy = policies;
}

/// The trees with degrees of freedom on which the length of a tendon depends.
fn trees_of_tendon(m: &Model, t: usize) -> impl Iterator<Item = i32> {
    let start = m.ten_J_rowadr[t] as usize;
    m.ten_J_colind[start..start + m.ten_J_rownnz[t] as usize].iter().map(|&k| m.dof_treeid[k as usize])
}
