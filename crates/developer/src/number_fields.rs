//! Numbers by name, as `record` reports them.

use labspec::report::{NonfiniteEntries, NonfiniteName, nonfinite};
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::ser::{Serialize, SerializeMap, Serializer};
use std::borrow::Cow;

/// An object of numbers in the order of the list. JSON has no NaN and no infinities: such a number is `null`, and the entry
/// `nonfinite`, after the first one that contains such a number, contains their names under the same keys.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct NumberFields(pub Vec<(String, Numbers)>);

/// The value of an entry.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
#[serde(untagged)]
pub enum Numbers {
    /// A size or an index.
    Count(usize),
    /// A number.
    One(f64),
    /// The values of a field, row by row.
    List(Vec<f64>),
    /// Objects, such as contacts.
    Objects(Vec<NumberFields>),
}

/// The names of numbers that JSON cannot represent; for a list, the index and the name of each.
#[derive(serde::Serialize)]
#[serde(untagged)]
enum Nonfinite {
    One(&'static str),
    List(Vec<(usize, &'static str)>),
}

impl Numbers {
    /// The number of values.
    fn count_values(&self) -> usize {
        match self {
            Numbers::Count(_) | Numbers::One(_) => 1,
            Numbers::List(values) => values.len(),
            Numbers::Objects(objects) => objects.iter().map(NumberFields::count_values).sum(),
        }
    }

    fn nonfinite(&self) -> Option<Nonfinite> {
        match self {
            Numbers::One(x) => nonfinite(*x).map(Nonfinite::One),
            Numbers::List(values) => {
                let named: Vec<_> =
                    values.iter().enumerate().filter_map(|(i, x)| Some((i, nonfinite(*x)?))).collect();
                (!named.is_empty()).then_some(Nonfinite::List(named))
            }
            Numbers::Count(_) | Numbers::Objects(_) => None,
        }
    }
}

impl NumberFields {
    /// Creates an object of N numbers.
    pub fn new<const N: usize>(fields: [(&str, Numbers); N]) -> NumberFields {
        NumberFields(fields.map(|(name, numbers)| (name.to_string(), numbers)).into())
    }

    /// The number of values.
    pub(crate) fn count_values(&self) -> usize {
        self.0.iter().map(|(_, numbers)| numbers.count_values()).sum()
    }
}

impl Serialize for NumberFields {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        struct NonfiniteOf<'a>(&'a [(String, Numbers)]);
        impl Serialize for NonfiniteOf<'_> {
            fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
                serializer.collect_map(
                    self.0.iter().filter_map(|(name, numbers)| Some((name, numbers.nonfinite()?))),
                )
            }
        }
        let first = self.0.iter().position(|(_, numbers)| numbers.nonfinite().is_some());
        let mut map = serializer.serialize_map(None)?;
        for (i, (name, numbers)) in self.0.iter().enumerate() {
            map.serialize_entry(name, numbers)?;
            if first == Some(i) {
                map.serialize_entry("nonfinite", &NonfiniteOf(&self.0))?;
            }
        }
        map.end()
    }
}

impl JsonSchema for NumberFields {
    fn schema_name() -> Cow<'static, str> {
        "fields".into()
    }

    /// Objects within it have names of their own: whoever expects them says so.
    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        json_schema!({
            "description": "Fields by MuJoCo's names.",
            "type": "object",
            "properties": {"nonfinite": generator.subschema_for::<NonfiniteFields>()},
            "additionalProperties": generator.subschema_for::<Field>(),
        })
    }
}

/// The values of a field as JSON has them.
pub(crate) struct NumberList;

impl JsonSchema for NumberList {
    fn schema_name() -> Cow<'static, str> {
        "numbers".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let mut list = generator.subschema_for::<Vec<Option<f64>>>();
        list.insert("description".into(), "The values of a field, row by row.".into());
        list
    }
}

/// A field as JSON has it.
struct Field;

impl JsonSchema for Field {
    fn schema_name() -> Cow<'static, str> {
        "field".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let (one, list) = (generator.subschema_for::<Option<f64>>(), generator.subschema_for::<NumberList>());
        json_schema!({"description": "A field: a size, or its values.", "anyOf": [one, list]})
    }
}

/// The names of numbers that JSON cannot represent, by field.
pub(crate) struct NonfiniteFields;

impl JsonSchema for NonfiniteFields {
    fn schema_name() -> Cow<'static, str> {
        "nonfiniteOf".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let name = generator.subschema_for::<NonfiniteName>();
        let entries = generator.subschema_for::<NonfiniteEntries>();
        json_schema!({
            "description": "Under the name of a field: what those numbers are that are null. Absent when every number is one.",
            "type": "object",
            "additionalProperties": {"anyOf": [name, entries]},
        })
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)] // a panic is the report of a failed test
mod tests {
    use super::*;

    #[test]
    fn nonfinite_fields_are_named() {
        let inner = NumberFields::new([("dist", Numbers::One(f64::NEG_INFINITY))]);
        let row = NumberFields::new([
            ("n", Numbers::Count(2)),
            ("a", Numbers::List(vec![-0.0, f64::NAN, 1.5])),
            ("b", Numbers::One(f64::INFINITY)),
            ("contact", Numbers::Objects(vec![inner])),
        ]);
        let text = r#"{"n":2,"a":[-0.0,null,1.5],"nonfinite":{"a":[[1,"NaN"]],"b":"Infinity"},"b":null,"contact":[{"dist":null,"nonfinite":{"dist":"-Infinity"}}]}"#;
        assert_eq!(serde_json::to_string(&row).unwrap(), text);
        assert_eq!(serde_json::to_value(&row).unwrap().to_string(), text);
        assert_eq!(row.count_values(), 6);
    }
}
