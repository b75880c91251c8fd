//! Memory of the integrators within a step.

use crate::model::Model;

/// The memory of the Runge–Kutta method between its stages.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct RungeKutta {
    /// The state at the start of the step.
    pub(super) qpos: Vec<f64>,
    pub(super) qvel: Vec<f64>,
    pub(super) act: Vec<f64>,
    /// Weighted sums of the slopes of the stages, and the velocity of one stage.
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

/// The memory of the methods in coordinates around the start of a step. Allocated by the first step that needs it.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Flow {
    /// The time at the start of the whole step, and `energy` there. The energies at the stages are not used.
    pub(super) began: f64,
    pub(super) energy: [f64; 2],
    /// The configuration and the time at the origin of the coordinates, which is the start of the step or of the current part of
    /// it.
    pub(super) qpos: Vec<f64>,
    pub(super) time: f64,
    /// The state at the origin, its slope, and the state at the end: coordinates, velocities, activations.
    pub(super) start: Vec<f64>,
    pub(super) first: Vec<f64>,
    pub(super) end: Vec<f64>,
    /// The slopes of the stages, or an extrapolation table: lists like `start`, one after the other.
    pub(super) rows: Vec<f64>,
}

impl Flow {
    /// Allocates memory for the state, and for this number of slopes.
    pub(super) fn make_room(&mut self, m: &Model, slopes: usize) {
        let n = 2 * m.nv + m.na;
        self.qpos.resize(m.nq, 0.0);
        for list in [&mut self.start, &mut self.first, &mut self.end] {
            list.resize(n, 0.0);
        }
        if self.rows.len() < slopes * n {
            self.rows.resize(slopes * n, 0.0);
        }
    }
}

/// The acceleration of a step, if it is not `qacc`.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Damping {
    pub(super) qacc: Vec<f64>,
    /// h B.
    pub(super) b: Vec<f64>,
    /// Whether `qacc` contains a' for the forces of this step.
    pub(super) done: bool,
}

impl Damping {
    pub(super) fn new(m: &Model) -> Damping {
        Damping { qacc: vec![0.0; m.nv], b: vec![0.0; m.nv], done: false }
    }
}
