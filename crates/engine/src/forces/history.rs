//! Buffers of past values, for delays (MuJoCo's documentation, chapter "Computation", section on delays).
//!
//! A buffer is a ring of samples in the order of their times. It contains a slot for the owner, the index of the newest
//! sample, n times, and n times `dim` values. It is a part of the state, so that programs may write anything into it.
//! Therefore the index is always taken modulo n.

use crate::kinds::interpolation;
use crate::math::MINVAL;

/// The length of a buffer of `n` samples.
pub const fn size(n: usize, dim: usize) -> usize {
    if n == 0 { 0 } else { 2 + n.saturating_mul(1 + dim) }
}

/// The parts of a buffer.
struct Ring<'a> {
    times: &'a [f64],
    values: &'a [f64],
    newest: usize,
    n: usize,
    dim: usize,
}

impl<'a> Ring<'a> {
    /// The parts, or `None` if the buffer is too short for its samples.
    fn from_buffer(buf: &'a [f64], n: usize, dim: usize) -> Option<Ring<'a>> {
        let (head, rest) = buf.split_at_checked(2)?;
        let (times, values) = rest.split_at_checked(n)?;
        let fits = n > 0 && values.len() >= n * dim;
        fits.then(|| Ring { times, values, newest: newest(head, n), n, dim })
    }

    /// The index of sample `i`, counted from the oldest.
    fn place(&self, i: usize) -> usize {
        (self.newest + 1 + i) % self.n
    }

    fn time(&self, i: usize) -> f64 {
        self.times[self.place(i)]
    }

    fn value(&self, i: usize) -> &'a [f64] {
        let start = self.place(i) * self.dim;
        &self.values[start..start + self.dim]
    }

    /// The first sample that is not older than `time`, or n if all are older.
    fn first_from(&self, time: f64) -> usize {
        let (mut low, mut high) = (0, self.n);
        while low < high {
            let middle = low.midpoint(high);
            if self.time(middle) < time { low = middle + 1 } else { high = middle }
        }
        low
    }

    /// Slope of component `k` at sample `i`, computed from its neighbours; zero at the ends.
    fn slope(&self, i: usize, k: usize) -> f64 {
        if i == 0 || i + 1 == self.n {
            return 0.0;
        }
        (self.value(i + 1)[k] - self.value(i - 1)[k]) / (self.time(i + 1) - self.time(i - 1))
    }
}

/// The index of the newest sample.
fn newest(head: &[f64], n: usize) -> usize {
    head.get(1).map_or(0, |&x| x as usize) % n.max(1)
}

/// Fills a buffer with zero samples at the given times, oldest first. `slot` is the value of the owner's slot.
pub(crate) fn init(buf: &mut [f64], n: usize, slot: f64, time: impl Fn(usize) -> f64) {
    buf.fill(0.0);
    if let [first, newest, rest @ ..] = buf {
        (*first, *newest) = (slot, n.saturating_sub(1) as f64);
        for (i, t) in rest.iter_mut().take(n).enumerate() {
            *t = time(i);
        }
    }
}

/// Allocates a sample and returns its values for writing. It replaces the sample of the same time, or else the oldest sample.
pub(crate) fn insert(buf: &mut [f64], n: usize, dim: usize, time: f64) -> &mut [f64] {
    let Some(ring) = Ring::from_buffer(buf, n, dim) else { return &mut [] };
    let i = ring.first_from(time);
    let same = i < n && ring.time(i) == time;
    let (i, newest) = match i {
        _ if same => (i, ring.newest),
        0 => (0, ring.newest),
        i if i == n => (n - 1, (ring.newest + 1) % n),
        i => (i - 1, ring.newest),
    };
    let place = |i: usize| (newest + 1 + i) % n;
    buf[1] = newest as f64;
    let (times, values) = buf[2..].split_at_mut(n);
    if !same && newest == place(n - 1) && i + 1 < n {
        // Insertion in the middle: the older samples are shifted over the oldest.
        for older in 0..i {
            times[place(older)] = times[place(older + 1)];
            values.copy_within(place(older + 1) * dim..(place(older + 1) + 1) * dim, place(older) * dim);
        }
    }
    times[place(i)] = time;
    &mut values[place(i) * dim..(place(i) + 1) * dim]
}

/// The value at a time. Depending on `interp`, it is that of the last sample, a linear interpolation between two samples, or a
/// cubic one with the slopes of the samples (Catmull and Rom 1974). Before the first and after the last sample, it is the value
/// of that sample.
pub(crate) fn read(buf: &[f64], n: usize, dim: usize, time: f64, interp: i32, out: &mut [f64]) {
    let Some(ring) = Ring::from_buffer(buf, n, dim) else { return };
    let i = ring.first_from(time);
    // With a delay of whole steps, the sample is found in spite of rounding errors.
    let exact = i < n && ring.time(i) - time < MINVAL;
    if exact || i == 0 || i == n || interp == interpolation::HOLD {
        let last = if exact || i == 0 { i } else { i - 1 };
        out.copy_from_slice(ring.value(last));
        return;
    }
    let (before, after) = (i - 1, i);
    let h = ring.time(after) - ring.time(before);
    let s = (time - ring.time(before)) / h;
    for (k, x) in out.iter_mut().enumerate() {
        let (a, b) = (ring.value(before)[k], ring.value(after)[k]);
        *x = if interp == interpolation::LINEAR {
            a + s * (b - a)
        } else {
            let (s2, s3) = (s * s, s * s * s);
            let (rise, bend) = (3.0 * s2 - 2.0 * s3, h * (s3 - s2));
            a + rise * (b - a) + (bend - h * (s2 - s)) * ring.slope(before, k) + bend * ring.slope(after, k)
        };
    }
}

#[cfg(test)]
mod tests {
    use super::{init, insert, read, size};

    const N: usize = 5;

    fn buffer() -> Vec<f64> {
        let mut buf = vec![0.0; size(N, 1)];
        init(&mut buf, N, 0.0, |i| 0.1 * i as f64 - 0.5);
        buf
    }

    /// The ring after insertions, as in MuJoCo 3.14.0: index of the newest sample, times.
    #[test]
    fn samples_stay_in_the_order_of_their_times() {
        let cases: [(&[f64], [f64; 6]); 7] = [
            (&[1.0, 1.0], [0.0, 1.0, -0.4, -0.3, -0.2, -0.1]),
            (&[1.0, 2.0, 3.0, 4.0, 5.0, 6.0], [0.0, 6.0, 2.0, 3.0, 4.0, 5.0]),
            (&[1.0, 2.0, 3.0, 2.5], [2.0, 2.0, 2.5, 3.0, -0.1, 1.0]),
            (&[1.0, 2.0, 3.0, 2.0], [2.0, 1.0, 2.0, 3.0, -0.2, -0.1]),
            (&[1.0, 2.0, 3.0, 4.0, 5.0, 0.5], [4.0, 0.5, 2.0, 3.0, 4.0, 5.0]),
            (&[5.0, -7.0], [0.0, 5.0, -7.0, -0.3, -0.2, -0.1]),
            (&[1.0, 2.0, 3.0, 4.0, 5.0, 4.5, 3.5], [4.0, 3.0, 3.5, 4.0, 4.5, 5.0]),
        ];
        for (times, expected) in cases {
            let mut buf = buffer();
            for &t in times {
                insert(&mut buf, N, 1, t)[0] = t;
            }
            let got = &buf[1..7];
            assert!(got.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-12), "{times:?}: {got:?}");
            for i in 0..N {
                assert!(buf[7 + i] == 0.0 || buf[7 + i] == buf[2 + i]);
            }
        }
    }

    /// A time, and the values of MuJoCo 3.14.0 for hold, linear and cubic interpolation.
    #[test]
    fn values_between_samples() {
        let buf = [0.0, 4.0, 0.0, 1.0, 2.0, 4.0, 5.0, 1.0, 3.0, 2.0, 7.0, 5.0];
        for (time, expected) in [
            (-1.0, [1.0, 1.0, 1.0]),
            (0.25, [1.0, 1.5, 1.2890625]),
            (0.5, [1.0, 2.0, 1.9375]),
            (1.0, [3.0, 3.0, 3.0]),
            (1.5, [3.0, 2.5, 2.3958333333333335]),
            (2.5, [2.0, 3.25, 3.0625]),
            (4.5, [7.0, 6.0, 6.125]),
            (6.0, [5.0, 5.0, 5.0]),
        ] {
            for (interp, expected) in expected.into_iter().enumerate() {
                let mut x = [0.0];
                read(&buf, N, 1, time, interp as i32, &mut x);
                assert!((x[0] - expected).abs() < 1e-14, "{time} {interp}: {} instead of {expected}", x[0]);
            }
        }
    }

    #[test]
    fn invalid_buffers_cause_no_panic() {
        for bad in [f64::NAN, f64::INFINITY, -3.0, 1e300] {
            let mut buf = vec![bad; size(N, 2)];
            insert(&mut buf, N, 2, 1.0).fill(1.0);
            let mut out = [0.0; 2];
            (0..3).for_each(|interp| read(&buf, N, 2, 0.5, interp, &mut out));
        }
        assert!(insert(&mut [], N, 1, 0.0).is_empty() && size(0, 3) == 0);
    }
}
