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
pub(crate) mod reflected;
pub(crate) mod rne;
pub(crate) mod serial;
pub(crate) mod simple;
pub(crate) mod subtree;
pub(crate) mod walk;
pub(crate) mod ways;

use crate::model::Model;
use crate::model::way::Way;
use crate::model::way::Ways;
use articulated::Articulated;
use chain::Chains;
use kinematics::Frames;
use path::Path;

/// What these stages keep from one to the next, so that they do not allocate.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Scratch {
    /// Trees of a few slides and hinges.
    pub(crate) chains: Chains,
    pub(crate) frames: Frames,
    /// Trees of many degrees of freedom.
    pub(crate) articulated: Articulated,
    /// Joints of bodies whose bias force has a closed form.
    simple: Vec<simple::Joint>,
    /// Motions of ancestors, for rows of M.
    path: Path,
    /// Spatial accelerations and forces of bodies.
    cacc: Vec<f64>,
    cfrc: Vec<f64>,
    /// A factorization that is nobody's: rows and 1/D.
    pub(crate) ld: Vec<f64>,
    pub(crate) diag_inv: Vec<f64>,
}

impl Scratch {
    pub(crate) fn new(m: &Model, ways: Ways) -> Scratch {
        Scratch {
            chains: if ways.has(Way::Chain) { Chains::new(m) } else { Chains::default() },
            frames: Frames::new(m),
            articulated: Articulated::new(m, ways),
            simple: if ways.has(Way::Simple) { simple::joints(m) } else { Vec::new() },
            path: Path::new(m),
            cacc: vec![0.0; 6 * m.nbody],
            cfrc: vec![0.0; 6 * m.nbody],
            ld: vec![0.0; m.nC],
            diag_inv: vec![0.0; m.nv],
        }
    }
}
