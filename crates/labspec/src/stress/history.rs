//! The history of a run: a limited number of samples at even intervals, however long the run is.

/// Stores a sample at every `every`-th call. Drops every second sample when there are too many.
#[derive(Debug)]
pub(super) struct RunHistory<T> {
    looks: usize,
    every: usize,
    most: usize,
    past: Vec<T>,
}

impl<T> RunHistory<T> {
    /// A history that first stores a sample at every `every`-th call, and never has more than `most`.
    pub(super) fn new(every: usize, most: usize) -> RunHistory<T> {
        RunHistory { looks: 0, every, most, past: Vec::new() }
    }

    /// Counts a call; `now` creates a sample when one is due.
    pub(super) fn observe(&mut self, now: impl FnOnce() -> T) {
        if self.looks.is_multiple_of(self.every) {
            self.past.push(now());
            if self.past.len() >= self.most {
                let mut odd = false;
                self.past.retain(|_| {
                    odd = !odd;
                    odd
                });
                self.every *= 2;
            }
        }
        self.looks += 1;
    }

    /// The stored samples, the oldest first.
    pub(super) fn past(&self) -> &[T] {
        &self.past
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_remembered_is_spread_evenly() {
        let mut memory = RunHistory::new(4, 16);
        for k in 0..1000 {
            memory.observe(|| k);
        }
        let past = memory.past();
        assert!(past.len() >= 7 && past.len() < 16 && past[0] == 0, "{past:?}");
        assert!(past.windows(2).all(|two| two[1] - two[0] == past[1]), "{past:?}");
        assert!(past[past.len() - 1] + past[1] >= 1000, "{past:?}");
    }
}
