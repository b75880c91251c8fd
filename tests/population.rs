//! Tests of large populations (thousands of random settings, all planted mistakes) take a sample, unless nothing may be left
//! out.

use crate::needs::requires_all;

/// Whether tests take all cases of their populations: nothing may be left out, or pages are written that count all of them.
pub(crate) fn takes_all() -> bool {
    requires_all() || std::env::var_os("LABSPEC_BLESS").is_some()
}

/// The cases of a population that a test takes: all of them, or one of `step`.
pub(crate) fn sample<T>(population: Vec<T>, step: usize) -> Vec<T> {
    if takes_all() {
        return population;
    }
    population.into_iter().step_by(step).collect()
}

/// The minimum number of results of a population that a sample by [`sample`] must have: half of its share.
pub(crate) fn minimum(count: usize, step: usize) -> usize {
    if takes_all() { count } else { count / (2 * step) }
}
