//! Turning points, computed from the values of a number at the Chebyshev points of an interval of two steps.

use super::event_time::EventTime;
use super::step_replay::{Evaluate, StepReplay};
use std::f64::consts::PI;

/// The degree of the polynomial.
const DEGREE: usize = 12;
/// The number of parts of the interval that are searched for turning points, and the bisections in one part.
const PARTS: usize = 48;
const BISECTIONS: usize = 60;

/// The turning point of a target near the second last state, a maximum or a minimum. For a method of high order, the steps are
/// repeated with other lengths; for others, the parabola through three states is used.
pub(super) fn turning_point(
    bench: &mut StepReplay<'_>,
    target: usize,
    direction: f64,
    dense: bool,
    evaluate: &Evaluate<'_>,
) -> Option<EventTime> {
    let count = bench.history.count();
    if count < 3 {
        return None;
    }
    let samples: Vec<f64> = (0..count).map(|j| direction * bench.value(j, 0.0, target, evaluate)).collect();
    // A displayed value may belong to the previous state.
    let middle = (1..count - 1).max_by(|&a, &b| samples[a].total_cmp(&samples[b]))?;
    let [before, current, after] = [samples.get(middle + 1)?, samples.get(middle)?, samples.get(middle - 1)?];
    let (h, next) = (bench.history.step(middle + 1), bench.history.step(middle));
    let start = bench.history.time(middle + 1);
    let top = direction > 0.0;
    let parabola = || {
        // Divided differences. The steps of a run have equal lengths up to rounding.
        let (rise, fall) = ((current - before) / h, (after - current) / next);
        let curvature = (fall - rise) / (0.5 * (h + next));
        let x = 0.5 * h - rise / curvature;
        let time = start + if x.is_finite() { x.clamp(0.0, h + next) } else { h };
        Some(EventTime { time, uncertainty: h + next, slope: f64::INFINITY, top })
    };
    if !dense {
        return parabola();
    }
    let half = 0.5 * (h + next);
    let mut node = |i: usize| {
        let x = half * (1.0 - (PI * i as f64 / DEGREE as f64).cos());
        direction
            * match x {
                x if x <= 0.0 => bench.value(middle + 1, 0.0, target, evaluate),
                x if x <= h => bench.value(middle + 1, x, target, evaluate),
                x => bench.value(middle, x - h, target, evaluate),
            }
    };
    // From the end of the interval to its start, in the order of the points.
    let values: Vec<f64> = (0..=DEGREE).rev().map(&mut node).collect();
    let every_second: Vec<f64> = values.iter().copied().step_by(2).collect();
    let Some((x, uncertainty)) = turn(&values) else { return parabola() };
    let other = turn(&every_second).map_or(2.0, |(y, _)| (x - y).abs());
    let uncertainty = half * (uncertainty + other).min(2.0);
    Some(EventTime { time: start + half * (1.0 + x), uncertainty, slope: f64::INFINITY, top })
}

/// The position of the maximum inside [-1, 1], from the values at the Chebyshev points from 1 down to -1,
/// and its shift by rounding.
fn turn(values: &[f64]) -> Option<(f64, f64)> {
    if values.iter().any(|v| !v.is_finite()) {
        return None;
    }
    let series = coefficients(values);
    let slope = derivative(&series);
    let curve = derivative(&slope);
    let point = |k: usize| -1.0 + 2.0 * k as f64 / PARTS as f64;
    let falls = |k: &usize| sum(&slope, point(*k)) > 0.0 && sum(&slope, point(*k + 1)) <= 0.0;
    let best = (0..PARTS)
        .filter(falls)
        .max_by(|&a, &b| sum(&series, point(a)).total_cmp(&sum(&series, point(b))))?;
    let (mut low, mut high) = (point(best), point(best + 1));
    for _ in 0..BISECTIONS {
        let middle = 0.5 * (low + high);
        if sum(&slope, middle) > 0.0 { low = middle } else { high = middle }
    }
    let x = 0.5 * (low + high);
    let size = values.iter().fold(0.0f64, |a, v| a.max(v.abs()));
    let last = series.iter().rev().take(2).fold(0.0f64, |a, c| a.max(c.abs()));
    let degree = (values.len() - 1) as f64;
    let noise = degree * degree * (2.0 * last).max(4.0 * f64::EPSILON * size);
    Some((x, noise / sum(&curve, x).abs().max(f64::MIN_POSITIVE)))
}

/// The coefficients of the Chebyshev polynomials.
fn coefficients(values: &[f64]) -> Vec<f64> {
    let n = values.len() - 1;
    let weight = |i: usize| if i == 0 || i == n { 0.5 } else { 1.0 };
    let coefficient = |j: usize| {
        let terms = values.iter().enumerate();
        let sum: f64 = terms.map(|(i, v)| weight(i) * v * (PI * (i * j) as f64 / n as f64).cos()).sum();
        2.0 / n as f64 * weight(j) * sum
    };
    (0..=n).map(coefficient).collect()
}

/// The series of the derivative.
fn derivative(series: &[f64]) -> Vec<f64> {
    let mut slope = vec![0.0; series.len() + 1];
    for j in (1..series.len()).rev() {
        slope[j - 1] = slope[j + 1] + 2.0 * j as f64 * series[j];
    }
    slope[0] *= 0.5;
    slope.truncate(series.len().saturating_sub(1).max(1));
    slope
}

/// The value of a series at a point, by Clenshaw's recurrence.
fn sum(series: &[f64], x: f64) -> f64 {
    let (mut one, mut two) = (0.0, 0.0);
    for c in series.iter().skip(1).rev() {
        (one, two) = (2.0 * x * one - two + c, one);
    }
    series.first().copied().unwrap_or(0.0) + x * one - two
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_top_of_a_sine_is_found_to_rounding() {
        let points = (0..=DEGREE).map(|i| (PI * i as f64 / DEGREE as f64).cos());
        let values: Vec<f64> = points.map(|x| (1.5 * (x - 0.123)).cos()).collect();
        let (x, uncertainty) = turn(&values).expect("a sine has a top");
        assert!((x - 0.123).abs() <= uncertainty && uncertainty < 1e-6, "{x} ± {uncertainty}");
        assert!(turn(&values.iter().map(|v| v * f64::NAN).collect::<Vec<_>>()).is_none());
    }
}
