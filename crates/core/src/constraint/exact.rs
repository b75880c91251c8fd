//! The `diagexact` flag: regularization from the diagonal of J M⁻¹ Jᵀ itself, instead of its estimate at `qpos0`.

use super::Scratch;
use super::contact_rows;
use super::jacobian::by_rows;
use super::kind;
use super::rows::{regularization, soften};
use crate::dynamics::mass;
use crate::model::{Fields, Model};

/// Replaces `efc_R` and what follows from it.
pub(super) fn regularize(m: &Model, d: &mut Fields, w: &mut Scratch) {
    for i in 0..w.jac.blocks.len() {
        d.meter.add(u64::from(w.jac.blocks[i].nrow) * (m.nv + 2 * m.nC) as u64);
        if d.meter.over() {
            break;
        }
        let b = w.jac.blocks[i];
        by_rows!(b.nrow, R => block::<R>(m, d, w, i));
    }
}

fn block<const R: usize>(m: &Model, d: &mut Fields, w: &mut Scratch, i: usize) {
    let b = w.jac.blocks[i];
    let row = b.row as usize;
    let (jac, x) = (&w.jac, &mut w.column);
    x.resize(m.nv, 0.0);
    let mut diag = [0.0; R];
    for (r, diag) in diag.iter_mut().enumerate() {
        x.fill(0.0);
        let terms = || jac.columns(&b).iter().zip(jac.values(&b).chunks_exact(R));
        for (&k, v) in terms() {
            x[k as usize] = v[r];
        }
        mass::solve(m, &d.qLD, &d.qLDiagInv, x, 0..m.nv);
        *diag = terms().map(|(&k, v)| v[r] * x[k as usize]).sum();
    }
    let imp = d.efc_KBIP[4 * row + 2];
    let mut r = diag.map(|a| regularization(imp, a));
    let elliptic = d.efc_type[row] == kind::CONTACT_ELLIPTIC;
    if (elliptic || d.efc_type[row] == kind::CONTACT_PYRAMIDAL)
        && let Some(c) = d.contact.get_mut(d.efc_id[row] as usize)
    {
        r = contact_rows::friction(m, c, elliptic, r[0]);
    }
    soften(d, row, imp, &r);
}
