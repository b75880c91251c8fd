//! The change of an element of a coupled parameter.

/// The change of an element of a coupled parameter.
#[derive(Clone, Copy, Debug)]
pub(super) enum PartnerChange {
    Times(f64),
    Plus(f64),
    Becomes(f64),
}

/// Changes of a coupled parameter: the index of the element, and its change.
pub(super) type Changes = Vec<(usize, PartnerChange)>;
