//! The specialized tree algorithms that are allowed: all, unless one is measured or compared with the general one.

/// An algorithm for a tree: the index of a row of the table in `dynamics/tree_algorithms`, which describes each.
#[derive(Clone, Copy, PartialEq, Eq)]
pub struct TreeAlgorithm(pub(crate) u8);

/// The set of algorithms that are allowed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TreeAlgorithms(u8);

impl Default for TreeAlgorithms {
    fn default() -> TreeAlgorithms {
        TreeAlgorithms::ALL
    }
}

impl TreeAlgorithms {
    /// All algorithms: each tree uses the first one that covers it.
    pub const ALL: TreeAlgorithms = TreeAlgorithms(u8::MAX);
    /// The general algorithm only.
    pub const GENERAL: TreeAlgorithms = TreeAlgorithms(0);

    /// Whether an algorithm is allowed.
    #[cfg_attr(not(feature = "small"), inline(always))]
    pub fn has(self, algorithm: TreeAlgorithm) -> bool {
        self.0 & (1 << algorithm.0) != 0
    }

    /// The set with an additional algorithm.
    pub(crate) fn with(self, algorithm: TreeAlgorithm) -> TreeAlgorithms {
        TreeAlgorithms(self.0 | 1 << algorithm.0)
    }

    /// The set without one algorithm.
    pub fn without(self, algorithm: TreeAlgorithm) -> TreeAlgorithms {
        TreeAlgorithms(self.0 & !(1 << algorithm.0))
    }
}
