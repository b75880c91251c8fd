//! Monitors of runs: parts of a model that are too stiff for its timestep, and runs that fail silently. Each failure has its
//! own file; `watch` combines those of every run. [`stress`] has the monitors of runs that test a lab.
//!
//! They run after every step and do not modify the run. They use the engine only, neither the language nor lessons.

pub mod growth;
pub mod limits;
pub mod stability;
pub mod stress;
pub mod sunk;
pub mod through;
pub mod unsolved;
pub mod watch;

use labspec_core::{Model, joint};

/// Whether a degree of freedom is a translation.
pub fn slides(m: &Model, dof: usize) -> bool {
    let Some(&j) = m.dof_jntid.get(dof) else { return true };
    let first = m.jnt_dofadr.get(j as usize).map_or(0, |&a| a as usize);
    match m.jnt_type.get(j as usize) {
        Some(&joint::SLIDE) => true,
        Some(&joint::FREE) => dof < first + 3,
        _ => false,
    }
}
