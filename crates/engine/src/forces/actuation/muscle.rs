//! Muscles: active force over length and velocity, passive force over length, activation dynamics.
//!
//! The curves are those of MuJoCo's documentation, "Modeling: Muscles", after Zajac (*Muscle and tendon: properties, models,
//! scaling, and application to biomechanics and motor control*, 1989): parabolas that are joined with equal slopes. With the
//! length L in units of the optimal length L₀ and the velocity V in units of L₀ · vmax per second,
//!
//! > force = -F₀ (FL(L) FV(V) activation + FP(L))
//!
//! where FL rises from 0 at lmin to 1 at L = 1 and falls to 0 at lmax, FV rises from 0 at V = -1 through 1 at V = 0 to fvmax, and
//! FP grows from 0 at L = 1 and is linear from halfway to lmax. Activation follows Millard et al. (*Flexing computational
//! muscle*, 2013).
//!
//! Parameters in order: operating range in optimal lengths (2), peak force, its scale, lmin, lmax, vmax, fpmax, fvmax.

use crate::math::*;
use crate::model::{Fields, Model};

/// The state of a muscle in normalized units.
pub(crate) struct MuscleState {
    /// F₀: peak isometric force, N.
    peak: f64,
    /// L: length in units of the optimal length.
    length: f64,
    /// V: velocity in units of the largest shortening velocity.
    velocity: f64,
    /// L₀: the optimal length, m.
    optimal: f64,
    /// The largest shortening velocity, m/s.
    fastest: f64,
}

impl MuscleState {
    /// The state of the muscle with output `o` and parameters `p`. `actuator_lengthrange` corresponds to its operating range.
    pub(crate) fn new(m: &Model, d: &Fields, o: usize, p: &[f64; 10]) -> MuscleState {
        let [from, to, force, scale, _, _, vmax, ..] = *p;
        let [shortest, longest] = rows::<2>(&m.actuator_lengthrange)[o];
        let optimal = ((longest - shortest) / (to - from).max(MINVAL)).max(MINVAL);
        let fastest = (optimal * vmax).max(MINVAL);
        MuscleState {
            peak: if force >= 0.0 { force } else { scale / m.actuator_acc0[o].max(MINVAL) },
            length: from + (d.actuator_length[o] - shortest) / optimal,
            velocity: d.actuator_velocity[o] / fastest,
            optimal,
            fastest,
        }
    }
}

/// The value and the slope of a curve at one point.
#[derive(Clone, Copy)]
struct Curve {
    value: f64,
    slope: f64,
}

/// FL: [`smooth_step`] from lmin to 1, and mirrored from lmax to 1.
fn active_by_length(p: &[f64; 10], length: f64) -> Curve {
    let end = if length <= 1.0 { p[4] } else { p[5] };
    let width = 1.0 - end;
    let width = if width.abs() < MINVAL { MINVAL.copysign(1.0 - length) } else { width };
    let Curve { value, slope } = smooth_step((length - end) / width);
    Curve { value, slope: slope / width }
}

/// A curve from 0 at x = 0 to 1 at x = 1, with zero slope at both ends: two half parabolas that are joined at (½, ½).
fn smooth_step(x: f64) -> Curve {
    let x = x.clamp(0.0, 1.0);
    let rest = 1.0 - x;
    Curve { value: if x <= 0.5 { 2.0 * x * x } else { 1.0 - 2.0 * rest * rest }, slope: 4.0 * x.min(rest) }
}

/// FV: a parabola from (-1, 0), where its slope is zero, to (0, 1), where its slope is 2. A second parabola from there to the
/// height fvmax, which it reaches with zero slope at V = fvmax - 1.
fn active_by_velocity(p: &[f64; 10], velocity: f64) -> Curve {
    let excess = p[8] - 1.0;
    if velocity <= 0.0 {
        let x = (velocity + 1.0).max(0.0);
        Curve { value: x * x, slope: 2.0 * x }
    } else {
        let rest = (excess - velocity).max(0.0);
        let slope = rest / excess.max(MINVAL);
        Curve { value: p[8] - rest * slope, slope: 2.0 * slope }
    }
}

/// FP: with x = 2 (L - 1) / (lmax - 1), the parabola fpmax x²/2 up to x = 1, and its tangent beyond.
fn passive_by_length(p: &[f64; 10], length: f64) -> Curve {
    let (lmax, fpmax) = (p[5], p[7]);
    let width = (0.5 * (lmax - 1.0)).max(MINVAL);
    let x = (length - 1.0) / width;
    let slope = x.clamp(0.0, 1.0);
    Curve { value: fpmax * slope * (x - 0.5 * slope), slope: fpmax * slope / width }
}

/// -F₀ FL FV: the force of a fully active muscle.
pub(super) fn gain(p: &[f64; 10], s: &MuscleState) -> f64 {
    -s.peak * active_by_length(p, s.length).value * active_by_velocity(p, s.velocity).value
}

/// The derivative of the gain with respect to velocity.
pub(crate) fn gain_by_velocity(p: &[f64; 10], s: &MuscleState) -> f64 {
    -s.peak * active_by_length(p, s.length).value * active_by_velocity(p, s.velocity).slope / s.fastest
}

/// The derivative of the gain with respect to length.
pub(crate) fn gain_by_length(p: &[f64; 10], s: &MuscleState) -> f64 {
    -s.peak * active_by_length(p, s.length).slope * active_by_velocity(p, s.velocity).value / s.optimal
}

/// -F₀ FP: the passive force.
pub(super) fn bias(p: &[f64; 10], s: &MuscleState) -> f64 {
    -s.peak * passive_by_length(p, s.length).value
}

/// The derivative of the passive force with respect to length.
pub(crate) fn bias_by_length(p: &[f64; 10], s: &MuscleState) -> f64 {
    -s.peak * passive_by_length(p, s.length).slope / s.optimal
}

/// The rate of an activation for a control: (u - a) / τ. With c = ½ + 3a/2, the time constant τ is the first parameter times c
/// during activation, and the second parameter divided by c during deactivation. The third parameter is the width of the control
/// error over which τ changes smoothly from one to the other.
pub(super) fn rate(p: &[f64; 10], control: f64, act: f64) -> f64 {
    let [activate, deactivate, width, ..] = *p;
    let c = 0.5 + 1.5 * act.clamp(0.0, 1.0);
    let (activate, deactivate) = (activate * c, deactivate / c);
    let error = control.clamp(0.0, 1.0) - act;
    let activates = if width >= MINVAL { quintic(error / width + 0.5) } else { f64::from(error > 0.0) };
    error / (deactivate + (activate - deactivate) * activates).max(MINVAL)
}

/// A curve from 0 to 1 for x between 0 and 1, whose first two derivatives are zero at both ends: 6x⁵ - 15x⁴ + 10x³.
fn quintic(x: f64) -> f64 {
    let x = x.clamp(0.0, 1.0);
    x * x * x * (10.0 + x * (6.0 * x - 15.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    const DEFAULT: [f64; 10] = [0.75, 1.05, -1.0, 200.0, 0.5, 1.6, 1.5, 1.3, 1.2, 0.0];

    /// Every curve and its slope are continuous, and the slope is the derivative. A discontinuity would be visible in a finite
    /// difference.
    #[test]
    fn curves_are_smooth() {
        let curves: [fn(&[f64; 10], f64) -> Curve; 3] =
            [active_by_length, active_by_velocity, passive_by_length];
        for curve in curves {
            for i in -1500..2500 {
                let (x, h) = (f64::from(i) * 1e-3, 5e-4);
                let (a, b) = (curve(&DEFAULT, x), curve(&DEFAULT, x + h));
                assert!((b.value - a.value - 0.5 * h * (a.slope + b.slope)).abs() < 3.0 * h * h, "{x}");
                assert!((b.slope - a.slope).abs() < 50.0 * h, "{x}: {} {}", a.slope, b.slope);
            }
        }
    }

    #[test]
    fn curves_pass_through_their_points() {
        let [lmin, lmax, fpmax, fvmax] = [4, 5, 7, 8].map(|i| DEFAULT[i]);
        let length = |l| active_by_length(&DEFAULT, l).value;
        assert_eq!([0.2, lmin, 1.0, lmax, 2.0].map(length), [0.0, 0.0, 1.0, 0.0, 0.0]);
        assert!((length(0.75) - 0.5).abs() < 1e-15 && (length(1.3) - 0.5).abs() < 1e-15);
        let velocity = |v| active_by_velocity(&DEFAULT, v).value;
        assert_eq!([-2.0, -1.0, -0.5, 3.0].map(velocity), [0.0, 0.0, 0.25, fvmax]);
        assert!((velocity(f64::MIN_POSITIVE) - 1.0).abs() < 1e-15);
        let passive = |l| passive_by_length(&DEFAULT, l).value / fpmax;
        assert_eq!([0.5, 1.0].map(passive), [0.0, 0.0]);
        assert!((passive(1.3) - 0.5).abs() < 1e-15 && (passive(lmax) - 1.5).abs() < 1e-14);
    }

    #[test]
    fn activation_is_faster_than_deactivation() {
        let p = [0.01, 0.04, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
        assert!((rate(&p, 1.0, 0.0) - 1.0 / (0.01 * 0.5)).abs() < 1e-12);
        assert!((rate(&p, 0.0, 1.0) + 1.0 / (0.04 / 2.0)).abs() < 1e-12);
        assert_eq!([-1.0, 0.0, 0.5, 1.0, 2.0].map(quintic), [0.0, 0.0, 0.5, 1.0, 1.0]);
    }
}
