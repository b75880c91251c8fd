//! Adhesion: a force between a body and all bodies that it has contacts with.

use super::MomentRows;
use crate::dynamics::jacobian;
use crate::forces::ForceScratch;
use crate::kinds::exclude;
use crate::model::{Fields, Model};

/// The moment of an adhesion actuator: the mean separation direction over the contacts of body `b`, with the sign of an
/// attractive force. The length is zero.
pub(super) fn adhesion(m: &Model, d: &Fields, b: usize, w: &mut ForceScratch, out: &mut MomentRows) -> f64 {
    let ForceScratch { moment: dense, columns, .. } = w;
    dense.fill(0.0);
    let mut count = 0;
    for contact in &d.contact {
        let bodies = [contact.geom1, contact.geom2].map(|g| m.geom_bodyid[g] as usize);
        // Contacts in the gap are included. Contacts that no degree of freedom affects are not.
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
