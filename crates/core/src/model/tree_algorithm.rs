//! Which short ways of computing trees are allowed: all, but where one is measured or held against the general way.

/// A way of computing a tree: a row of the table in `dynamics/ways`, which says what each is.
#[derive(Clone, Copy, PartialEq, Eq)]
pub struct TreeAlgorithm(pub(crate) u8);

/// The ways that are allowed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TreeAlgorithms(u8);

impl Default for TreeAlgorithms {
    fn default() -> TreeAlgorithms {
        TreeAlgorithms::ALL
    }
}

impl TreeAlgorithms {
    /// Each tree by the shortest.
    pub const ALL: TreeAlgorithms = TreeAlgorithms(u8::MAX);
    /// Every tree by the general one.
    pub const GENERAL: TreeAlgorithms = TreeAlgorithms(0);

    /// Whether a way is allowed.
    #[cfg_attr(not(feature = "small"), inline(always))]
    pub fn has(self, way: TreeAlgorithm) -> bool {
        self.0 & (1 << way.0) != 0
    }

    /// The same and one more.
    pub(crate) fn with(self, way: TreeAlgorithm) -> TreeAlgorithms {
        TreeAlgorithms(self.0 | 1 << way.0)
    }

    /// The same but for one.
    pub fn without(self, way: TreeAlgorithm) -> TreeAlgorithms {
        TreeAlgorithms(self.0 & !(1 << way.0))
    }
}
