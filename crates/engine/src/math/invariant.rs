//! What stands in the place of a value that an invariant of the engine gives.

/// The value where an invariant is broken, which no input can cause: a debug build stops and states the invariant, a release build
/// goes on with zero, or with nothing.
#[cfg_attr(not(feature = "small"), inline(always))]
pub(crate) fn broken_invariant<T: Default>(invariant: &'static str) -> T {
    debug_assert!(false, "{invariant}");
    T::default()
}
