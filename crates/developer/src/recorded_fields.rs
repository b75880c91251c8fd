//! What a recording holds, for its JSON Schema. The rows themselves are [`NumberFields`], because `nonfinite` has its place in
//! the order of their keys.

use super::number_fields::{NonfiniteFields, NumberFields, NumberList};
use schemars::{JsonSchema, Schema, SchemaGenerator};
use std::borrow::Cow;

/// A contact.
#[derive(JsonSchema)]
#[schemars(rename = "contact")]
#[expect(dead_code, reason = "only the schema is made of it")]
struct ContactFields {
    /// The first geom.
    geom1: usize,
    /// The second geom.
    geom2: usize,
    /// Distance.
    dist: Option<f64>,
    /// Position.
    pos: NumberList,
    /// Axes of its frame.
    frame: NumberList,
    /// Coefficients of friction.
    friction: NumberList,
    /// Dimensions of its friction.
    dim: usize,
    /// Parameters of its reference acceleration.
    solref: NumberList,
    /// Parameters of its impedance.
    solimp: NumberList,
    /// The names of those of its numbers that are null.
    #[schemars(skip_serializing_if = "Option::is_none", with = "NonfiniteFields")]
    nonfinite: Option<NonfiniteFields>,
}

/// A sample.
#[derive(JsonSchema)]
#[schemars(rename = "sample")]
#[expect(dead_code, reason = "only the schema is made of it")]
pub(crate) struct TrajectoryFields {
    /// Time, in seconds.
    time: Option<f64>,
    /// Position.
    qpos: NumberList,
    /// Velocity.
    qvel: NumberList,
    /// Activation of actuators.
    act: NumberList,
    /// Contacts.
    ncon: usize,
    /// Rows of constraints.
    nefc: usize,
    /// The names of those of its numbers that are null.
    #[schemars(skip_serializing_if = "Option::is_none", with = "NonfiniteFields")]
    nonfinite: Option<NonfiniteFields>,
}

/// Fields of the data, and the contacts.
pub(crate) struct ForwardFields;

impl JsonSchema for ForwardFields {
    fn schema_name() -> Cow<'static, str> {
        "forward".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let mut contacts = generator.subschema_for::<Vec<ContactFields>>();
        contacts.insert("description".into(), "The contacts, by their geoms.".into());
        let mut fields = NumberFields::json_schema(generator);
        fields.insert("description".into(), "Fields of the data that the recording names.".into());
        if let Some(properties) = fields.get_mut("properties") {
            properties["contact"] = contacts.to_value();
        }
        fields
    }
}
