//! Pseudorandom numbers, equal on every platform.

/// A linear congruential generator, equal on every platform (Knuth, MMIX).
#[derive(Clone, Debug)]
pub(super) struct Draws(u64);

impl Draws {
    pub(super) fn new(seed: u64) -> Draws {
        Draws(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ 0x2545_f491_4f6c_dd1d)
    }

    /// A number in 0..1.
    pub(super) fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }

    /// A number with a magnitude of 1e-3 to 1e3 and either sign.
    pub(super) fn any(&mut self) -> f64 {
        let size = 10f64.powf(6.0 * self.unit() - 3.0);
        if self.unit() < 0.5 { -size } else { size }
    }
}
