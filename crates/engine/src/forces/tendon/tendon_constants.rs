//! The constants of tendons that `mj_setConst` computes.

use super::row;
use crate::dynamics::mass;
use crate::math::*;
use crate::model::{Fields, Model};

/// Computes `tendon_length0` and `tendon_invweight0` = J M⁻¹ Jᵀ, with `d` in the default configuration.
pub fn at_default(m: &mut Model, d: &Fields) {
    m.tendon_length0.copy_from_slice(&d.ten_length);
    let mut x = vec![0.0; m.nv];
    for t in 0..m.ntendon {
        let row = row(m, t);
        let (dofs, values) = (&m.ten_J_colind[row.clone()], &d.ten_J[row]);
        x.fill(0.0);
        for (&k, j) in dofs.iter().zip(values) {
            x[k as usize] = *j;
        }
        mass::solve(m, &d.qLD, &d.qLDiagInv, &mut x, 0..m.nv);
        m.tendon_invweight0[t] = dofs.iter().zip(values).map(|(&k, j)| j * x[k as usize]).sum();
    }
}

/// Sets `tendon_lengthspring` of tendons with the value -1 -1, with `d` in the configuration in which joint springs are relaxed.
pub fn at_rest(m: &mut Model, d: &Fields) {
    for (spring, &length) in rows_mut::<2>(&mut m.tendon_lengthspring).iter_mut().zip(&d.ten_length) {
        if *spring == [-1.0; 2] {
            *spring = [length; 2];
        }
    }
}
