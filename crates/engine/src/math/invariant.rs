//! A replacement for a value that an invariant of the engine guarantees.

/// Returns the default value (zero or an empty value) after a broken invariant. No input can break an invariant. A
/// debug build panics and states the invariant; a release build continues with the default.
#[cfg_attr(not(feature = "small"), inline(always))]
pub(crate) fn broken_invariant<T: Default>(invariant: &'static str) -> T {
    debug_assert!(false, "{invariant}");
    T::default()
}
