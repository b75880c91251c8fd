//! Collocation at the three points of Gauss: of sixth order, and symmetric in time.
//!
//! The state is a polynomial whose slope is that of the equations at three times within the step (Hairer, Lubich and Wanner
//! 2006, *Geometric Numerical Integration*, sections II.1 and V.2). The stages are found by iteration. Played backwards the
//! method returns where it came from, and what is quadratic in velocities alone it keeps: the energy of a body that turns freely to
//! 1e-14 of itself, as measured (chapter XI there says why).

use super::explicit::along;
use super::flow;
use crate::model::{Fields, Model};
use crate::step::stages::Flow;
use crate::step::workspace::Scratch;

/// √15
const R: f64 = 3.872_983_346_207_417;
const NODES: [f64; 3] = [0.5 - R / 10.0, 0.5, 0.5 + R / 10.0];
const ROWS: [[f64; 3]; 3] = [
    [5.0 / 36.0, 2.0 / 9.0 - R / 15.0, 5.0 / 36.0 - R / 30.0],
    [5.0 / 36.0 + R / 24.0, 2.0 / 9.0, 5.0 / 36.0 - R / 24.0],
    [5.0 / 36.0 + R / 30.0, 2.0 / 9.0 + R / 15.0, 5.0 / 36.0],
];
const WEIGHTS: [f64; 3] = [5.0 / 18.0, 4.0 / 9.0, 5.0 / 18.0];

/// Rounds of the iteration at most, and parts that a step is cut into where it does not settle.
const ROUNDS: usize = 60;
const PARTS: usize = 64;

/// A step: whole if the iteration settles, else in as many equal parts as it takes, up to a limit. Beyond that a part is taken as
/// the iteration left it.
pub(super) fn gauss(m: &Model, d: &mut Fields, s: &mut Scratch) {
    let h = m.opt.timestep;
    // Three stages, and the next guess of one.
    let mut w = flow::enter(m, d, s, 4);
    let mut parts = 1;
    while !settles(m, d, s, &mut w, h / parts as f64) && parts < PARTS {
        parts *= 2;
    }
    for _ in 1..parts {
        flow::go_on(m, d, s, &mut w, h / parts as f64);
        settles(m, d, s, &mut w, h / parts as f64);
    }
    flow::finish(m, d, s, w);
}

/// A part of the step, to `w.end`; whether its stages settled.
fn settles(m: &Model, d: &mut Fields, s: &mut Scratch, w: &mut Flow, h: f64) -> bool {
    let n = w.start.len();
    let (mut rows, mut end) = (std::mem::take(&mut w.rows), std::mem::take(&mut w.end));
    let (stages, rest) = rows.split_at_mut(3 * n);
    let new = &mut rest[..n];
    (0..3).for_each(|i| stages[i * n..][..n].copy_from_slice(&w.first));
    let (mut last, mut settled) = (f64::INFINITY, false);
    for round in 0..ROUNDS {
        let mut change = 0.0f64;
        for i in 0..3 {
            along(&w.start, h, &ROWS[i], stages, &mut end);
            flow::slope(m, d, s, w, h * NODES[i], &end, new);
            // Only what it changes of the state counts.
            for (old, &new) in stages[i * n..][..n].iter_mut().zip(&*new) {
                let size = 1.0 + old.abs().max(new.abs());
                change = if new.is_finite() { change.max((new - *old).abs() / size) } else { f64::INFINITY };
                *old = new;
            }
            if d.meter.over() {
                break;
            }
        }
        // Rounding is reached where it does not come closer any more.
        settled = change < 4.0 * f64::EPSILON || (change < 1e-12 && change >= last);
        // Where it does not come closer it never will.
        if settled || !change.is_finite() || d.meter.over() || (round > 2 && change >= last) {
            break;
        }
        last = change;
    }
    along(&w.start, h, &WEIGHTS, stages, &mut end);
    (w.rows, w.end) = (rows, end);
    settled || d.meter.over()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Collocation: Σ a cᵏ⁻¹ = cᵏ/k for each row, and the weights likewise up to order 6.
    #[test]
    fn conditions_of_order() {
        let sum = |row: &[f64; 3], k: i32| row.iter().zip(NODES).map(|(a, c)| a * c.powi(k - 1)).sum::<f64>();
        for k in 1..=6 {
            assert!((sum(&WEIGHTS, k) - 1.0 / f64::from(k)).abs() < 1e-15, "{k}");
        }
        for (row, c) in ROWS.iter().zip(NODES) {
            for k in 1..=3 {
                assert!((sum(row, k) - c.powi(k) / f64::from(k)).abs() < 1e-15, "{k}");
            }
        }
    }
}
