//! Serializes numbers as their bits, with `#[serde(with = "float_bits")]`: JSON has no NaN and no infinity.

use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// A number, or an optional number, and its stored form.
pub(crate) trait Bits: Copy {
    type Stored: Serialize + for<'de> Deserialize<'de>;
    fn to_stored(self) -> Self::Stored;
    fn of_stored(stored: Self::Stored) -> Self;
}

impl Bits for f64 {
    type Stored = u64;
    fn to_stored(self) -> u64 {
        self.to_bits()
    }
    fn of_stored(stored: u64) -> f64 {
        f64::from_bits(stored)
    }
}

impl Bits for Option<f64> {
    type Stored = Option<u64>;
    fn to_stored(self) -> Option<u64> {
        self.map(f64::to_bits)
    }
    fn of_stored(stored: Option<u64>) -> Option<f64> {
        stored.map(f64::from_bits)
    }
}

pub(crate) fn serialize<T: Bits, S: Serializer>(number: &T, to: S) -> Result<S::Ok, S::Error> {
    number.to_stored().serialize(to)
}

pub(crate) fn deserialize<'de, T: Bits, D: Deserializer<'de>>(from: D) -> Result<T, D::Error> {
    Ok(T::of_stored(T::Stored::deserialize(from)?))
}
