//! The mechanical energy of a scene: kinetic energy, and potential energy of gravity, springs and servos.

use super::forward;
use super::workspace::StepScratch;
use crate::dynamics::reflected::tendons_have_inertia;
use crate::dynamics::{kinetic, mass};
use crate::forces::passive::spring;
use crate::forces::{actuation, transmission};
use crate::kinds::disable;
use crate::math::*;
use crate::model::{Fields, Model};

/// Mechanical energy, J.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Energy {
    /// ½ vᵀ M v.
    pub kinetic: f64,
    /// Potential energy of gravity.
    pub gravity: f64,
    /// Potential energy of springs, and of actuators whose force depends on their length only.
    pub elastic: f64,
}

impl Energy {
    /// The potential energy of gravity and elastic elements, J.
    pub fn potential(&self) -> f64 {
        self.gravity + self.elastic
    }
}

/// The energy at `qpos` and `qvel`, for the current controls. `None` if an actuator has no potential, because it may add energy.
/// Computes poses and lengths only.
pub fn mechanical_energy(m: &Model, d: &mut Fields, s: &mut StepScratch) -> Option<Energy> {
    forward::update_positions(m, d, s);
    transmission::transmissions(m, d, &mut s.forces);
    energy_of_poses(m, d, s)
}

/// Like [`mechanical_energy`], for the poses and lengths at hand.
pub fn energy_of_poses(m: &Model, d: &mut Fields, s: &mut StepScratch) -> Option<Energy> {
    let mut gravity = 0.0;
    if !m.opt.disabled(disable::GRAVITY) {
        for (b, &x) in rows::<3>(&d.xipos).iter().enumerate().skip(1) {
            gravity -= m.body_mass[b] * (1.0 - m.body_gravcomp[b]) * dot(m.opt.gravity, x);
        }
    }
    let springs = if m.opt.disabled(disable::SPRING) { 0.0 } else { spring::energy(m, d) };
    let elastic = springs + servos(m, d)?;
    Some(Energy { kinetic: kinetic(m, d, s), gravity, elastic })
}

/// ½ vᵀ M v, J: the kinetic energy of bodies, plus ½ Σ a v² with the armature a of each degree of freedom.
///
/// The time grows with the number of bodies, while M has up to nv² elements. Two cases need M itself. M of simple bodies is
/// constant: it does not follow `body_mass` until constants are recomputed. M contains the inertia of a tendon only where its
/// sparsity pattern has an element.
fn kinetic(m: &Model, d: &mut Fields, s: &mut StepScratch) -> f64 {
    if tendons_have_inertia(m) {
        forward::mass_matrix(m, d, s);
        return 0.5 * mass::quadratic(m, &d.M, &d.qvel);
    }
    let of_dof = |k: usize| if m.dof_simplenum[k] > 0 { m.dof_M0[k] } else { mass::armature(m, k) };
    let of_dofs: f64 = d.qvel.iter().enumerate().map(|(k, v)| of_dof(k) * v * v).sum();
    kinetic::of_bodies(m, d, &mut s.dynamics) + 0.5 * of_dofs
}

/// The potential energy of all actuators, or `None` if one of them has none.
///
/// A force clip(u) with u = a - k x has the potential Φ(u)/k, where Φ' = clip: a parabola that continues as its tangents beyond
/// the limits. If k = 0, the force c is constant and its potential is -c x.
fn servos(m: &Model, d: &mut Fields) -> Option<f64> {
    if m.nactuator == 0 || m.opt.disabled(disable::ACTUATION) {
        return Some(0.0);
    }
    let mut sum = 0.0;
    actuation::controls(m, d);
    for i in (0..m.nactuator).filter(|&i| !actuation::switched_off(m, i)) {
        if actuation::idle(m, d, i) {
            continue;
        }
        let [u, k] = actuation::along_length(m, d, i)?;
        let c = if m.actuator_forcelimited[i] { clip(u, rows::<2>(&m.actuator_forcerange)[i]) } else { u };
        let length = d.actuator_length[m.actuator_outadr[i] as usize];
        sum += if k != 0.0 { c * (u - 0.5 * c) / k } else { -c * length };
    }
    Some(sum)
}

#[cfg(test)]
#[allow(clippy::unwrap_used)] // a test that fails says why
mod tests {
    use super::*;
    use crate::step::workspace::Workspace;
    use crate::tests::compile;

    /// The kinetic energy of bodies, armatures and tendons is ½ vᵀ M v, also if masses are written without recomputing constants.
    #[test]
    fn kinetic_energy_is_that_of_the_mass_matrix() {
        for inertia in [0.0, 0.3] {
            for factor in [1.0, 2.5] {
                compare_kinetic_energy(inertia, factor);
            }
        }
    }

    fn compare_kinetic_energy(inertia: f64, factor: f64) {
        let mut m = compile(&format!(
            "<mujoco><worldbody><site name='anchor' pos='0 0 2'/>\
            <body name='a'><freejoint/><geom type='box' size='.1 .2 .3' mass='2' pos='.1 0 .05'/><site name='s' pos='.1 .1 0'/>\
              <body pos='.3 0 0'><joint type='ball' armature='.2'/><geom type='capsule' size='.05' fromto='0 0 0 .2 .1 .3'/>\
                <body pos='.2 .1 .3'><joint name='h' axis='1 2 0' armature='.1'/><joint type='slide' axis='0 1 1'/><geom size='.1'/></body></body></body>\
            <body pos='2 0 0'><joint name='x' type='slide' axis='1 0 0'/><geom size='.1'/></body></worldbody>\
            <tendon><spatial name='t' armature='{inertia}'><site site='anchor'/><site site='s'/></spatial>\
              <fixed name='f' armature='{inertia}'><joint joint='h' coef='2'/><joint joint='x' coef='-1'/></fixed></tendon>\
            <actuator><motor joint='h' gear='3'/><motor tendon='f' gear='2'/></actuator></mujoco>"
        ))
        .unwrap();
        m.body_mass.iter_mut().for_each(|mass| *mass *= factor);
        let Workspace { fields: mut d, scratch: mut s } = Workspace::new(&m);
        for (k, q) in d.qpos.iter_mut().enumerate() {
            *q += 0.1 * (k as f64 + 1.0).sin();
        }
        for (k, v) in d.qvel.iter_mut().enumerate() {
            *v = (3.0 * k as f64 + 1.0).cos();
        }
        let energy = mechanical_energy(&m, &mut d, &mut s).unwrap();
        forward::forward(&m, &mut d, &mut s);
        let product = 0.5 * mass::quadratic(&m, &d.M, &d.qvel);
        assert!(product > 1.0, "{product}");
        assert!((energy.kinetic - product).abs() < 1e-13 * product, "{} and {product}", energy.kinetic);
    }
}
