//! What a step of Runge and Kutta's keeps between its stages.

use crate::model::Model;

/// What a step keeps between its stages.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct RungeKutta {
    /// The state at the start of the step.
    pub(super) qpos: Vec<f64>,
    pub(super) qvel: Vec<f64>,
    pub(super) act: Vec<f64>,
    /// Weighted sums of the stages' slopes, and the velocity of one stage.
    pub(super) dpos: Vec<f64>,
    pub(super) dvel: Vec<f64>,
    pub(super) dact: Vec<f64>,
    pub(super) slope: Vec<f64>,
}

impl RungeKutta {
    pub(super) fn new(m: &Model) -> RungeKutta {
        let (q, v, a) = (vec![0.0; m.nq], vec![0.0; m.nv], vec![0.0; m.na]);
        RungeKutta {
            qpos: q,
            qvel: v.clone(),
            act: a.clone(),
            dpos: v.clone(),
            dvel: v.clone(),
            dact: a,
            slope: v,
        }
    }
}
