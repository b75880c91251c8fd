//! The `diagexact` flag: regularization from the exact diagonal of J M⁻¹ Jᵀ instead of its estimate at `qpos0`.

use super::ConstraintScratch;
use super::contact_rows;
use super::kind;
use super::row_counts::MOST_ROWS;
use super::rows::{regularization, soften};
use crate::dynamics::mass;
use crate::model::{Fields, Model};

/// Replaces `efc_R` and the quantities that are derived from it.
pub(super) fn regularize(m: &Model, d: &mut Fields, w: &mut ConstraintScratch) {
    for i in 0..w.jac.blocks.len() {
        d.meter.add(u64::from(w.jac.blocks[i].nrow) * (m.nv + 2 * m.nC) as u64);
        if d.meter.over() {
            break;
        }
        block(m, d, w, i);
    }
}

fn block(m: &Model, d: &mut Fields, w: &mut ConstraintScratch, i: usize) {
    let b = w.jac.blocks[i];
    let row = b.row as usize;
    let (jac, x) = (&w.jac, &mut w.column);
    x.resize(m.nv, 0.0);
    let mut rows = [0.0; MOST_ROWS];
    let rows = &mut rows[..b.nrow as usize];
    let imp = d.efc_KBIP[4 * row + 2];
    for (r, soft) in rows.iter_mut().enumerate() {
        x.fill(0.0);
        for (&k, v) in jac.terms(&b) {
            x[k as usize] = v[r];
        }
        mass::solve(m, &d.qLD, &d.qLDiagInv, x, 0..m.nv);
        *soft = regularization(imp, jac.terms(&b).map(|(&k, v)| v[r] * x[k as usize]).sum());
    }
    let elliptic = d.efc_type[row] == kind::CONTACT_ELLIPTIC;
    if (elliptic || d.efc_type[row] == kind::CONTACT_PYRAMIDAL)
        && let Some(c) = d.contact.get_mut(d.efc_id[row] as usize)
    {
        contact_rows::frictions(m, c, elliptic, rows[0], rows);
    }
    soften(d, row, imp, rows);
}
