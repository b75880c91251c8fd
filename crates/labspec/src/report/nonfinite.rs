//! The names of numbers that JSON cannot represent, and what schemas say of them.

#[cfg(feature = "report")]
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
#[cfg(feature = "report")]
use std::borrow::Cow;

/// The name of a number that JSON cannot represent: `NaN`, `Infinity` or `-Infinity`; `None` for every other number.
pub fn nonfinite(x: f64) -> Option<&'static str> {
    match x {
        x if x.is_nan() => Some("NaN"),
        f64::INFINITY => Some("Infinity"),
        f64::NEG_INFINITY => Some("-Infinity"),
        _ => None,
    }
}

/// The name of a number that JSON cannot represent.
#[cfg(feature = "report")]
pub struct NonfiniteName;

#[cfg(feature = "report")]
impl JsonSchema for NonfiniteName {
    fn schema_name() -> Cow<'static, str> {
        "nonfinite".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        let names = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY].map(nonfinite);
        json_schema!({"description": "What a number was for which JSON has none.", "enum": names})
    }
}

/// The names of the numbers in a list that JSON cannot represent.
#[cfg(feature = "report")]
pub struct NonfiniteEntries;

#[cfg(feature = "report")]
impl JsonSchema for NonfiniteEntries {
    fn schema_name() -> Cow<'static, str> {
        "nonfiniteEntries".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let mut entries = generator.subschema_for::<Vec<(usize, NonfiniteName)>>();
        let description = "For each of the numbers in a list: its index, and what it was.";
        entries.insert("description".into(), description.into());
        entries
    }
}
