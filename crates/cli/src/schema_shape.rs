//! What the schemas of all reports have in common, and no attribute of a type states: objects are closed, an object with numbers
//! that may be nonfinite has the entry `nonfinite`, definitions are named as keys are, and keywords have one order.

use super::schema_words::NONFINITE;
use schemars::Schema;
use schemars::transform::transform_subschemas;
use serde_json::{Map, Value, json};
use std::collections::{BTreeMap, BTreeSet};

/// The start of a reference to a definition.
const DEFINITIONS: &str = "#/$defs/";
/// Keywords in the order in which people read them.
const ORDER: [&str; 20] = [
    "$schema",
    "title",
    "description",
    "type",
    "const",
    "enum",
    "minimum",
    "maximum",
    "$ref",
    "allOf",
    "anyOf",
    "required",
    "properties",
    "prefixItems",
    "items",
    "minItems",
    "maxItems",
    "additionalProperties",
    "unevaluatedProperties",
    "$defs",
];

/// Finishes a schema that was derived from the type of a report.
pub(super) fn finish(mut schema: Schema) -> Value {
    complete(&mut schema);
    let mut schema = schema.to_value();
    open_parts(&mut schema);
    rename_definitions(&mut schema);
    schema
}

/// Completes a schema and everything in it.
fn complete(schema: &mut Schema) {
    // Sizes of Rust's numbers, and values that Rust fills in, say nothing about a report.
    for noise in ["format", "default"] {
        schema.remove(noise);
    }
    if let Some(Value::String(text)) = schema.get_mut("description") {
        // Further paragraphs are for those who read the code.
        *text = text.split("\n\n").next().unwrap_or_default().replace('\n', " ");
    }
    join_words(schema);
    name_nonfinite(schema);
    transform_subschemas(&mut complete, schema);
    close(schema);
    arrange(schema);
}

/// Turns a choice of words, some with a description of their own, into a list of words.
fn join_words(schema: &mut Schema) {
    let Some(Value::Array(choices)) = schema.get("oneOf") else { return };
    let words_of = |choice: &Value| match (&choice["const"], &choice["enum"]) {
        (Value::Null, Value::Array(words)) => Some(words.clone()),
        (Value::Null, _) => None,
        (word, _) => Some(vec![word.clone()]),
    };
    if let Some(words) = choices.iter().map(words_of).collect::<Option<Vec<_>>>() {
        schema.remove("oneOf");
        schema.insert("type".into(), "string".into());
        schema.insert("enum".into(), words.concat().into());
    }
}

/// Gives an object with numbers that may be nonfinite the entry with their names.
fn name_nonfinite(schema: &mut Schema) {
    let Some(Value::Object(properties)) = schema.get_mut("properties") else { return };
    let mut names = Map::new();
    for (key, property) in properties.iter_mut() {
        if let Some(name) = property.as_object_mut().and_then(|p| p.remove(NONFINITE)) {
            names.insert(key.clone(), name);
        }
    }
    if !names.is_empty() {
        let entry = json!({
            "description": "Under the key of a number or of a list of numbers: what those are that are null. Absent when every number is one.",
            "type": "object",
            "properties": names,
        });
        properties.insert("nonfinite".into(), entry);
    }
}

/// Refuses keys that an object does not name.
fn close(schema: &mut Schema) {
    let keywords = ["additionalProperties", "unevaluatedProperties"];
    if schema.get("properties").is_some() && keywords.iter().all(|key| schema.get(*key).is_none()) {
        let has_parts = schema.get("allOf").is_some();
        schema.insert(keywords[usize::from(has_parts)].into(), false.into());
    }
}

fn arrange(schema: &mut Schema) {
    let Some(keywords) = schema.as_object_mut() else { return };
    let mut all: Vec<(String, Value)> = std::mem::take(keywords).into_iter().collect();
    all.sort_by_key(|(key, _)| ORDER.iter().position(|other| other == key));
    keywords.extend(all);
}

/// Opens the definitions that are parts of objects: the object refuses further keys.
fn open_parts(schema: &mut Value) {
    let mut parts = BTreeSet::new();
    collect_parts(schema, &mut parts);
    let definitions = schema.get_mut("$defs").and_then(Value::as_object_mut);
    for (_, definition) in definitions.into_iter().flatten().filter(|(name, _)| parts.contains(*name)) {
        if let Some(keywords) = definition.as_object_mut() {
            keywords.shift_remove("additionalProperties");
        }
    }
}

/// Collects the names of definitions that are parts of objects.
fn collect_parts(schema: &Value, parts: &mut BTreeSet<String>) {
    for part in schema["allOf"].as_array().into_iter().flatten() {
        parts.extend(definition_name(&part["$ref"]).map(str::to_string));
    }
    for value in values(schema) {
        collect_parts(value, parts);
    }
}

fn values(value: &Value) -> Vec<&Value> {
    match value {
        Value::Object(entries) => entries.values().collect(),
        Value::Array(items) => items.iter().collect(),
        _ => Vec::new(),
    }
}

/// The name of the definition to which a reference leads.
fn definition_name(reference: &Value) -> Option<&str> {
    reference.as_str()?.strip_prefix(DEFINITIONS)
}

/// Names definitions as keys are named: `FindingRow` becomes `finding`.
fn rename_definitions(schema: &mut Value) {
    let Some(Value::Object(definitions)) = schema.get_mut("$defs").map(Value::take) else { return };
    let key = |name: &str| name[..1].to_lowercase() + &name[1..];
    let mut names: BTreeMap<String, String> = BTreeMap::new();
    for name in definitions.keys() {
        let short = key(name.strip_suffix("Row").or(name.strip_suffix("Report")).unwrap_or(name));
        let is_new = names.values().all(|other| *other != short);
        names.insert(name.clone(), if is_new { short } else { key(name) });
    }
    let renamed = definitions.into_iter().map(|(name, value)| (names[&name].clone(), value));
    schema["$defs"] = Value::Object(renamed.collect());
    rename_references(schema, &names);
}

fn rename_references(value: &mut Value, names: &BTreeMap<String, String>) {
    match value {
        Value::Object(entries) => {
            if let Some(reference) = entries.get_mut("$ref")
                && let Some(name) = definition_name(reference).and_then(|name| names.get(name))
            {
                *reference = format!("{DEFINITIONS}{name}").into();
            }
            entries.values_mut().for_each(|value| rename_references(value, names));
        }
        Value::Array(items) => items.iter_mut().for_each(|value| rename_references(value, names)),
        _ => {}
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use schemars::json_schema;

    #[test]
    fn a_schema_is_finished() {
        let derived = json_schema!({
            "properties": {
                "title": {"description": "First\nline.\n\nFor the code.", "format": "uint", "type": "integer"},
                "x": {"type": ["number", "null"], (NONFINITE): {"$ref": "#/$defs/nonfinite"}},
                "word": {"oneOf": [{"const": "a", "description": "A."}, {"type": "string", "enum": ["b"]}]},
                "at": {"properties": {"why": {"$ref": "#/$defs/PlaceReport"}}, "allOf": [{"$ref": "#/$defs/PlaceRow"}]},
            },
            "type": "object",
            "$defs": {"PlaceRow": {"properties": {"line": {}}}, "PlaceReport": {"properties": {"here": {}}}},
        });
        let nonfinite = "Under the key of a number or of a list of numbers: what those are that are null. Absent when every number is one.";
        let finished = json!({
            "type": "object",
            "properties": {
                "title": {"description": "First line.", "type": "integer"},
                "x": {"type": ["number", "null"]},
                "word": {"type": "string", "enum": ["a", "b"]},
                "at": {
                    "allOf": [{"$ref": "#/$defs/place"}],
                    "properties": {"why": {"$ref": "#/$defs/placeReport"}},
                    "unevaluatedProperties": false,
                },
                "nonfinite": {
                    "description": nonfinite,
                    "type": "object",
                    "properties": {"x": {"$ref": "#/$defs/nonfinite"}},
                    "additionalProperties": false,
                },
            },
            "additionalProperties": false,
            "$defs": {
                "place": {"properties": {"line": {}}},
                "placeReport": {"properties": {"here": {}}, "additionalProperties": false},
            },
        });
        // Compared as texts, because keywords have an order.
        assert_eq!(finish(derived).to_string(), finished.to_string());
    }
}
