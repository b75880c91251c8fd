//! Which short ways of computing trees are allowed: all, but where one is measured or held against the general way.

/// A way of computing a tree: a row of the table in `dynamics/ways`, which says what each is.
#[derive(Clone, Copy, PartialEq, Eq)]
pub struct Way(pub(crate) u8);

/// The ways that are allowed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Ways(u8);

impl Default for Ways {
    fn default() -> Ways {
        Ways::ALL
    }
}

impl Ways {
    /// Each tree by the shortest.
    pub const ALL: Ways = Ways(u8::MAX);
    /// Every tree by the general one.
    pub const GENERAL: Ways = Ways(0);

    /// Whether a way is allowed.
    #[cfg_attr(not(feature = "small"), inline(always))]
    pub fn has(self, way: Way) -> bool {
        self.0 & (1 << way.0) != 0
    }

    /// The same and one more.
    pub(crate) fn with(self, way: Way) -> Ways {
        Ways(self.0 | 1 << way.0)
    }

    /// The same but for one.
    pub fn without(self, way: Way) -> Ways {
        Ways(self.0 & !(1 << way.0))
    }
}
