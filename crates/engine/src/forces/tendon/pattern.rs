//! Constants of tendons that depend on the structure only: the sparsity pattern of their Jacobians, and the trees that they
//! connect.

use super::is_fixed;
use crate::dynamics::walk;
use crate::kinds::wraptype;
use crate::model::Model;
use labspec_finding::order;

/// Computes `ten_J_rownnz`, `ten_J_rowadr`, `ten_J_colind`, `nJten`, `tendon_treenum` and `tendon_treeid`.
///
/// The Jacobian of a tendon can be non-zero only for degrees of freedom that move objects on its path. `None` if there would be
/// more than `most` entries.
pub fn set_pattern(m: &mut Model, most: usize) -> Option<()> {
    m.ten_J_colind.clear();
    for t in 0..m.ntendon {
        let start = m.ten_J_colind.len();
        let dofs = moving(m, t);
        let trees = trees(m, t);
        m.tendon_treenum[t] = trees.len() as i32;
        for (i, slot) in m.tendon_treeid[2 * t..2 * t + 2].iter_mut().enumerate() {
            *slot = trees.get(i).copied().unwrap_or(-1);
        }
        m.ten_J_colind.extend(dofs);
        if m.ten_J_colind.len() > most {
            return None;
        }
        m.ten_J_rowadr[t] = start as i32;
        m.ten_J_rownnz[t] = (m.ten_J_colind.len() - start) as i32;
    }
    m.nJten = m.ten_J_colind.len();
    Some(())
}

/// The bodies on the path of tendon `t`, in order: those of its joints, sites and geoms.
fn bodies(m: &Model, t: usize) -> impl Iterator<Item = usize> + '_ {
    let first = m.tendon_adr[t] as usize;
    let body = |w: usize| {
        let object = m.wrap_objid[w] as usize;
        match m.wrap_type[w] {
            wraptype::PULLEY => None,
            wraptype::JOINT => Some(m.jnt_bodyid[object] as usize),
            wraptype::SITE => Some(m.site_bodyid[object] as usize),
            _ => Some(m.geom_bodyid[object] as usize),
        }
    };
    (first..first + m.tendon_num[t] as usize).filter_map(body)
}

/// The trees that tendon `t` connects, in the order of its path.
fn trees(m: &Model, t: usize) -> Vec<i32> {
    let mut met = Vec::new();
    for tree in bodies(m, t).map(|b| m.body_treeid[b]) {
        if tree >= 0 && !met.contains(&tree) {
            met.push(tree);
        }
    }
    met
}

/// The degrees of freedom that move objects on the path of tendon `t`, ascending.
fn moving(m: &Model, t: usize) -> Vec<i32> {
    let mut dofs: Vec<i32> = Vec::new();
    if is_fixed(m, t) {
        let first = m.tendon_adr[t] as usize;
        let joints = &m.wrap_objid[first..first + m.tendon_num[t] as usize];
        dofs.extend(joints.iter().map(|&j| m.jnt_dofadr[j as usize]));
    } else {
        let mut bodies: Vec<usize> = bodies(m, t).collect();
        order::sort_by(&mut bodies, Ord::cmp);
        bodies.dedup();
        dofs.extend(bodies.into_iter().flat_map(|b| walk::moving(m, b)).map(|k| k as i32));
    }
    order::sort_by(&mut dofs, Ord::cmp);
    dofs.dedup();
    dofs
}
