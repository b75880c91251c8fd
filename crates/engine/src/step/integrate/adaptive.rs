//! Divides a step into parts, and uses a high order, so that the result is accurate to rounding where forces are smooth. The
//! method is slow and accurate, for reference solutions.
//!
//! The midpoint rule with 2, 4, 6, … steps over the same time has an error in even powers of the step length. The table of Aitken
//! and Neville eliminates these powers one by one, and the difference of the last two entries estimates the error (Bulirsch and
//! Stoer 1966; Hairer, Nørsett and Wanner 1993, *Solving Ordinary Differential Equations I*, section II.9). If 16 steps do not
//! agree with 14, as at the start of a contact, half the time is tried.

use super::flow;
use crate::math::combine;
use crate::model::{Fields, Model};
use crate::step::stages::Flow;
use crate::step::workspace::StepScratch;

/// Lines of the table: 2, 4, … steps.
const LINES: usize = 8;
/// The largest error of a part, relative to 1 plus the magnitude of each number.
const TOLERANCE: f64 = 1e-13;
/// The smallest part of a step is 1/2^14 of it. A smaller part is not tried, and the result is accepted although it is not
/// smooth.
const HALVINGS: u32 = 14;
/// Limit for the parts of a step. Beyond it, the rest of the step is one part.
const PARTS: usize = 4096;

/// A step.
pub(super) fn adaptive(m: &Model, d: &mut Fields, s: &mut StepScratch) {
    let h = m.opt.timestep;
    // Memory for the table, and for three states of the midpoint rule.
    let mut w = flow::enter(m, d, s, LINES + 3);
    // Times are counted in units of the smallest part, so that there are no rounding errors.
    let whole = 1u32 << HALVINGS;
    let (mut done, mut part, mut parts) = (0, whole, 0);
    loop {
        let length = h * f64::from(part) / f64::from(whole);
        let good = extrapolate(m, d, s, &mut w, length);
        if !good && part > 1 && parts < PARTS && !d.meter.over() {
            part /= 2;
            parts += 1;
            continue;
        }
        done += part;
        parts += 1;
        if done >= whole {
            break;
        }
        flow::begin_next_part(m, d, s, &mut w, length);
        // Doubles the length of the part, if the current time is a multiple of the doubled length.
        if good && done % (2 * part) == 0 {
            part *= 2;
        }
        if parts >= PARTS {
            part = whole - done;
        }
    }
    flow::finish(m, d, s, w);
}

/// Computes a part of the step, to `w.end`. Returns whether it has the required accuracy.
fn extrapolate(m: &Model, d: &mut Fields, s: &mut StepScratch, w: &mut Flow, h: f64) -> bool {
    let n = w.start.len();
    if n == 0 {
        return true;
    }
    let (mut rows, mut end) = (std::mem::take(&mut w.rows), std::mem::take(&mut w.end));
    let (table, states) = rows.split_at_mut(LINES * n);
    let (mut good, mut before) = (false, f64::INFINITY);
    for line in 0..LINES {
        midpoint(m, d, s, w, h, 2 * (line + 1), states);
        end.copy_from_slice(&states[..n]);
        // The line of the table: entry k replaces entry k of the line above.
        let mut error = 0.0f64;
        for (i, new) in end.iter_mut().enumerate() {
            let mut x = *new;
            for k in 0..line {
                let above = table[k * n + i];
                table[k * n + i] = x;
                let ratio = (line + 1) as f64 / (line - k) as f64;
                let step = (x - above) / (ratio * ratio - 1.0);
                x += step;
                if k + 1 == line {
                    error = larger(error, step / (1.0 + x.abs()));
                }
            }
            table[line * n + i] = x;
            *new = x;
        }
        good = line > 0 && error <= TOLERANCE;
        // At the level of rounding errors, more lines do not improve the result.
        let stuck = line > 2 && error >= before;
        if good || stuck || error.is_nan() || error == f64::INFINITY || d.meter.over() {
            good |= stuck && error < 30.0 * TOLERANCE;
            break;
        }
        before = if line > 0 { error } else { before };
    }
    (w.rows, w.end) = (rows, end);
    good
}

/// The maximum of an error and the magnitude of a number; infinite if the number is not finite.
fn larger(error: f64, x: f64) -> f64 {
    if x.is_finite() { error.max(x.abs()) } else { f64::INFINITY }
}

/// Gragg's method: an Euler step, then steps of twice the length from the second-last state, with smoothing at the end. The
/// first of the three states becomes the result.
fn midpoint(
    m: &Model,
    d: &mut Fields,
    s: &mut StepScratch,
    w: &Flow,
    h: f64,
    steps: usize,
    states: &mut [f64],
) {
    let n = w.first.len();
    let (older, rest) = states.split_at_mut(n);
    let (old, rest) = rest.split_at_mut(n);
    let slope = &mut rest[..n];
    let length = h / steps as f64;
    older.copy_from_slice(&w.start);
    old.copy_from_slice(&w.start);
    combine(old, [&*w.first], |y, [k]| y + length * k);
    for step in 1..steps {
        flow::slope(m, d, s, w, length * step as f64, old, slope);
        combine(older, [&*slope], |y, [k]| y + 2.0 * length * k);
        older.swap_with_slice(old);
    }
    flow::slope(m, d, s, w, h, old, slope);
    combine(older, [&*old, &*slope], |older, [y, k]| 0.5 * (y + older + length * k));
}
