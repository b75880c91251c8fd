//! Conversion of values to indexes.

use crate::number;
use crate::value::Value;

/// A number as an index, if it is an integer and not negative.
#[inline]
pub(super) fn whole_index(written: f64) -> Option<usize> {
    // The comparison is false for NaN, and a fraction is lost in the round trip.
    let index = if written >= 0.0 { written as usize } else { return None };
    (index as f64 == written).then_some(index)
}

/// The index that a key denotes: `"1"` is 1; `null` and `"01"` are not indexes.
pub(super) fn index_of(value: &Value) -> f64 {
    match value {
        Value::Number(x) => *x,
        Value::String(text) => {
            let x = number::from_text(text);
            if number::to_text(x) == **text { x } else { f64::NAN }
        }
        _ => f64::NAN,
    }
}
