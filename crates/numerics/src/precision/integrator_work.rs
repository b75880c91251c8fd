//! The work of an integrator that the engine does not count.

use labspec::run::Integrator;
use labspec::run::Session;
use labspec_core::{self as core, integrator};

/// What an integrator adds to a step without being counted by the engine: derivatives and their factors, in parts of a forward pass
/// without pairs and constraints. Measured on the standard set (`docs/precision.md`): a number for the step, and one for each degree
/// of freedom.
const IMPLICIT: [f64; 2] = [4.5, 0.2];
const IMPLICITFAST: [f64; 2] = [0.5, 0.02];
const DISCRETE: [f64; 2] = [0.5, 0.016];

/// The work of a step of an integrator beyond its passes, in units of about a nanosecond.
pub(super) fn integrator_work(session: &Session<'_>, method: Integrator) -> f64 {
    let [step, each] = match method.id {
        integrator::IMPLICIT => IMPLICIT,
        integrator::IMPLICITFAST => IMPLICITFAST,
        integrator::DISCRETE => DISCRETE,
        _ => return 0.0,
    };
    let world = &session.world;
    (step + each * world.model.nv as f64) * core::cost_of_pass(&world.data) as f64
}
