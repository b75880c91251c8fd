//! The state of a lab at its start.

use labspec::bind::Programs;
use labspec::run::{Session, Start};
use labspec::spec::Lab;
use labspec_core::{Model, Plan};

/// The plan of a lab at its start, and its model after setup and controls.
pub(super) fn plan_at_start(lab: &Lab, model: &Model, programs: &Programs) -> (Plan, Model) {
    let session = Session::start(programs, model, Start::of_lab(lab));
    (session.world.data.plan(), session.world.model)
}
