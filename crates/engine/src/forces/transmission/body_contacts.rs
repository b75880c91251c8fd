//! Adhesion: a force between a body and all that it touches.

use super::Rows;
use crate::dynamics::jacobian;
use crate::forces::Scratch;
use crate::kinds::exclude;
use crate::model::{Fields, Model};

/// The mean over the contacts of body `b` of the direction in which they separate, as a force that pulls; it has no
/// length.
pub(super) fn adhesion(m: &Model, d: &Fields, b: usize, w: &mut Scratch, out: &mut Rows) -> f64 {
    let Scratch { moment: dense, columns, .. } = w;
    dense.fill(0.0);
    let mut count = 0;
    for contact in &d.contact {
        let bodies = [contact.geom1, contact.geom2].map(|g| m.geom_bodyid[g] as usize);
        // Those that are detected in the gap count, those that move nothing do not.
        if !bodies.contains(&b) || contact.exclude > exclude::IN_GAP {
            continue;
        }
        count += 1;
        jacobian::point_difference(m, d, bodies, contact.pos, &contact.frame, columns);
        for (&k, v) in columns.dofs().iter().zip(columns.values()) {
            dense[k as usize] += v[0];
        }
    }
    if count > 0 {
        let mean = -1.0 / f64::from(count);
        for (k, x) in dense.iter().enumerate() {
            out.push(k, x * mean);
        }
    }
    0.0
}
