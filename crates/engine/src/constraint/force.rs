//! Contact forces in the contact frame.

use crate::kinds::cone;
use crate::model::{Contact, Fields, Model};

/// Force (N) and torque (N m) of a contact in the contact frame: normal, two tangents, then three torques
/// (`mj_contactForce`). Zero if the contact has no constraint rows.
pub fn contact_force(m: &Model, d: &Fields, contact: &Contact) -> [f64; 6] {
    let mut out = [0.0; 6];
    let Some(force) = contact.efc_address.and_then(|row| d.efc_force.get(row..)) else { return out };
    if contact.dim == 1 || m.opt.cone != cone::PYRAMIDAL {
        for (out, f) in out.iter_mut().zip(force).take(contact.dim) {
            *out = *f;
        }
    } else {
        // Each edge of a pyramid pushes along n ± μ t.
        for (k, edges) in force.chunks_exact(2).take(contact.dim.saturating_sub(1).min(5)).enumerate() {
            out[0] += edges[0] + edges[1];
            out[1 + k] = (edges[0] - edges[1]) * contact.friction[k];
        }
    }
    // The adhesion force reduces the normal force.
    out[0] -= contact.adhesion;
    out
}
