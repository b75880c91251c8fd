//! Forces of the medium on an ellipsoid: added mass, Magnus and Kutta lift, drag.
//!
//! The model is that of MuJoCo's documentation, "Computation: Fluid forces, ellipsoid model", with references
//! there: Lamb 1932 for the added mass, Andersen, Pesavento and Wang 2005 for lift and drag of falling plates.

use std::f64::consts::PI;

use super::fluid::spatial;
use crate::math::*;
use crate::{Model, geom};

/// Half lengths of the ellipsoid that stands for a geom, m.
pub(super) fn semi_axes(m: &Model, g: usize) -> Vec3 {
    let [x, y, z] = rows::<3>(&m.geom_size)[g];
    match m.geom_type[g] {
        geom::SPHERE => [x, x, x],
        geom::CAPSULE => [x, x, y + x],
        geom::CYLINDER => [x, x, y],
        _ => [x, y, z],
    }
}

/// Torque and force along the geom's axes, for its `motion` through the medium along the same.
///
/// `fluid` is the geom's row of `geom_fluid`: a switch; coefficients of blunt, slender and angular drag, Kutta
/// and Magnus lift; added mass and added inertia per density of the medium.
pub(super) fn force(m: &Model, axes: Vec3, fluid: &[f64; 12], motion: Spatial) -> Spatial {
    let &[_, blunt, slender, turning, kutta, magnus, m0, m1, m2, i0, i1, i2] = fluid;
    let (density, viscosity) = (m.opt.density, m.opt.viscosity);
    let (w, v) = (angular(&motion), linear(&motion));
    let speed = norm(v);
    let [a, b, c] = axes;
    let largest = a.max(b).max(c);
    let middle = a + b + c - largest - a.min(b).min(c);

    // The medium that moves along has momentum p and angular momentum l: p × w, p × v + l × w.
    let p = [density * m0 * v[0], density * m1 * v[1], density * m2 * v[2]];
    let l = [density * i0 * w[0], density * i1 * w[1], density * i2 * w[2]];
    let mut torque = add(cross(p, v), cross(l, w));
    let mut force = cross(p, w);

    // Magnus: a turning body is pushed across its motion.
    let volume = 4.0 / 3.0 * PI * a * b * c;
    force = add_scaled(force, cross(w, v), magnus * density * volume);

    // The shadow along the direction u of the motion, and Kutta and Joukowski's lift from the circulation that an
    // inclined body causes: with the areas f = (b c, c a, a b), shadow = π √(Σ f⁴u² / Σ f²u²), normal ~ f² u.
    let mut shadow = 0.0;
    if speed >= MINVAL {
        let u = scale(v, 1.0 / speed);
        let areas = [b * c, c * a, a * b].map(square);
        let normal = [0, 1, 2].map(|k| areas[k] * u[k]);
        let (num, den) = (dot(normal, u), dot(normal, normal));
        if num > 0.0 && den > 0.0 {
            shadow = PI * (den / num).sqrt();
            let circulation = scale(cross(normal, v), kutta * density * shadow * num / den);
            force = add(force, cross(circulation, v));
        }
    }

    // Stokes' viscous drag of the sphere of the same mean diameter, and quadratic drag.
    let diameter = 2.0 / 3.0 * (a + b + c);
    let greatest = PI * largest * middle;
    let drag =
        viscosity * 3.0 * PI * diameter + density * speed * (shadow * blunt + slender * (greatest - shadow));
    force = add_scaled(force, v, -drag);

    let moment = |k: usize| {
        let across = axes[(k + 1) % 3].max(axes[(k + 2) % 3]);
        8.0 / 15.0 * PI * axes[k] * square(square(across))
    };
    let most = 8.0 / 15.0 * PI * middle * square(square(largest));
    let resisted = [0, 1, 2].map(|k| w[k] * (turning * moment(k) + slender * (most - moment(k))));
    let drag = viscosity * PI * diameter * diameter * diameter + density * norm(resisted);
    torque = add_scaled(torque, w, -drag);
    spatial(torque, force)
}

fn square(x: f64) -> f64 {
    x * x
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every recorded case: `golden/record.py` says what a line holds.
    #[test]
    fn forces_are_those_of_mujoco() {
        for line in include_str!("golden/ellipsoid.txt").lines() {
            let x: Vec<f64> = line.split(' ').map(|w| w.parse().unwrap()).collect();
            let part = |at: usize, n: usize| x[at..at + n].to_vec();
            let mut m = Model { geom_type: vec![x[2] as i32], geom_size: part(3, 3), ..Model::default() };
            (m.opt.density, m.opt.viscosity) = (x[0], x[1]);
            let fluid: [f64; 12] = part(6, 12).try_into().unwrap();
            let motion: Spatial = part(18, 6).try_into().unwrap();
            let expected: Spatial = part(24, 6).try_into().unwrap();
            let found = force(&m, semi_axes(&m, 0), &fluid, motion);
            let size = expected.iter().fold(1.0f64, |s, f| s.max(f.abs()));
            let error = sub(found, expected).iter().fold(0.0f64, |s, e| s.max(e.abs()));
            assert!(error < 1e-12 * size, "{found:?}, not {expected:?} in {line}");
        }
    }
}
