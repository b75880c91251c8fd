//! A validator for JSON Schema 2020-12, limited to what `docs/schema` uses. An unknown keyword fails, so that no part of a
//! schema is ignored. (The small crates for this purpose have about a hundred dependencies.)

use super::{read_json, workspace};
use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};

/// The schemas of reports in `docs/schema`, by file name.
pub(crate) fn schemas() -> BTreeMap<String, Value> {
    let folder = std::fs::read_dir(workspace().join("docs/schema")).unwrap();
    let files = folder.map(|e| e.unwrap().path());
    let named = files.map(|p| (p.file_name().unwrap().to_string_lossy().into_owned(), p));
    let reports = named.filter(|(name, _)| name.starts_with("report-"));
    reports.map(|(name, p)| (name, read_json(&p))).collect()
}

/// The errors in a value, each with its path; empty if the value conforms to the schema. The schema is a file or a part of one
/// (`lesson.json#/$defs/lab`).
pub(crate) fn problems(schemas: &BTreeMap<String, Value>, name: &str, value: &Value) -> Vec<String> {
    let mut look = SchemaCheck { schemas, problems: Vec::new() };
    let (file, schema) = look.follow("", name);
    look.check(&file, schema, value, "");
    look.problems
}

struct SchemaCheck<'s> {
    schemas: &'s BTreeMap<String, Value>,
    problems: Vec<String>,
}

/// The keys of an object that a schema has evaluated.
type EvaluatedKeys = BTreeSet<String>;

impl<'s> SchemaCheck<'s> {
    fn check(&mut self, file: &str, schema: &'s Value, value: &Value, at: &str) -> EvaluatedKeys {
        let mut evaluated = EvaluatedKeys::new();
        let Some(keywords) = schema.as_object() else {
            if schema == &Value::Bool(false) {
                self.problems.push(format!("{at} must not be there"));
            }
            return evaluated;
        };
        for (keyword, constraint) in keywords {
            let holds = match keyword.as_str() {
                "$schema" | "title" | "description" | "$defs" | "default" | "examples" => true,
                // Evaluated with `if`.
                "then" | "else" => true,
                // Evaluated after all other keywords.
                "unevaluatedProperties" => true,
                "const" => value == constraint,
                "enum" => list(constraint).contains(value),
                "type" => match constraint {
                    Value::Array(any) => any.iter().any(|name| is(value, name)),
                    name => is(value, name),
                },
                "minimum" => value.as_f64().is_none_or(|x| x >= constraint.as_f64().unwrap()),
                "maximum" => value.as_f64().is_none_or(|x| x <= constraint.as_f64().unwrap()),
                "exclusiveMinimum" => value.as_f64().is_none_or(|x| x > constraint.as_f64().unwrap()),
                "minItems" => value.as_array().is_none_or(|l| l.len() as u64 >= constraint.as_u64().unwrap()),
                "maxItems" => value.as_array().is_none_or(|l| l.len() as u64 <= constraint.as_u64().unwrap()),
                "required" => value
                    .as_object()
                    .is_none_or(|o| list(constraint).iter().all(|key| o.contains_key(key.as_str().unwrap()))),
                "$ref" => {
                    let (file, schema) = self.follow(file, constraint.as_str().unwrap());
                    evaluated.extend(self.check(&file, schema, value, at));
                    true
                }
                "allOf" => {
                    list(constraint).iter().for_each(|s| evaluated.extend(self.check(file, s, value, at)));
                    true
                }
                "anyOf" => {
                    evaluated.extend(self.any_of(file, list(constraint), value, at));
                    true
                }
                "oneOf" => {
                    let holding: Vec<EvaluatedKeys> =
                        list(constraint).iter().filter_map(|s| self.holds(file, s, value)).collect();
                    let one = holding.len() == 1;
                    evaluated.extend(holding.into_iter().flatten());
                    one
                }
                "not" => self.holds(file, constraint, value).is_none(),
                "if" => {
                    let holding = self.holds(file, constraint, value);
                    let next = if holding.is_some() { "then" } else { "else" };
                    evaluated.extend(holding.into_iter().flatten());
                    if let Some(schema) = keywords.get(next) {
                        evaluated.extend(self.check(file, schema, value, at));
                    }
                    true
                }
                "properties" => {
                    for (key, schema) in constraint.as_object().unwrap() {
                        if let Some(inside) = value.get(key) {
                            self.check(file, schema, inside, &format!("{at}/{key}"));
                            evaluated.insert(key.clone());
                        }
                    }
                    true
                }
                "additionalProperties" => {
                    let declared = keywords.get("properties").and_then(Value::as_object);
                    for (key, inside) in value.as_object().into_iter().flatten() {
                        if declared.is_none_or(|declared| !declared.contains_key(key)) {
                            self.check(file, constraint, inside, &format!("{at}/{key}"));
                            evaluated.insert(key.clone());
                        }
                    }
                    true
                }
                "prefixItems" => {
                    let items = value.as_array().into_iter().flatten().enumerate();
                    for ((i, inside), schema) in items.zip(list(constraint)) {
                        self.check(file, schema, inside, &format!("{at}/{i}"));
                    }
                    true
                }
                "items" => {
                    for (i, inside) in value.as_array().into_iter().flatten().enumerate() {
                        self.check(file, constraint, inside, &format!("{at}/{i}"));
                    }
                    true
                }
                _ => panic!("{file} uses `{keyword}`, which is not known here"),
            };
            if !holds {
                let value: String = value.to_string().chars().take(200).collect();
                self.problems.push(format!("{at}: `{keyword}: {constraint}` does not hold for {value}"));
            }
        }
        if let Some(schema) = keywords.get("unevaluatedProperties") {
            for (key, inside) in value.as_object().into_iter().flatten() {
                if !evaluated.contains(key) {
                    self.check(file, schema, inside, &format!("{at}/{key}"));
                }
            }
        }
        evaluated
    }

    /// The keys that a schema evaluates, if the value conforms to it.
    fn holds(&self, file: &str, schema: &'s Value, value: &Value) -> Option<EvaluatedKeys> {
        let mut alone = SchemaCheck { schemas: self.schemas, problems: Vec::new() };
        let evaluated = alone.check(file, schema, value, "");
        alone.problems.is_empty().then_some(evaluated)
    }

    /// The keys that the matching schemas evaluate. If none matches, the errors of the closest schema are reported: one that
    /// fails inside the value, not at the value itself.
    fn any_of(&mut self, file: &str, any: &'s [Value], value: &Value, at: &str) -> EvaluatedKeys {
        let mut closest = None;
        let mut evaluated = EvaluatedKeys::new();
        for schema in any {
            let mut alone = SchemaCheck { schemas: self.schemas, problems: Vec::new() };
            let of = alone.check(file, schema, value, at);
            evaluated.extend(of.into_iter().filter(|_| alone.problems.is_empty()));
            let here = alone.problems.iter().filter(|p| p.starts_with(&format!("{at}:"))).count();
            let far = (here, alone.problems.len());
            if closest.as_ref().is_none_or(|(least, _)| far < *least) {
                closest = Some((far, alone.problems));
            }
        }
        self.problems.extend(closest.into_iter().flat_map(|(_, problems)| problems));
        evaluated
    }

    /// Resolves a reference: `#/$defs/place` of the same file, or another file.
    fn follow(&self, file: &str, to: &str) -> (String, &'s Value) {
        let (name, inside) = to.split_once('#').unwrap_or((to, ""));
        let name = if name.is_empty() { file } else { name };
        let schema = self.schemas[name].pointer(inside);
        (name.into(), schema.unwrap_or_else(|| panic!("{file}: `{to}` leads nowhere")))
    }
}

fn list(value: &Value) -> &[Value] {
    value.as_array().map(Vec::as_slice).unwrap()
}

fn is(value: &Value, name: &Value) -> bool {
    match name.as_str().unwrap() {
        "null" => value.is_null(),
        "boolean" => value.is_boolean(),
        "number" => value.is_number(),
        "integer" => value.as_f64().is_some_and(|x| x.fract() == 0.0),
        "string" => value.is_string(),
        "array" => value.is_array(),
        "object" => value.is_object(),
        other => panic!("there is no type `{other}`"),
    }
}

/// Tests the validator itself: each keyword can fail, and reports the path.
#[test]
fn every_keyword_can_fail() {
    use serde_json::json;
    let schema = json!({
        "type": "object", "required": ["a"], "allOf": [{"$ref": "#/$defs/named"}], "unevaluatedProperties": false,
        "properties": {
            "a": {"anyOf": [{"type": "null"}, {"type": "array", "items": {"type": "integer", "minimum": 0}}]},
            "b": {"prefixItems": [{"const": 1}, {"enum": ["x", null]}], "minItems": 2, "maxItems": 2},
            "c": {"additionalProperties": {"type": ["number", "boolean"]}},
            "d": {"properties": {"e": {}}, "additionalProperties": false},
            "f": {"oneOf": [{"maximum": 3}, {"exclusiveMinimum": 2}], "not": {"const": 5}},
            "g": {"if": {"type": "string"}, "then": {"const": "x"}, "else": {"const": 0}},
        },
        "$defs": {"named": {"properties": {"name": {"type": "string"}}}},
    });
    let schemas = BTreeMap::from([("s".to_string(), schema)]);
    let good = json!({"a": [1, 2], "b": [1, null], "c": {"x": 1.5, "y": true}, "d": {"e": []}, "name": "n", "f": 2, "g": "x"});
    assert_eq!(problems(&schemas, "s", &good), Vec::<String>::new());
    for (place, wrong) in [
        ("", json!([])),
        ("", json!({"name": "n"})),
        ("/name", json!({"a": null, "name": 1})),
        ("/other", json!({"a": null, "other": 1})),
        ("/a", json!({"a": 7})),
        ("/a/1", json!({"a": [1, -1]})),
        ("/a/0", json!({"a": [0.5]})),
        ("/b/0", json!({"a": null, "b": [2, "x"]})),
        ("/b/1", json!({"a": null, "b": [1, "y"]})),
        ("/b", json!({"a": null, "b": [1]})),
        ("/b", json!({"a": null, "b": [1, "x", 0]})),
        ("/c/z", json!({"a": null, "c": {"z": null}})),
        ("/d/f", json!({"a": null, "d": {"f": 1}})),
        ("/f", json!({"a": null, "f": 2.5})),
        ("/f", json!({"a": null, "f": 5})),
        ("/g", json!({"a": null, "g": "y"})),
        ("/g", json!({"a": null, "g": 1})),
    ] {
        let found = problems(&schemas, "s", &wrong);
        let start = |p: &String| p.starts_with(&format!("{place}:")) || p.starts_with(&format!("{place} "));
        assert!(!found.is_empty() && found.iter().all(start), "{wrong}: {found:?}");
    }
}
