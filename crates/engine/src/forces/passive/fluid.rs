//! Fluid forces on bodies: drag and viscosity. The fluid moves with the velocity `opt.wind`.
//!
//! A body is treated as a box with the same inertia, unless one of its geoms has the ellipsoid model (MuJoCo's
//! documentation, "Computation: Fluid forces").

use crate::model::index::element_range;
use std::f64::consts::PI;

use super::ellipsoid::Ellipsoid;
use crate::dynamics::jacobian;
use crate::kinds::disable;
use crate::math::*;
use crate::model::{Fields, Model};

/// The number of values per geom in `geom_fluid`.
const FLUID: usize = 12;

/// Whether there is a fluid and its forces are enabled.
pub(crate) fn acts(m: &Model) -> bool {
    let on = !m.opt.disabled(disable::SPRING) || !m.opt.disabled(disable::DAMPER);
    on && (m.opt.density > 0.0 || m.opt.viscosity > 0.0)
}

/// Computes `qfrc_fluid`, which must be zero before.
pub(super) fn fluid(m: &Model, d: &mut Fields) {
    let mut out = std::mem::take(&mut d.qfrc_fluid);
    shapes(m, d, |frame, shape| frame.apply(m, d, shape.force(frame.motion), &mut out));
    d.qfrc_fluid = out;
}

/// Calls `f` for every box and ellipsoid on which fluid forces act.
pub(crate) fn shapes(m: &Model, d: &Fields, mut f: impl FnMut(&FluidFrame, &FluidShape)) {
    for b in 1..m.nbody {
        if m.body_mass[b] < MINVAL {
            continue;
        }
        let geoms = element_range(m.body_geomadr[b], m.body_geomnum[b]);
        let fluid = &rows::<FLUID>(&m.geom_fluid)[geoms.clone()];
        if fluid.iter().all(|s| s[0] <= 0.0) {
            let frame = FluidFrame::new(m, d, b, rows::<3>(&d.xipos)[b], rows::<9>(&d.ximat)[b]);
            f(&frame, &FluidShape::Box(InertiaBox::new(m, b)));
            continue;
        }
        for (g, &fluid) in geoms.zip(fluid).filter(|(_, s)| s[0] != 0.0) {
            let frame = FluidFrame::new(m, d, b, rows::<3>(&d.geom_xpos)[g], rows::<9>(&d.geom_xmat)[g]);
            f(&frame, &FluidShape::Ellipsoid(Ellipsoid::new(m, g, fluid)));
        }
    }
}

/// A frame that moves with a body, and its motion relative to the fluid: angular and linear velocity along the axes of the frame.
pub(crate) struct FluidFrame {
    pub(crate) body: usize,
    pub(crate) pos: Vec3,
    pub(crate) mat: Mat3,
    pub(crate) motion: Spatial,
}

impl FluidFrame {
    fn new(m: &Model, d: &Fields, body: usize, pos: Vec3, mat: Mat3) -> FluidFrame {
        let cvel = &rows::<6>(&d.cvel)[body];
        let arm = sub(pos, rows::<3>(&d.subtree_com)[m.body_rootid[body] as usize]);
        let velocity = add(linear(cvel), cross(angular(cvel), arm));
        let turning = mat_t_mul_vec(&mat, angular(cvel));
        let moving = mat_t_mul_vec(&mat, sub(velocity, m.opt.wind));
        FluidFrame { body, pos, mat, motion: spatial(turning, moving) }
    }

    /// Adds the generalized force of a torque and a force along the axes of the frame.
    fn apply(&self, m: &Model, d: &Fields, force: Spatial, out: &mut [f64]) {
        let (torque, force) =
            (mat_mul_vec(&self.mat, angular(&force)), mat_mul_vec(&self.mat, linear(&force)));
        jacobian::apply(m, d, self.body, self.pos, force, torque, out);
    }
}

/// The shape for which fluid forces are computed.
pub(crate) enum FluidShape {
    Box(InertiaBox),
    Ellipsoid(Ellipsoid),
}

impl FluidShape {
    /// Torque and force for a motion relative to the fluid, all along the axes of the frame.
    fn force(&self, motion: Spatial) -> Spatial {
        match self {
            FluidShape::Box(b) => b.force(motion),
            FluidShape::Ellipsoid(e) => e.force(motion),
        }
    }
}

/// The box with the inertia of a body.
///
/// Viscosity acts as on a sphere with the diameter D, the mean edge of the box: torque π D³ η ω, force 3π D η v. Each pair
/// of faces has a drag force of ½ ρ A |v| v, and a drag torque of ρ e (e₁⁴ + e₂⁴) |ω| ω / 64.
pub(crate) struct InertiaBox {
    /// Coefficients of linear and quadratic resistance, for three rotations and three translations.
    linear: Spatial,
    quadratic: Spatial,
}

impl InertiaBox {
    fn new(m: &Model, b: usize) -> InertiaBox {
        let i = rows::<3>(&m.body_inertia)[b];
        let mass = m.body_mass[b];
        let edge = |k: usize| {
            let sum = i[(k + 1) % 3] + i[(k + 2) % 3] - i[k];
            (sum.max(MINVAL) / mass * 6.0).sqrt()
        };
        let e = [edge(0), edge(1), edge(2)];
        let (density, viscosity) = (m.opt.density.max(0.0), m.opt.viscosity.max(0.0));
        let diameter = (e[0] + e[1] + e[2]) / 3.0;
        let turn = PI * diameter * diameter * diameter * viscosity;
        let push = 3.0 * PI * diameter * viscosity;
        let fourth = |x: f64| x * x * x * x;
        let mut quadratic = [0.0; 6];
        for k in 0..3 {
            let (e1, e2) = (e[(k + 1) % 3], e[(k + 2) % 3]);
            quadratic[k] = density * e[k] * (fourth(e1) + fourth(e2)) / 64.0;
            quadratic[3 + k] = 0.5 * density * e1 * e2;
        }
        InertiaBox { linear: [turn, turn, turn, push, push, push], quadratic }
    }

    /// Torque and force.
    fn force(&self, motion: Spatial) -> Spatial {
        std::array::from_fn(|k| -(self.linear[k] + self.quadratic[k] * motion[k].abs()) * motion[k])
    }

    /// The diagonal of their derivative with respect to the motion.
    pub(crate) fn derivative(&self, motion: Spatial) -> Spatial {
        std::array::from_fn(|k| -(self.linear[k] + 2.0 * self.quadratic[k] * motion[k].abs()))
    }
}
