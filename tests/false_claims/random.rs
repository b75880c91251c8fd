//! Random numbers that depend only on the seed (SplitMix64), and numbers as printed in a lesson.

pub(super) struct Random(pub(super) u64);

impl Random {
    pub(super) fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// A number below `n`; `n` must not be 0.
    pub(super) fn below(&mut self, n: usize) -> usize {
        (self.next() % n as u64) as usize
    }

    pub(super) fn pick<'a, T>(&mut self, list: &'a [T]) -> &'a T {
        &list[self.below(list.len())]
    }

    /// A number from `low` to `high`, on a grid of `steps` equal steps.
    pub(super) fn between(&mut self, low: f64, high: f64, steps: usize) -> f64 {
        let x = low + (high - low) * self.below(steps + 1) as f64 / steps as f64;
        format!("{x:.6}").parse().unwrap()
    }
}

/// A number with three significant digits, and its number of decimals. `None` if it is not finite, or too large or too small to
/// be printed without an exponent.
pub(super) fn printed(x: f64) -> Option<(String, usize)> {
    if !x.is_finite() || x.abs() < 2e-3 || x.abs() >= 1e4 {
        return None;
    }
    let decimals = (2 - x.abs().log10().floor() as i32).clamp(1, 6) as usize;
    Some((format!("{x:.decimals$}"), decimals))
}
