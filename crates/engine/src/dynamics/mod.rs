//! Kinematic trees: poses, velocities, the mass matrix M, its factorization, and the bias force.
//!
//! `tree_algorithms` is the table of algorithms. Each tree uses the first one that its structure allows. The general
//! algorithm computes poses from `qpos` (`kinematics`, `camera`), the centres of mass and the motion axes of the
//! degrees of freedom (`com`), M and its factorization (`mass`, `triangle`), the kinetic energy (`kinetic`), and the bias force, which consists of
//! gravity, Coriolis and centrifugal terms (`rne`). Jacobians map joint velocities to velocities of points
//! (`jacobian`, `object`, `path`).

pub mod camera;
pub mod com;
pub mod jacobian;
pub mod kinematics;
pub(crate) mod kinetic;
pub mod mass;
pub mod object;
pub(crate) mod path;
pub mod reflected;
pub mod rne;
pub mod subtree;
pub mod tree_algorithms;
mod triangle;
pub mod walk;

use crate::model::tree_algorithm::TreeAlgorithms;
use crate::model::{Fields, Model};
use path::Path;
use tree_algorithms::AlgorithmStates;

/// Scratch memory of the stages, allocated once.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct DynamicsScratch {
    /// State of each tree algorithm.
    algorithms: AlgorithmStates,
    /// Whether `qLD` and `qLDiagInv` still have to be computed from the result of another factorization.
    rows_due: bool,
    /// Whether the rows of M are read in this pass.
    needs_mass_rows: bool,
    /// Motion axes of ancestors, for rows of M.
    pub path: Path,
    /// Spatial accelerations and forces of bodies.
    cacc: Vec<f64>,
    cfrc: Vec<f64>,
    /// Motions of bodies, for their kinetic energy.
    motions: Vec<kinetic::BodyMotion>,
    /// A temporary factorization: rows and 1/D.
    pub(crate) ld: Vec<f64>,
    pub(crate) diag_inv: Vec<f64>,
}

impl DynamicsScratch {
    pub(crate) fn new(m: &Model, algorithms: TreeAlgorithms) -> DynamicsScratch {
        DynamicsScratch {
            algorithms: AlgorithmStates::new(m, algorithms),
            rows_due: false,
            needs_mass_rows: true,
            path: Path::new(m),
            cacc: vec![0.0; 6 * m.nbody],
            cfrc: vec![0.0; 6 * m.nbody],
            motions: vec![kinetic::BodyMotion::default(); m.nbody],
            ld: vec![0.0; m.nC],
            diag_inv: vec![0.0; m.nv],
        }
    }
}

/// Poses of bodies, joints, geoms and sites, as `mj_kinematics` computes them.
pub fn kinematics(m: &Model, d: &mut Fields, w: &mut DynamicsScratch) {
    tree_algorithms::forward_kinematics(m, d, w);
    tree_algorithms::orientations(d, w);
    kinematics::geoms(m, d);
    kinematics::sites(m, d);
}
