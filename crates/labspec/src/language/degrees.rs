//! Words that say that one of two values is larger, or smaller.

/// The direction of a comparison.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// The value is larger.
    Larger,
    /// The value is smaller.
    Smaller,
}

impl Side {
    /// The other direction.
    pub fn opposite(self) -> Side {
        match self {
            Side::Larger => Side::Smaller,
            Side::Smaller => Side::Larger,
        }
    }
}

/// What a word compares, and in which direction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Degree {
    /// Any quantity: `larger`, `it grows`.
    Amount(Side),
    /// Lengths and times: `longer`.
    Length(Side),
    /// Times: `later`.
    Time(Side),
    /// Speeds, and inversely times: `faster`.
    Speed(Side),
}
