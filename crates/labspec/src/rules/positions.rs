//! The probability of the observed positions of correct answers if the positions were random.

/// The probabilities of 0, 1, 2, … hits if each draw has its own probability: the exact distribution, draw by draw.
pub(super) fn hits(chances: &[f64]) -> Vec<f64> {
    let mut all = vec![1.0];
    for p in chances {
        let mut next = vec![0.0; all.len() + 1];
        for (n, q) in all.iter().enumerate() {
            if let Some(x) = next.get_mut(n) {
                *x += q * (1.0 - p);
            }
            if let Some(x) = next.get_mut(n + 1) {
                *x += q * p;
            }
        }
        all = next;
    }
    all
}

/// The probability of this many hits or more.
pub(super) fn at_least(chances: &[f64], count: usize) -> f64 {
    hits(chances).iter().skip(count).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 26 of 42 at one of four positions: the tail of the binomial distribution, computed with exact fractions.
    #[test]
    fn the_tail_is_that_of_the_binomial_distribution() {
        let choose = |n: u32, k: u32| (0..k).fold(1.0, |c, i| c * f64::from(n - i) / f64::from(i + 1));
        let term = |k: u32| choose(42, k) * 0.25_f64.powi(k as i32) * 0.75_f64.powi(42 - k as i32);
        let tail: f64 = (26..=42).map(term).sum();
        let p = at_least(&[0.25; 42], 26);
        assert!((p - tail).abs() < 1e-12 * tail.max(1e-3) && p < 1e-6, "{p} {tail}");
        assert!((at_least(&[0.5, 0.25], 1) - 0.625).abs() < 1e-15);
    }
}
