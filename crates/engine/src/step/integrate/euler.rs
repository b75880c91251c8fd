//! The semi-implicit Euler method.

use super::{RateOverrides, advance, advance_along};
use crate::model::{Fields, Model};
use crate::step::damping::{damp, damps};
use crate::step::workspace::StepScratch;

/// v += h a, then q advances with the new v. Joint damping is implicit, so that the step is stable for any damping coefficient:
/// (M + h B) a' = M a, where B is the derivative of the damping force.
#[cfg_attr(not(feature = "small"), inline(always))]
pub(super) fn euler(m: &Model, d: &mut Fields, s: &mut StepScratch) {
    if damps(m, d) {
        damped(m, d, s);
    } else {
        advance(m, d, s, RateOverrides::default());
    }
}

#[cfg_attr(not(feature = "small"), inline(never))]
fn damped(m: &Model, d: &mut Fields, s: &mut StepScratch) {
    if !s.damping.done {
        damp(m, d, s);
    }
    advance_along(m, d, s);
}
