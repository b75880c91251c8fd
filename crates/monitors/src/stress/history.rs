//! The history of a run: a limited number of samples at even intervals, however long the run is.

/// Stores a sample at every `every`-th call. Drops every second sample when there are too many.
#[derive(Debug)]
pub(super) struct RunHistory<T> {
    calls: usize,
    every: usize,
    most: usize,
    samples: Vec<T>,
}

impl<T> RunHistory<T> {
    /// A history that first stores a sample at every `every`-th call, and never has more than `most`.
    pub(super) fn new(every: usize, most: usize) -> RunHistory<T> {
        RunHistory { calls: 0, every, most, samples: Vec::new() }
    }

    /// Counts a call; `current` creates a sample when one is due.
    pub(super) fn observe(&mut self, current: impl FnOnce() -> T) {
        if self.calls.is_multiple_of(self.every) {
            self.samples.push(current());
            if self.samples.len() >= self.most {
                let mut odd = false;
                self.samples.retain(|_| {
                    odd = !odd;
                    odd
                });
                self.every *= 2;
            }
        }
        self.calls += 1;
    }

    /// The stored samples, the oldest first.
    pub(super) fn samples(&self) -> &[T] {
        &self.samples
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stored_samples_are_evenly_spaced() {
        let mut memory = RunHistory::new(4, 16);
        for k in 0..1000 {
            memory.observe(|| k);
        }
        let samples = memory.samples();
        assert!(samples.len() >= 7 && samples.len() < 16 && samples[0] == 0, "{samples:?}");
        assert!(samples.windows(2).all(|two| two[1] - two[0] == samples[1]), "{samples:?}");
        assert!(samples[samples.len() - 1] + samples[1] >= 1000, "{samples:?}");
    }
}
