//! Trees of bodies: where they are, how they move, M, its factorization and the bias force.
//!
//! `tree_algorithms` is the table of algorithms: each tree takes the first that its structure allows. The general one gives poses from
//! `qpos` (`kinematics`, `camera`), the centres of mass and the axes along which degrees of freedom move (`com`), M and its
//! factorization (`mass`, `triangle`), and the force of gravity, Coriolis and centrifugal terms (`rne`). Points of bodies move as
//! their Jacobians say (`jacobian`, `object`, `path`).

pub mod camera;
pub mod com;
pub mod jacobian;
pub mod kinematics;
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

/// What these stages keep from one to the next, so that they do not allocate.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Scratch {
    /// What each tree algorithm keeps of its trees.
    algorithms: AlgorithmStates,
    /// Whether `qLD` and `qLDiagInv` are still to be made of what a factorization has left.
    rows_due: bool,
    /// Whether somebody looks at the rows of M now.
    rows_wanted: bool,
    /// Motions of ancestors, for rows of M.
    pub path: Path,
    /// Spatial accelerations and forces of bodies.
    cacc: Vec<f64>,
    cfrc: Vec<f64>,
    /// A factorization that is nobody's: rows and 1/D.
    pub(crate) ld: Vec<f64>,
    pub(crate) diag_inv: Vec<f64>,
}

impl Scratch {
    pub(crate) fn new(m: &Model, algorithms: TreeAlgorithms) -> Scratch {
        Scratch {
            algorithms: AlgorithmStates::new(m, algorithms),
            rows_due: false,
            rows_wanted: true,
            path: Path::new(m),
            cacc: vec![0.0; 6 * m.nbody],
            cfrc: vec![0.0; 6 * m.nbody],
            ld: vec![0.0; m.nC],
            diag_inv: vec![0.0; m.nv],
        }
    }
}

/// Poses of bodies, joints, geoms and sites, as `mj_kinematics` computes them.
pub fn kinematics(m: &Model, d: &mut Fields, w: &mut Scratch) {
    tree_algorithms::forward_kinematics(m, d, w);
    tree_algorithms::orientations(d, w);
    kinematics::geoms(m, d);
    kinematics::sites(m, d);
}
