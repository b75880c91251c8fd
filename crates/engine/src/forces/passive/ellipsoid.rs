//! Fluid forces on an ellipsoid: added mass, Magnus and Kutta lift, drag; and their derivatives with respect to the
//! velocity.
//!
//! The model is that of MuJoCo's documentation, "Computation: Fluid forces, ellipsoid model", with references
//! there: Lamb 1932 for the added mass, Andersen, Pesavento and Wang 2005 for lift and drag of falling plates.

use std::f64::consts::PI;

use crate::kinds::geom;
use crate::math::*;
use crate::model::Model;

/// A lower bound for divisors. It is far below any physical value, so that it does not change the forces of small bodies.
const SMALLEST: f64 = 1e-200;

/// An ellipsoid in a fluid.
///
/// All vectors are along its axes. With the momenta p = ρ m∘v and l = ρ i∘w of the added mass,
///
/// > torque = p × v + l × w - (π D³ η + ρ |c∘w|) w
/// > force  = p × w + M w × v + K A/|v| (n × v) × v - (3π D η + ρ |v| (blunt A + slender (A_max - A))) v
///
/// where D is the mean diameter, A the projected area along v, and n the normal of the surface there.
pub(crate) struct Ellipsoid {
    density: f64,
    /// Added mass and added inertia, multiplied by the density.
    mass: Vec3,
    inertia: Vec3,
    /// Squares of the products of two half lengths: the squared projected areas divided by π².
    faces: Vec3,
    magnus: f64,
    kutta: f64,
    blunt: f64,
    slender: f64,
    /// The largest projected area.
    greatest: f64,
    /// Viscous resistance to rotation and to translation.
    viscous: [f64; 2],
    /// Resistance to rotation about each axis.
    turning: Vec3,
}

/// Half lengths of the ellipsoid that represents a geom, m.
fn semi_axes(m: &Model, g: usize) -> Vec3 {
    let [x, y, z] = rows::<3>(&m.geom_size)[g];
    match m.geom_type[g] {
        geom::SPHERE => [x, x, x],
        geom::CAPSULE => [x, x, y + x],
        geom::CYLINDER => [x, x, y],
        _ => [x, y, z],
    }
}

/// The projection of an ellipsoid along its motion. Its area is π √(den/num).
struct ProjectedArea {
    num: f64,
    den: f64,
    area: f64,
    speed: f64,
}

impl Ellipsoid {
    /// `fluid` is the geom's row of `geom_fluid`: a flag; coefficients of blunt, slender and angular drag, Kutta and Magnus lift;
    /// added mass and added inertia for unit density of the fluid.
    pub(super) fn new(m: &Model, g: usize, fluid: [f64; 12]) -> Ellipsoid {
        let [share, blunt, slender, angular, kutta, magnus, m0, m1, m2, i0, i1, i2] = fluid;
        let (density, viscosity) = (share * m.opt.density, share * m.opt.viscosity);
        let [a, b, c] = semi_axes(m, g);
        let largest = a.max(b).max(c);
        let middle = a + b + c - largest - a.min(b).min(c);
        let volume = 4.0 / 3.0 * PI * a * b * c;
        let diameter = 2.0 / 3.0 * (a + b + c);
        let moment = |x: f64, y: f64, z: f64| 8.0 / 15.0 * PI * x * square(square(y.max(z)));
        let most = 8.0 / 15.0 * PI * middle * square(square(largest));
        let turning =
            [moment(a, b, c), moment(b, c, a), moment(c, a, b)].map(|i| angular * i + slender * (most - i));
        Ellipsoid {
            density,
            mass: scale([m0, m1, m2], density),
            inertia: scale([i0, i1, i2], density),
            faces: [square(b * c), square(c * a), square(a * b)],
            magnus: magnus * density * volume,
            kutta: kutta * density,
            blunt,
            slender,
            greatest: PI * largest * middle,
            viscous: [viscosity * PI * diameter * diameter * diameter, viscosity * 3.0 * PI * diameter],
            turning,
        }
    }

    fn shadow(&self, v: Vec3) -> ProjectedArea {
        let f = self.faces;
        let sum = |f: Vec3| f[0] * square(v[0]) + f[1] * square(v[1]) + f[2] * square(v[2]);
        let (num, den) = (sum(f), sum(f.map(square)));
        ProjectedArea { num, den, area: PI * (den / num.max(SMALLEST)).sqrt(), speed: norm(v) }
    }

    /// Torque and force for a motion relative to the fluid.
    pub(super) fn force(&self, motion: Spatial) -> Spatial {
        let (w, v) = (angular(&motion), linear(&motion));
        let (p, l) = (each(self.mass, v), each(self.inertia, w));
        let mut torque = add(cross(p, v), cross(l, w));
        let mut force = cross(p, w);
        force = add_scaled(force, cross(w, v), self.magnus);

        let s = self.shadow(v);
        let normal = each(self.faces, v);
        let cosine = s.num / (s.speed * s.den).max(SMALLEST);
        let circulation = scale(cross(normal, v), self.kutta * cosine * s.area);
        force = add(force, cross(circulation, v));

        force = add_scaled(force, v, -(self.viscous[1] + self.density * s.speed * self.front(s.area)));
        let resisted = norm(each(self.turning, w));
        torque = add_scaled(torque, w, -(self.viscous[0] + self.density * resisted));
        spatial(torque, force)
    }

    /// The effective area of drag: the projected area with the blunt coefficient, and the rest with the slender coefficient.
    fn front(&self, shadow: f64) -> f64 {
        self.blunt * shadow + self.slender * (self.greatest - shadow)
    }

    /// The derivative of drag alone: of the torque with respect to w, and of the force with respect to v.
    pub(crate) fn drag(&self, motion: Spatial) -> [Mat3; 2] {
        let (w, v) = (angular(&motion), linear(&motion));
        let resisted = norm(each(self.turning, w));
        let slope = each(each(self.turning, self.turning), w);
        let mut torque = outer(w, scale(slope, -self.density / resisted.max(SMALLEST)));
        add_diagonal(&mut torque, -(self.viscous[0] + self.density * resisted));

        let s = self.shadow(v);
        let front = self.front(s.area);
        // The gradient of the projected area, π (num ∇den - den ∇num) / (2 √(num³ den)), without the terms that cancel.
        let f = self.faces;
        let growth = [0, 1, 2].map(|k| {
            let rest: f64 = (0..3).map(|j| f[j] * square(v[j]) * (f[k] - f[j])).sum();
            f[k] * v[k] * rest
        });
        let growth = scale(growth, PI / (s.num * s.num * s.num * s.den).sqrt().max(SMALLEST));
        let slope = scale(v, front / s.speed.max(SMALLEST));
        let slope = add_scaled(slope, growth, s.speed * (self.blunt - self.slender));
        let mut force = outer(v, scale(slope, -self.density));
        add_diagonal(&mut force, -(self.viscous[1] + self.density * s.speed * front));
        [torque, force]
    }

    /// The derivative of torque and force with respect to the motion, by rows.
    pub(crate) fn derivative(&self, motion: Spatial) -> [Spatial; 6] {
        let (w, v) = (angular(&motion), linear(&motion));
        let (p, l) = (each(self.mass, v), each(self.inertia, w));
        let [turning, drag] = self.drag(motion);
        let torque_v = sub(crossing(p), columns(crossing(v), self.mass));
        let torque_w = add(sub(crossing(l), columns(crossing(w), self.inertia)), turning);
        let force_w = sub(crossing(p), scale(crossing(v), self.magnus));
        let force_v = sub(scale(crossing(w), self.magnus), columns(crossing(w), self.mass));
        let force_v = add(add(force_v, drag), self.kutta_slope(v));
        std::array::from_fn(|r| {
            let (a, b) = if r < 3 { (&torque_w, &torque_v) } else { (&force_w, &force_v) };
            let r = 3 * (r % 3);
            [a[r], a[r + 1], a[r + 2], b[r], b[r + 1], b[r + 2]]
        })
    }

    /// The derivative of the Kutta lift g G, where G = (n × v) × v and g = K π √num / (|v| √den).
    fn kutta_slope(&self, v: Vec3) -> Mat3 {
        let s = self.shadow(v);
        let (square_speed, normal) = (s.speed * s.speed, each(self.faces, v));
        let lift = cross(normal, v);
        // num ∇ ln g
        let slope = sub(normal, scale(each(self.faces, normal), s.num / s.den.max(SMALLEST)));
        let slope = add_scaled(slope, v, -s.num / square_speed.max(SMALLEST));
        // ∇G = [n × v] - [v] ([n] - [v] diag(faces))
        let inner = sub(crossing(normal), columns(crossing(v), self.faces));
        let gradient = sub(crossing(lift), mat_mul(&crossing(v), &inner));
        let total = add(outer(cross(lift, v), slope), scale(gradient, s.num));
        scale(total, PI * self.kutta / (s.den * s.num * square_speed).sqrt().max(SMALLEST))
    }
}

fn square(x: f64) -> f64 {
    x * x
}

/// The element-wise product.
fn each(a: Vec3, b: Vec3) -> Vec3 {
    [a[0] * b[0], a[1] * b[1], a[2] * b[2]]
}

/// The matrix of the cross product a ×.
fn crossing([x, y, z]: Vec3) -> Mat3 {
    [0.0, -z, y, z, 0.0, -x, -y, x, 0.0]
}

/// a bᵀ
fn outer(a: Vec3, b: Vec3) -> Mat3 {
    std::array::from_fn(|i| a[i / 3] * b[i % 3])
}

/// a diag(b)
fn columns(a: Mat3, b: Vec3) -> Mat3 {
    std::array::from_fn(|i| a[i] * b[i % 3])
}

fn add_diagonal(a: &mut Mat3, x: f64) {
    for i in 0..3 {
        a[4 * i] += x;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The recorded cases. `golden/record.py` describes the format of a line.
    fn cases() -> Vec<(Ellipsoid, Spatial, Spatial)> {
        let case = |line: &str| {
            let x: Vec<f64> = line.split(' ').map(|w| w.parse().unwrap()).collect();
            let part = |start: usize, n: usize| x[start..start + n].to_vec();
            let mut m = Model { geom_type: vec![x[2] as i32], geom_size: part(3, 3), ..Model::default() };
            (m.opt.density, m.opt.viscosity) = (x[0], x[1]);
            let mut fluid: [f64; 12] = part(6, 12).try_into().unwrap();
            fluid[0] = 1.0;
            (Ellipsoid::new(&m, 0, fluid), part(18, 6).try_into().unwrap(), part(24, 6).try_into().unwrap())
        };
        include_str!("golden/ellipsoid.txt").lines().map(case).collect()
    }

    #[test]
    fn forces_are_those_of_mujoco() {
        for (ellipsoid, motion, expected) in cases() {
            let found = ellipsoid.force(motion);
            let size = expected.iter().fold(1.0f64, |s, f| s.max(f.abs()));
            let error = sub(found, expected).iter().fold(0.0f64, |s, e| s.max(e.abs()));
            assert!(error < 1e-12 * size, "{found:?}, not {expected:?}");
        }
    }

    /// Compares with central differences, except at rest, where |v| v is not smooth.
    #[test]
    fn derivatives_are_those_of_the_forces() {
        for (ellipsoid, motion, _) in cases().into_iter().filter(|c| c.1 != [0.0; 6]) {
            let derivative = ellipsoid.derivative(motion);
            for c in 0..6 {
                let h = 1e-5 * (1.0 + motion[c].abs());
                let force_at = |x: f64| {
                    let mut moved = motion;
                    moved[c] += x;
                    ellipsoid.force(moved)
                };
                let slope = scale(sub(force_at(h), force_at(-h)), 0.5 / h);
                let size = derivative.as_flattened().iter().fold(1.0f64, |s, x| s.max(x.abs()));
                for r in 0..6 {
                    let error = (derivative[r][c] - slope[r]).abs();
                    assert!(
                        error < 1e-6 * size,
                        "row {r}, column {c}: {} not {}",
                        derivative[r][c],
                        slope[r]
                    );
                }
            }
        }
    }
}
