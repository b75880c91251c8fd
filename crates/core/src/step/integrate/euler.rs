//! Semi-implicit Euler.

use super::{Slopes, advance, advance_along};
use crate::model::Model;
use crate::step::damping::{damp, damps};
use crate::step::workspace::Workspace;

/// v += h a, then q advances with the new v. Joint damping is implicit, so that it is stable however stiff:
/// (M + h B) a' = M a, where B is the derivative of the damping force.
#[cfg_attr(not(feature = "small"), inline(always))]
pub(super) fn euler(m: &Model, d: &mut Workspace) {
    if damps(m, d) {
        damped(m, d);
    } else {
        advance(m, d, Slopes::default());
    }
}

#[cfg_attr(not(feature = "small"), inline(never))]
fn damped(m: &Model, d: &mut Workspace) {
    if !d.work.damping.done {
        damp(m, &d.fields, &mut d.work.dynamics, &mut d.work.damping);
    }
    advance_along(m, d);
}
