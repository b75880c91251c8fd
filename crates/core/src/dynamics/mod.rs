//! Trees of bodies: where they are, how they move, M, its factorization and the bias force.
//!
//! Forward kinematics gives poses from `qpos` (`kinematics`, `camera`), the centres of mass and the axes along which
//! degrees of freedom move (`com`). From them come M (`mass`), its factorization (`mass`, `serial`, `articulated`) and the
//! force of gravity, Coriolis and centrifugal terms (`rne`). Trees of a few slides and hinges have both in closed form
//! (`chain`). Points of bodies move as their Jacobians say (`jacobian`, `object`, `path`).

pub(crate) mod articulated;
pub(crate) mod camera;
pub(crate) mod chain;
pub(crate) mod com;
pub(crate) mod jacobian;
pub(crate) mod kinematics;
pub(crate) mod mass;
pub(crate) mod object;
pub(crate) mod path;
pub(crate) mod rne;
pub(crate) mod serial;
pub(crate) mod subtree;
