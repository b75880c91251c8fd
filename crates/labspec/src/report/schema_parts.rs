//! A part of the JSON Schemas of reports: fields that several objects have. No value has this type: a field names it in its
//! attribute `schemars(with = …)`.

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use std::borrow::Cow;
use std::marker::PhantomData;

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
