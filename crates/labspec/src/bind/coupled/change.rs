//! How an element of a partner changes.

/// How an element of a partner changes.
#[derive(Clone, Copy, Debug)]
pub(super) enum PartnerChange {
    Times(f64),
    Plus(f64),
    Becomes(f64),
}

/// What of a partner changes: an element of its field, and how.
pub(super) type Changes = Vec<(usize, PartnerChange)>;
