//! A lab as it starts.

use crate::bind::Programs;
use crate::run::{Budget, Session};
use crate::spec::Lab;
use labspec_core::{Model, Plan};

/// The plan of a lab as it starts, and its model then: its setup and its controls have been applied.
pub(super) fn plan_at_start(lab: &Lab, model: &Model, programs: &Programs) -> (Plan, Model) {
    let session = Session::start_within(programs, model, lab.keyframe(), &programs.demand, Budget::ASKED);
    (session.world.data.plan(), session.world.model)
}
