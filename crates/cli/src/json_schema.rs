//! JSON Schema, as far as the schemas of widgets need it. A keyword that is not in this module is refused when the schema is read,
//! so that no part of a schema is silently skipped.

use labspec::json::{Json, Node};
use labspec::report::printable;
use serde_json::{Map, Value};
use std::ops::Range;

/// Keywords that describe and do not constrain.
const DESCRIPTIONS: [&str; 8] =
    ["$schema", "$id", "$comment", "title", "description", "default", "examples", "deprecated"];
/// Keywords that constrain.
const CONSTRAINTS: [&str; 16] = [
    "type",
    "enum",
    "const",
    "properties",
    "required",
    "additionalProperties",
    "items",
    "minItems",
    "maxItems",
    "minLength",
    "maxLength",
    "minimum",
    "maximum",
    "exclusiveMinimum",
    "exclusiveMaximum",
    "anyOf",
];
const TYPES: [&str; 7] = ["object", "array", "string", "number", "integer", "boolean", "null"];
/// Maximum number of characters of a value in a message.
const MAX_QUOTED: usize = 60;
/// Maximum nesting depth of a schema.
const MAX_DEPTH: usize = 64;

/// A mistake in a value.
pub(super) struct SchemaViolation {
    /// Bytes of the value.
    pub(super) span: Range<usize>,
    /// What is wrong.
    pub(super) message: String,
    /// What to write.
    pub(super) help: String,
}

/// Checks that a schema has only keywords of this module, with values of their types.
///
/// # Errors
/// The first part that cannot be used.
pub(super) fn check_schema(schema: &Value) -> Result<(), String> {
    check_nested(schema, 0)
}

fn check_nested(schema: &Value, depth: usize) -> Result<(), String> {
    let map = match schema {
        Value::Bool(_) => return Ok(()),
        Value::Object(map) if depth < MAX_DEPTH => map,
        Value::Object(_) => return Err("it is nested too deeply".into()),
        _ => return Err("a schema must be an object, true or false".into()),
    };
    for (keyword, value) in map {
        let wrong = |expected: &str| Err(format!("`{keyword}` must be {expected}"));
        match keyword.as_str() {
            "properties" => match value {
                Value::Object(all) => all.values().try_for_each(|one| check_nested(one, depth + 1))?,
                _ => return wrong("an object of schemas"),
            },
            "items" | "additionalProperties" => check_nested(value, depth + 1)?,
            "anyOf" => match value {
                Value::Array(all) if !all.is_empty() => {
                    all.iter().try_for_each(|one| check_nested(one, depth + 1))?;
                }
                _ => return wrong("a list of schemas"),
            },
            "type" if types(value).is_none() => return wrong("one or several of the JSON types"),
            "required" if texts(value).is_none() => return wrong("a list of texts"),
            "enum" if !value.is_array() => return wrong("a list of values"),
            "minItems" | "maxItems" | "minLength" | "maxLength" if value.as_u64().is_none() => {
                return wrong("a whole number");
            }
            "minimum" | "maximum" | "exclusiveMinimum" | "exclusiveMaximum" if value.as_f64().is_none() => {
                return wrong("a number");
            }
            word if CONSTRAINTS.contains(&word) || DESCRIPTIONS.contains(&word) => {}
            word => {
                let word = printable(word);
                return Err(format!(
                    "`{word}` is not supported; the keywords are {}",
                    CONSTRAINTS.join(", ")
                ));
            }
        }
    }
    Ok(())
}

fn texts(value: &Value) -> Option<Vec<&str>> {
    value.as_array()?.iter().map(Value::as_str).collect()
}

fn types(value: &Value) -> Option<Vec<&str>> {
    let all = value.as_str().map_or_else(|| texts(value), |one| Some(vec![one]))?;
    all.iter().all(|one| TYPES.contains(one)).then_some(all)
}

/// Adds the mistakes of a value. The schema was checked ([`check_schema`]).
pub(super) fn validate(schema: &Value, node: &Node, violations: &mut Vec<SchemaViolation>) {
    let none = Map::new();
    let map = match schema {
        Value::Bool(false) => {
            return violations.push(violation(node, "no value is allowed here", "delete it"));
        }
        Value::Object(map) => map,
        _ => &none,
    };
    let before = violations.len();
    validate_value(map, node, violations);
    if violations.len() > before {
        return;
    }
    match &node.json {
        Json::Object(_) => validate_object(map, node, violations),
        Json::Array(items) => {
            let schema = map.get("items");
            items
                .iter()
                .for_each(|item| schema.into_iter().for_each(|schema| validate(schema, item, violations)));
        }
        _ => {}
    }
    if let Some(Value::Array(all)) = map.get("anyOf") {
        let attempts = all.iter().map(|one| {
            let mut list = Vec::new();
            validate(one, node, &mut list);
            list
        });
        // The mistakes of the schema that fits best.
        violations.extend(attempts.min_by_key(Vec::len).unwrap_or_default());
    }
}

fn violation(node: &Node, message: impl Into<String>, help: impl Into<String>) -> SchemaViolation {
    SchemaViolation { span: node.span.clone(), message: message.into(), help: help.into() }
}

/// The constraints of a value that do not concern its parts.
fn validate_value(map: &Map<String, Value>, node: &Node, violations: &mut Vec<SchemaViolation>) {
    let mut wrong = |message: String, help: String| violations.push(violation(node, message, help));
    if let Some(allowed) = map.get("type").and_then(types)
        && !allowed.iter().any(|ty| is_of_type(node, ty))
    {
        let allowed = allowed.join(" or ");
        return wrong(
            format!("it must be of type {allowed}; this is {}", node.describe()),
            format!("write a value of type {allowed}"),
        );
    }
    let value = plain(node);
    if let Some(Value::Array(all)) = map.get("enum")
        && !all.contains(&value)
    {
        let all = all.iter().map(Value::to_string).collect::<Vec<_>>().join(", ");
        // The values of a lesson can be long.
        let start: String = value.to_string().chars().take(MAX_QUOTED).collect();
        wrong(format!("{start} is not one of its values"), format!("write one of {all}"));
    }
    if let Some(one) = map.get("const").filter(|one| **one != value) {
        wrong(format!("it must be {one}"), format!("write {one}"));
    }
    let size = match &node.json {
        Json::Number(x) => Some((*x, ["minimum", "maximum"], "")),
        Json::Text(text) => {
            Some((text.value.chars().count() as f64, ["minLength", "maxLength"], " characters"))
        }
        Json::Array(items) => Some((items.len() as f64, ["minItems", "maxItems"], " items")),
        _ => None,
    };
    let Some((size, [least, most], what)) = size else { return };
    let limit = |key: &str| map.get(key).and_then(Value::as_f64);
    if let Some(limit) = limit(least).filter(|limit| size < *limit) {
        wrong(format!("{size}{what} is below {limit}"), format!("write at least {limit}{what}"));
    }
    if let Some(limit) = limit(most).filter(|limit| size > *limit) {
        wrong(format!("{size}{what} is above {limit}"), format!("write at most {limit}{what}"));
    }
    if matches!(node.json, Json::Number(_)) {
        if let Some(limit) = limit("exclusiveMinimum").filter(|limit| size <= *limit) {
            wrong(format!("{size} is not above {limit}"), format!("write a number above {limit}"));
        }
        if let Some(limit) = limit("exclusiveMaximum").filter(|limit| size >= *limit) {
            wrong(format!("{size} is not below {limit}"), format!("write a number below {limit}"));
        }
    }
}

fn validate_object(map: &Map<String, Value>, node: &Node, violations: &mut Vec<SchemaViolation>) {
    for key in map.get("required").and_then(texts).unwrap_or_default() {
        if node.get(key).is_none() {
            let open = node.span.start..node.span.start + 1;
            let message = format!("`{}` is missing", printable(key));
            violations.push(SchemaViolation {
                span: open,
                message,
                help: format!("add \"{}\": …", printable(key)),
            });
        }
    }
    let properties = map.get("properties").and_then(Value::as_object);
    for member in node.members() {
        let key = member.key.as_str();
        match (properties.and_then(|all| all.get(key)), map.get("additionalProperties")) {
            (Some(schema), _) => validate(schema, &member.value, violations),
            (None, Some(Value::Bool(false))) => {
                let names = properties.into_iter().flat_map(Map::keys).map(String::as_str);
                let help = match labspec_finding::nearest(key, names) {
                    Some(near) => format!("did you mean `{near}`?"),
                    None => "delete it".to_string(),
                };
                let message = format!("`{}` is not one of its keys", printable(key));
                violations.push(SchemaViolation { span: member.key.span(), message, help });
            }
            (None, Some(schema)) => validate(schema, &member.value, violations),
            (None, None) => {}
        }
    }
}

fn is_of_type(node: &Node, ty: &str) -> bool {
    match &node.json {
        Json::Null => ty == "null",
        Json::Bool(_) => ty == "boolean",
        Json::Number(x) => ty == "number" || ty == "integer" && x.fract() == 0.0,
        Json::Text(_) => ty == "string",
        Json::Array(_) => ty == "array",
        Json::Object(_) => ty == "object",
        Json::Broken => true,
    }
}

/// A value without its places. Numbers are compared as numbers: 1 equals 1.0.
fn plain(node: &Node) -> Value {
    match &node.json {
        Json::Null | Json::Broken => Value::Null,
        Json::Bool(b) => Value::Bool(*b),
        Json::Number(x) if x.fract() == 0.0 && x.abs() < 9e15 => Value::from(*x as i64),
        Json::Number(x) => Value::from(*x),
        Json::Text(text) => Value::from(text.as_str()),
        Json::Array(items) => items.iter().map(plain).collect(),
        Json::Object(_) => node.members().iter().map(|m| (m.key.value.clone(), plain(&m.value))).collect(),
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)] // a panic is the report of a failed test
mod tests {
    use super::*;
    use labspec::json;
    use labspec::source::SourceMap;
    use serde_json::json;

    /// The messages about a text, each with its place in it.
    fn violations(schema: &Value, text: &str) -> Vec<(String, String)> {
        check_schema(schema).unwrap();
        let node = json::parse(text, &SourceMap::verbatim(0..text.len())).node.unwrap();
        let mut all = Vec::new();
        validate(schema, &node, &mut all);
        all.into_iter().map(|m| (m.message, text[m.span].to_string())).collect()
    }

    #[test]
    fn every_keyword_accepts_and_refuses() {
        for (schema, right, wrong) in [
            (json!({"type": "number"}), "1.5", "\"1\""),
            (json!({"type": "integer"}), "2.0", "1.5"),
            (json!({"type": ["string", "null"]}), "null", "1"),
            (json!({"type": "boolean"}), "true", "0"),
            (json!({"enum": ["a", 1]}), "1.0", "\"b\""),
            (json!({"const": {"a": [1]}}), "{\"a\": [1]}", "{\"a\": [2]}"),
            (json!({"properties": {"a": {"type": "string"}}}), "{\"b\": 1}", "{\"a\": 1}"),
            (json!({"required": ["a"]}), "{\"a\": 1}", "{}"),
            (json!({"properties": {"a": true}, "additionalProperties": false}), "{\"a\": 1}", "{\"b\": 1}"),
            (json!({"additionalProperties": {"type": "number"}}), "{\"b\": 1}", "{\"b\": null}"),
            (json!({"items": {"minimum": 3}}), "[3, 4]", "[2]"),
            (json!({"minItems": 1}), "[1]", "[]"),
            (json!({"maxItems": 1}), "[1]", "[1, 2]"),
            (json!({"minLength": 2}), "\"éé\"", "\"a\""),
            (json!({"maxLength": 2}), "\"éé\"", "\"abc\""),
            (json!({"minimum": 0}), "0", "-1"),
            (json!({"maximum": 0}), "0", "1"),
            (json!({"exclusiveMinimum": 0}), "1", "0"),
            (json!({"exclusiveMaximum": 0}), "-1", "0"),
            (json!({"anyOf": [{"type": "string"}, {"minimum": 3}]}), "\"a\"", "2"),
            (json!(true), "1", ""),
            (json!(false), "", "1"),
        ] {
            if !right.is_empty() {
                assert_eq!(violations(&schema, right), [], "{schema} {right}");
            }
            if !wrong.is_empty() {
                assert_eq!(violations(&schema, wrong).len(), 1, "{schema} {wrong}");
            }
        }
    }

    #[test]
    fn every_mistake_has_its_place() {
        let schema = json!({"type": "object", "required": ["place"], "additionalProperties": false,
            "properties": {"place": {"type": "string"}, "zoom": {"type": "integer", "minimum": 1}, "pins": {"items": {"enum": ["red", "blue"]}}}});
        let found = violations(&schema, r#"{"zom": 3, "zoom": 0, "pins": ["red", "green"]}"#);
        let places: Vec<&str> = found.iter().map(|(_, place)| place.as_str()).collect();
        assert_eq!(places, ["{", "zom", "0", "\"green\""], "{found:?}");
    }

    #[test]
    fn schemas_with_other_keywords_are_refused() {
        let why = |schema: Value| check_schema(&schema).unwrap_err();
        assert!(why(json!({"pattern": "a"})).contains("`pattern` is not supported"));
        assert!(why(json!({"properties": {"a": {"oneOf": []}}})).contains("`oneOf`"));
        assert!(why(json!({"type": "text"})).contains("JSON types"));
        assert!(why(json!({"required": "a"})).contains("a list of texts"));
        assert!(why(json!([])).contains("must be an object"));
        let deep = (0..100).fold(json!({}), |inner, _| json!({"items": inner}));
        assert!(why(deep).contains("too deeply"));
    }
}
