//! Which specialized tree algorithms are allowed: all, but where one is measured or compared with the general one.

/// An algorithm that computes a tree: a row of the table in `dynamics/tree_algorithms`, which says what each is.
#[derive(Clone, Copy, PartialEq, Eq)]
pub struct TreeAlgorithm(pub(crate) u8);

/// The algorithms that are allowed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TreeAlgorithms(u8);

impl Default for TreeAlgorithms {
    fn default() -> TreeAlgorithms {
        TreeAlgorithms::ALL
    }
}

impl TreeAlgorithms {
    /// Each tree by the first that covers it.
    pub const ALL: TreeAlgorithms = TreeAlgorithms(u8::MAX);
    /// Every tree by the general one.
    pub const GENERAL: TreeAlgorithms = TreeAlgorithms(0);

    /// Whether an algorithm is allowed.
    #[cfg_attr(not(feature = "small"), inline(always))]
    pub fn has(self, algorithm: TreeAlgorithm) -> bool {
        self.0 & (1 << algorithm.0) != 0
    }

    /// The same and one more.
    pub(crate) fn with(self, algorithm: TreeAlgorithm) -> TreeAlgorithms {
        TreeAlgorithms(self.0 | 1 << algorithm.0)
    }

    /// The same but for one.
    pub fn without(self, algorithm: TreeAlgorithm) -> TreeAlgorithms {
        TreeAlgorithms(self.0 & !(1 << algorithm.0))
    }
}
