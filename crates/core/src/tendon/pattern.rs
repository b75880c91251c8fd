//! What follows from the structure of tendons: where their Jacobians can be non-zero, and which trees they tie.

use super::is_fixed;
use crate::model::wraptype;
use crate::{Model, jacobian};

/// `ten_J_rownnz`, `ten_J_rowadr`, `ten_J_colind`, `nJten`, `tendon_treenum` and `tendon_treeid`.
///
/// A tendon's Jacobian is non-zero at most where something on its path moves. `None` when that would be more
/// than `most` entries.
pub(crate) fn set_pattern(m: &mut Model, most: usize) -> Option<()> {
    m.ten_J_colind.clear();
    for t in 0..m.ntendon {
        let start = m.ten_J_colind.len();
        let dofs = moving(m, t);
        let mut trees: Vec<i32> = dofs.iter().map(|&k| m.dof_treeid[k as usize]).collect();
        trees.dedup(); // degrees of freedom of a tree are consecutive
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

/// The degrees of freedom that move something on the path of tendon `t`, ascending.
fn moving(m: &Model, t: usize) -> Vec<i32> {
    let first = m.tendon_adr[t] as usize;
    let path = first..first + m.tendon_num[t] as usize;
    let mut dofs: Vec<i32> = Vec::new();
    if is_fixed(m, t) {
        dofs.extend(path.map(|w| m.jnt_dofadr[m.wrap_objid[w] as usize]));
    } else {
        let body = |w: usize| match m.wrap_type[w] {
            wraptype::PULLEY => None,
            wraptype::SITE => Some(m.site_bodyid[m.wrap_objid[w] as usize] as usize),
            _ => Some(m.geom_bodyid[m.wrap_objid[w] as usize] as usize),
        };
        let mut bodies: Vec<usize> = path.filter_map(body).collect();
        bodies.sort_unstable();
        bodies.dedup();
        for b in bodies {
            let mut k = jacobian::last_dof(m, b);
            while k >= 0 {
                dofs.push(k);
                k = m.dof_parentid[k as usize];
            }
        }
    }
    dofs.sort_unstable();
    dofs.dedup();
    dofs
}
