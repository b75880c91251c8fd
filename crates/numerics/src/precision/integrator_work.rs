//! The work of an integrator that the engine does not count.

use labspec::run::Integrator;
use labspec::run::Session;
use labspec_core::{self as core, integrator};

/// The work of an integrator that the engine does not count, for derivatives and their factorization, in units of a forward
/// pass without pairs and constraints. Measured on the standard set (`docs/precision.md`): a constant per step, and a
/// number per degree of freedom.
const IMPLICIT: [f64; 2] = [4.5, 0.2];
const IMPLICITFAST: [f64; 2] = [0.5, 0.02];
const DISCRETE: [f64; 2] = [0.5, 0.016];

/// The work of an integrator per step in addition to its passes, in units of about a nanosecond.
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
