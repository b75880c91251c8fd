//! Which short ways of computing trees are allowed: all, but where one is measured or held against the general way.

/// A way of computing a tree that is shorter than the general one. `dynamics/ways` says what each is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Way {
    /// A single body with its inertia along its own axes.
    Simple,
    /// A few slides and hinges, one after the other.
    Chain,
    /// At most three degrees of freedom, one after the other: the factorization alone.
    Serial,
    /// Many degrees of freedom: the factorization alone.
    Articulated,
}

impl Way {
    /// All of them.
    pub const ALL: [Way; 4] = [Way::Simple, Way::Chain, Way::Serial, Way::Articulated];
}

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
    pub const ALL: Ways = Ways(0b1111);
    /// Every tree by the general one.
    pub const GENERAL: Ways = Ways(0);

    /// Whether a way is allowed.
    pub fn has(self, way: Way) -> bool {
        self.0 & (1 << way as u8) != 0
    }

    /// The same but for one.
    pub fn without(self, way: Way) -> Ways {
        Ways(self.0 & !(1 << way as u8))
    }
}
