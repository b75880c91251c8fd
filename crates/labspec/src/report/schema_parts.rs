//! Parts of the JSON Schemas of reports that several crates use. No value has one of these types: a field that is written in a
//! form of its own names one of them in its attribute `schemars(with = …)`.

use super::nonfinite;
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use std::borrow::Cow;
use std::marker::PhantomData;

/// The name of a number that JSON cannot represent.
pub struct NonfiniteName;

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
pub struct NonfiniteEntries;

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

/// All fields of a type, as a part of an object with further fields. The object is closed, and the definition of the part
/// is open.
pub struct PartOf<T>(PhantomData<T>);

impl<T: JsonSchema> JsonSchema for PartOf<T> {
    fn inline_schema() -> bool {
        true
    }

    fn schema_name() -> Cow<'static, str> {
        format!("PartOf_{}", T::schema_name()).into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        json_schema!({"allOf": [generator.subschema_for::<T>()]})
    }
}
