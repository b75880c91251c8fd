//! Stiffness, damping and impedance of a constraint, computed from `solref` and `solimp`.
//!
//! The formulas are those of MuJoCo's documentation, "Computation: Constraint model, Parameters".

use crate::kinds::{disable, integrator};
use crate::math::MINVAL;
use crate::model::{Contact, Model};

/// Stiffness K (1/s²), damping B (1/s) and impedance I at the current violation.
#[derive(Clone, Copy, Debug)]
pub(super) struct Kbi {
    pub(super) k: f64,
    pub(super) b: f64,
    pub(super) imp: f64,
    /// Derivative of the impedance with respect to the violation.
    pub(super) slope: f64,
}

/// The documented range of impedances and of the midpoint (mjMINIMP, mjMAXIMP).
const MINIMP: f64 = 1e-4;
const MAXIMP: f64 = 0.9999;

/// The direction in which a row acts. It determines how `refsafe` prevents rebound with the discrete integrator.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Acts {
    /// In both directions: equalities and friction.
    BothWays,
    /// In one direction: limits and contact normals.
    OneWay,
}

/// Parameters of a row at the violation `r` = position - margin.
pub(super) fn kbi(m: &Model, acts: Acts, solref: [f64; 2], solimp: [f64; 5], r: f64) -> Kbi {
    let solref = safe_solref(m, solref);
    let dmin = solimp[0].clamp(MINIMP, MAXIMP);
    let dmax = solimp[1].clamp(MINIMP, MAXIMP);
    let (imp, slope) = impedance([dmin, dmax, solimp[2], solimp[3], solimp[4]], r);
    let (mut k, mut b) = if solref[0] > 0.0 {
        // Time constant and damping ratio of the equivalent mass-spring-damper.
        let [timeconst, dampratio] = solref;
        (
            1.0 / (dmax * dmax * timeconst * timeconst * dampratio * dampratio).max(MINVAL),
            2.0 / (dmax * timeconst).max(MINVAL),
        )
    } else {
        (-solref[0] / (dmax * dmax), -solref[1] / dmax)
    };
    if discrete(m) && acts == Acts::OneWay && solref[0] > 0.0 && refsafe(m) {
        // The discrete integrator solves a row at the end of the step, so it is stable for any stiffness. Above this
        // stiffness, however, a row would make the bodies rebound.
        let stiffest = 1.0 / (imp * m.opt.timestep * m.opt.timestep);
        if k > stiffest {
            k = stiffest;
            b = 2.0 * solref[1] * k.sqrt();
        }
    }
    Kbi { k, b, imp, slope }
}

fn discrete(m: &Model) -> bool {
    m.opt.integrator == integrator::DISCRETE
}

fn refsafe(m: &Model) -> bool {
    !m.opt.disabled(disable::REFSAFE)
}

/// Parameters for the friction rows of an elliptic cone, with the impedance of the normal row: from `solreffriction`
/// if it is given and has no mixed signs.
pub(super) fn kbi_friction(m: &Model, c: &Contact, normal: Kbi) -> Kbi {
    let [a, b] = c.solreffriction;
    let is_direct = [a, b] != [0.0; 2] && (a > 0.0) == (b > 0.0);
    if !is_direct && !discrete(m) {
        return normal;
    }
    let solref = if is_direct { [a, b] } else { c.solref };
    Kbi { imp: normal.imp, slope: normal.slope, ..kbi(m, Acts::BothWays, solref, c.solimp, 0.0) }
}

/// Mixed signs are an error of the model and are replaced by the default. A time constant below two timesteps would
/// make the integration unstable; `refsafe` raises it.
fn safe_solref(m: &Model, solref: [f64; 2]) -> [f64; 2] {
    let [a, b] = if (solref[0] > 0.0) != (solref[1] > 0.0) { [0.02, 1.0] } else { solref };
    if a > 0.0 && refsafe(m) && !discrete(m) { [a.max(2.0 * m.opt.timestep), b] } else { [a, b] }
}

/// The impedance d(r) and its slope. With x = |r| / width, d = d0 + y(x) (dwidth - d0), where the sigmoid y consists
/// of two power functions that meet at the midpoint (MuJoCo's documentation, "Modeling: Solver parameters,
/// Impedance"):
///
/// > y = xᵖ / mᵖ⁻¹ for x ≤ m,  y = 1 - (1 - x)ᵖ / (1 - m)ᵖ⁻¹ above.
///
/// If the width is zero, d is the mean of d0 and dwidth (measured on MuJoCo 3.14.0).
fn impedance([d0, dwidth, width, midpoint, power]: [f64; 5], r: f64) -> (f64, f64) {
    if width <= MINVAL {
        return (0.5 * (d0 + dwidth), 0.0);
    }
    let x = r.abs() / width;
    if x == 0.0 {
        return (d0, 0.0);
    }
    if x >= 1.0 {
        return (dwidth, 0.0);
    }
    let (midpoint, power) = (midpoint.clamp(MINIMP, MAXIMP), power.max(1.0));
    let (y, dy) = if power == 1.0 {
        (x, 1.0)
    } else if x <= midpoint {
        let scale = pow(midpoint, power - 1.0);
        (pow(x, power) / scale, power * pow(x, power - 1.0) / scale)
    } else {
        let scale = pow(1.0 - midpoint, power - 1.0);
        (1.0 - pow(1.0 - x, power) / scale, power * pow(1.0 - x, power - 1.0) / scale)
    };
    let range = dwidth - d0;
    (d0 + y * range, dy * range / width * r.signum())
}

/// x^p, without a call of `pow` for the most common exponents.
#[inline]
fn pow(x: f64, p: f64) -> f64 {
    if p == 1.0 {
        x
    } else if p == 2.0 {
        x * x
    } else {
        libm::pow(x, p)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn impedance_is_continuous_and_monotone() {
        for power in [1.0, 1.5, 2.0, 3.0, 6.0] {
            let impedance_at = |r: f64| impedance([0.1, 0.9, 0.002, 0.3, power], r).0;
            let mut last = impedance_at(0.0);
            for i in 1..=4000 {
                let current = impedance_at(-1e-6 * f64::from(i));
                assert!(
                    current >= last && current - last < 0.01,
                    "power {power}, step {i}: {last} then {current}"
                );
                last = current;
            }
            assert_eq!(last, 0.9);
        }
    }

    #[test]
    fn slope_is_the_derivative() {
        for power in [1.0, 2.0, 3.5] {
            for r in [-1.7e-3, -0.4e-3, 0.3e-3, 1.2e-3] {
                let f = |r: f64| impedance([0.2, 0.95, 0.002, 0.5, power], r);
                let h = 1e-9;
                let numeric = (f(r + h).0 - f(r - h).0) / (2.0 * h);
                assert!((numeric - f(r).1).abs() < 1e-4 * numeric.abs(), "{numeric} {:?}", f(r));
            }
        }
    }

    #[test]
    fn mixed_signs_fall_back_to_the_default() {
        let mut m = Model::default();
        m.opt.timestep = 0.002;
        assert_eq!(safe_solref(&m, [0.1, -1.0]), [0.02, 1.0]);
        assert_eq!(safe_solref(&m, [-5.0, -1.0]), [-5.0, -1.0]);
        m.opt.timestep = 0.02;
        assert_eq!(safe_solref(&m, [0.02, 1.0]), [0.04, 1.0]);
        m.opt.disableflags = disable::REFSAFE;
        assert_eq!(safe_solref(&m, [0.02, 1.0]), [0.02, 1.0]);
    }
}
