//! JSON Schemas of labs and quizzes (draft 2020-12), for editors and other programs.

use super::describe::{default, number};
use super::{CONTROL, QUESTION};
use super::{Family, Key, LAB, Limits, OBJECTS, Object, PairHalf, QUIZ, Together, Type, Word};
use serde_json::{Map, Value, json};

/// What a schema is of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Root {
    /// A lab.
    Lab,
    /// A quiz.
    Quiz,
    /// A JSON file of a course: a lab, a quiz, or a list of them.
    Lesson,
}

/// The schema, as JSON. What it refuses is an error of `labspec check`; what needs the model, or looks at several
/// values at once, only the check finds.
pub fn schema(root: Root) -> Value {
    let (title, description, body) = match root {
        Root::Lab => ("Lab", LAB.doc, reference(LAB.name)),
        Root::Quiz => ("Quiz", QUIZ.doc, reference(QUIZ.name)),
        Root::Lesson => {
            ("Lesson", "A lab, a quiz, or a list of them.", when(json!({"type": "array"}), list(), item()))
        }
    };
    let mut schema = object([
        ("$schema", json!("https://json-schema.org/draft/2020-12/schema")),
        ("title", json!(title)),
        ("description", json!(description)),
    ]);
    schema.extend(body);
    let mut used = Vec::new();
    if root != Root::Quiz {
        reach(&LAB, &mut used);
    }
    if root != Root::Lab {
        reach(&QUIZ, &mut used);
    }
    let mut definitions = Map::new();
    for family in [&CONTROL, &QUESTION] {
        if family.objects.iter().any(|o| used.contains(&o.name)) {
            definitions.insert(family.name.into(), Value::Object(one_of(family)));
        }
    }
    for object in OBJECTS.iter().filter(|o| used.contains(&o.name)) {
        definitions.insert(object.name.into(), Value::Object(definition(object)));
    }
    schema.insert("$defs".into(), Value::Object(definitions));
    Value::Object(schema)
}

/// One item of a JSON file.
fn item() -> Map<String, Value> {
    when(json!({"required": ["questions"]}), reference(QUIZ.name), reference(LAB.name))
}

fn list() -> Map<String, Value> {
    object([("items", Value::Object(item()))])
}

/// The names of all objects that can stand in this one.
fn reach(from: &'static Object, used: &mut Vec<&'static str>) {
    if used.contains(&from.name) {
        return;
    }
    used.push(from.name);
    from.keys.iter().for_each(|k| reach_type(&k.of, used));
}

fn reach_type(of: &Type, used: &mut Vec<&'static str>) {
    match of {
        Type::Object(object) => reach(object, used),
        Type::OneOf(family) => family.objects.iter().for_each(|o| reach(o, used)),
        Type::List(item) => reach_type(item, used),
        Type::Map(map) => reach_type(&map.of, used),
        Type::Either(a, b) => [a, b].into_iter().for_each(|t| reach_type(t, used)),
        _ => {}
    }
}

fn definition(of: &Object) -> Map<String, Value> {
    let properties: Map<String, Value> =
        of.keys.iter().map(|k| (k.name.to_string(), Value::Object(property(of, k)))).collect();
    let mut schema = object([
        ("description", json!(of.doc)),
        ("type", json!("object")),
        ("properties", Value::Object(properties)),
        ("additionalProperties", json!(false)),
    ]);
    let required: Vec<&str> = of.keys.iter().filter(|k| k.required()).map(|k| k.name).collect();
    if !required.is_empty() {
        schema.insert("required".into(), json!(required));
    }
    let together: Vec<Value> = of.together.iter().filter_map(rule).collect();
    if !together.is_empty() {
        schema.insert("allOf".into(), json!(together));
    }
    schema
}

/// What keys ask of each other. A schema knows errors only.
fn rule(rule: &Together) -> Option<Value> {
    let each = |names: &[&str]| names.iter().map(|n| json!({"required": [n]})).collect::<Value>();
    Some(match rule {
        Together::ExactlyOne(names) => json!({"oneOf": each(names)}),
        Together::AtLeastOne(names) => json!({"anyOf": each(names)}),
        Together::AtMostOne(names) => json!({"not": {"required": names}}),
        Together::OneAdvised(_) | Together::FirstCounts(_) => return None,
    })
}

fn property(of: &Object, key: &Key) -> Map<String, Value> {
    let mut schema = match of.tag.filter(|(name, _)| *name == key.name) {
        Some((_, word)) => object([("const", json!(word))]),
        None => value(&key.of, &key.limits),
    };
    if key.items > 0 {
        schema.insert("minItems".into(), json!(key.items));
    }
    let unit = if key.unit.is_empty() { String::new() } else { format!(" ({})", key.unit) };
    schema.insert("description".into(), json!(format!("{}{unit}", key.doc)));
    if let Some(default) = default(key) {
        schema.insert("default".into(), default);
    }
    if let Ok(example) = serde_json::from_str::<Value>(key.example) {
        schema.insert("examples".into(), json!([example]));
    }
    schema
}

/// What a type takes.
fn value(of: &Type, limits: &Limits) -> Map<String, Value> {
    let none = Limits::default();
    let typed = |name: &str| object([("type", json!(name))]);
    match of {
        Type::Text | Type::Name(_) | Type::Html | Type::Code(_) => typed("string"),
        Type::Number => bounded(typed("number"), limits),
        Type::Whole => bounded(typed("integer"), limits),
        Type::Flag => typed("boolean"),
        Type::Scalar => object([("type", json!(["number", "string", "boolean"]))]),
        Type::Words(words) => object([("enum", words.iter().map(|w| w.text).collect())]),
        Type::List(item) => {
            let items = Value::Object(value(item, limits));
            object([("type", json!("array")), ("items", items)])
        }
        Type::Numbers(n) => object([
            ("type", json!("array")),
            ("items", json!({"type": "number"})),
            ("minItems", json!(n)),
            ("maxItems", json!(n)),
        ]),
        Type::Pair(parts) => {
            let part = |p: &PairHalf| {
                let mut schema = value(&p.of, &none);
                schema.insert("description".into(), json!(p.what));
                Value::Object(schema)
            };
            object([
                ("type", json!("array")),
                ("prefixItems", parts.iter().map(part).collect()),
                ("minItems", json!(2)),
                ("maxItems", json!(2)),
            ])
        }
        Type::Map(map) => object([
            ("type", json!("object")),
            ("additionalProperties", Value::Object(value(&map.of, &none))),
        ]),
        Type::Switches(words) => {
            let switch = |w: &Word| (w.text.into(), json!({"type": "boolean", "description": w.doc}));
            object([
                ("type", json!("object")),
                ("properties", Value::Object(words.iter().map(switch).collect())),
                ("additionalProperties", json!(false)),
            ])
        }
        Type::Object(o) => reference(o.name),
        Type::OneOf(family) => reference(family.name),
        Type::Either(a, b) => {
            object([("anyOf", [a, b].iter().map(|t| Value::Object(value(t, limits))).collect())])
        }
    }
}

fn bounded(mut schema: Map<String, Value>, limits: &Limits) -> Map<String, Value> {
    let all = [("exclusiveMinimum", limits.above), ("minimum", limits.least), ("maximum", limits.most)];
    for (keyword, limit) in all {
        if let Some(x) = limit {
            schema.insert(keyword.into(), number(x));
        }
    }
    schema
}

/// One object of a family, told by its word; anything else is read as the first one, and refused there.
fn one_of(family: &Family) -> Map<String, Value> {
    let tagged = |object: &&'static Object| object.tag.map(|(key, word)| (key, word, object.name));
    let mut rest = family.objects.first().map(|o| reference(o.name)).unwrap_or_default();
    for (key, word, name) in family.objects.iter().skip(1).rev().filter_map(tagged) {
        let properties: Map<String, Value> =
            [(key.to_string(), json!({"const": word}))].into_iter().collect();
        rest = when(json!({"properties": properties, "required": [key]}), reference(name), rest);
    }
    let mut schema = object([("description", json!(family.doc)), ("type", json!("object"))]);
    schema.extend(rest);
    schema
}

fn when(condition: Value, then: Map<String, Value>, otherwise: Map<String, Value>) -> Map<String, Value> {
    object([("if", condition), ("then", Value::Object(then)), ("else", Value::Object(otherwise))])
}

fn reference(name: &str) -> Map<String, Value> {
    object([("$ref", json!(format!("#/$defs/{name}")))])
}

fn object<const N: usize>(members: [(&str, Value); N]) -> Map<String, Value> {
    members.into_iter().map(|(k, v)| (k.to_string(), v)).collect()
}
