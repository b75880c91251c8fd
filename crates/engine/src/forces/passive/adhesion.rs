//! Adhesive contacts: a constant attractive force along the normal of every detected contact.

use crate::dynamics::jacobian;
use crate::math::*;
use crate::model::{Fields, Model};

/// Computes `qfrc_adhesion`.
pub(super) fn adhesion(m: &Model, d: &mut Fields) {
    let mut out = std::mem::take(&mut d.qfrc_adhesion);
    out.fill(0.0);
    for c in d.contact.iter().filter(|c| c.adhesion != 0.0) {
        let pull = scale([c.frame[0], c.frame[1], c.frame[2]], c.adhesion);
        for (geom, sign) in [(c.geom1, 1.0), (c.geom2, -1.0)] {
            let body = m.geom_bodyid[geom] as usize;
            jacobian::apply(m, d, body, c.pos, scale(pull, sign), [0.0; 3], &mut out);
        }
    }
    d.qfrc_adhesion = out;
}
