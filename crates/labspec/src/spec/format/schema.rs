//! JSON Schemas of labs and quizzes (draft 2020-12), for editors and other programs.

use super::describe::{default, number};
use super::{CONTROL, QUESTION};
use super::{Family, INTEGRATORS, Key, KeyRule, LAB, Limits, OBJECTS, Object, PairHalf, QUIZ, Type};
use crate::json::to_value;
use serde::{Serialize, Serializer};
use serde_json::{Map, Value};

/// The subject of a schema.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Root {
    /// A lab.
    Lab,
    /// A lab that compares integrators.
    Integrators,
    /// A quiz.
    Quiz,
    /// A JSON file of a course: a lab, a quiz, or a list of them.
    Lesson,
}

/// A keyword of a schema with its value.
#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
enum SchemaKeyword {
    #[serde(rename = "$schema")]
    Dialect(&'static str),
    #[serde(rename = "$ref")]
    Reference(String),
    #[serde(rename = "$defs")]
    Definitions(NamedSchemas),
    Title(&'static str),
    Description(String),
    Type(&'static str),
    #[serde(rename = "type")]
    Types([&'static str; 3]),
    Const(&'static str),
    Enum(Vec<&'static str>),
    Properties(NamedSchemas),
    /// Whether other properties are allowed.
    #[serde(rename = "additionalProperties")]
    Open(bool),
    AdditionalProperties(SchemaNode),
    Required(Vec<&'static str>),
    Items(SchemaNode),
    PrefixItems(Vec<SchemaNode>),
    MinItems(usize),
    MaxItems(usize),
    ExclusiveMinimum(Value),
    Minimum(Value),
    Maximum(Value),
    AllOf(Vec<SchemaNode>),
    AnyOf(Vec<SchemaNode>),
    OneOf(Vec<SchemaNode>),
    Not(SchemaNode),
    If(SchemaNode),
    Then(SchemaNode),
    Else(SchemaNode),
    Default(Value),
    Examples([Value; 1]),
}

/// A schema: its keywords, in the order in which they are written.
#[derive(Default)]
struct SchemaNode(Vec<SchemaKeyword>);

impl From<SchemaKeyword> for SchemaNode {
    fn from(keyword: SchemaKeyword) -> SchemaNode {
        SchemaNode(vec![keyword])
    }
}

impl SchemaNode {
    fn and(mut self, more: impl IntoIterator<Item = SchemaKeyword>) -> SchemaNode {
        self.0.extend(more);
        self
    }
}

/// Schemas by name, in a fixed order.
struct NamedSchemas(Vec<(&'static str, SchemaNode)>);

impl Serialize for SchemaNode {
    fn serialize<S: Serializer>(&self, out: S) -> Result<S::Ok, S::Error> {
        let members = self.0.iter().map(to_value);
        let members: Map<String, Value> =
            members.filter_map(|keyword| keyword.as_object().cloned()).flatten().collect();
        members.serialize(out)
    }
}

impl Serialize for NamedSchemas {
    fn serialize<S: Serializer>(&self, out: S) -> Result<S::Ok, S::Error> {
        out.collect_map(self.0.iter().map(|(name, schema)| (name, schema)))
    }
}

/// The schema, as JSON. What it rejects is an error of `labspec check`. A condition that needs the model or several values
/// at once is found only by the check.
pub fn schema(root: Root) -> Value {
    let lab = || when(required(&["integrators"]), reference(INTEGRATORS.name), reference(LAB.name));
    let item = || when(required(&["questions"]), reference(QUIZ.name), lab());
    let list = || SchemaNode::from(SchemaKeyword::Items(item()));
    let (title, description, body) = match root {
        Root::Lab => ("Lab", LAB.doc, reference(LAB.name)),
        Root::Integrators => ("Integrators lab", INTEGRATORS.doc, reference(INTEGRATORS.name)),
        Root::Quiz => ("Quiz", QUIZ.doc, reference(QUIZ.name)),
        Root::Lesson => ("Lesson", "A lab, a quiz, or a list of them.", when(typed("array"), list(), item())),
    };
    let roots: &[&'static Object] = match root {
        Root::Lab => &[&LAB],
        Root::Integrators => &[&INTEGRATORS],
        Root::Quiz => &[&QUIZ],
        Root::Lesson => &[&LAB, &INTEGRATORS, &QUIZ],
    };
    let mut used = Vec::new();
    roots.iter().for_each(|object| reach(object, &mut used));
    let families = [&CONTROL, &QUESTION].into_iter();
    let families = families.filter(|f| f.objects.iter().any(|o| used.contains(&o.name)));
    let objects = OBJECTS.iter().filter(|o| used.contains(&o.name));
    let definitions = families.map(|f| (f.name, one_of(f))).chain(objects.map(|o| (o.name, definition(o))));
    let head = [
        SchemaKeyword::Dialect("https://json-schema.org/draft/2020-12/schema"),
        SchemaKeyword::Title(title),
        SchemaKeyword::Description(description.into()),
    ];
    let definitions = SchemaKeyword::Definitions(NamedSchemas(definitions.collect()));
    to_value(&SchemaNode(head.into()).and(body.0).and([definitions]))
}

/// Collects the names of this object and of all objects that it can contain.
fn reach(from: &'static Object, used: &mut Vec<&'static str>) {
    if used.contains(&from.name) {
        return;
    }
    used.push(from.name);
    from.keys.iter().for_each(|k| reach_type(&k.ty, used));
}

fn reach_type(ty: &Type, used: &mut Vec<&'static str>) {
    match ty {
        Type::Object(object) => reach(object, used),
        Type::OneOf(family) => family.objects.iter().for_each(|o| reach(o, used)),
        Type::List(item) => reach_type(item, used),
        Type::Map(map) => reach_type(&map.ty, used),
        Type::Either(a, b) => [a, b].into_iter().for_each(|t| reach_type(t, used)),
        _ => {}
    }
}

fn definition(object: &Object) -> SchemaNode {
    let required: Vec<&str> = object.keys.iter().filter(|k| k.required()).map(|k| k.name).collect();
    let rules: Vec<SchemaNode> = object.key_rules.iter().filter_map(rule).collect();
    SchemaNode::from(SchemaKeyword::Description(object.doc.into()))
        .and(closed(object.keys.iter().map(|k| (k.name, property(object, k)))).0)
        .and((!required.is_empty()).then_some(SchemaKeyword::Required(required)))
        .and((!rules.is_empty()).then_some(SchemaKeyword::AllOf(rules)))
}

/// A rule for a combination of keys. A schema can express only errors, so the rules with warnings are left out.
fn rule(rule: &KeyRule) -> Option<SchemaNode> {
    let each = |names: &[&'static str]| names.iter().map(|n| required(&[n])).collect();
    Some(SchemaNode::from(match rule {
        KeyRule::ExactlyOne(names) => SchemaKeyword::OneOf(each(names)),
        KeyRule::AtLeastOne(names) => SchemaKeyword::AnyOf(each(names)),
        KeyRule::AtMostOne(names) => SchemaKeyword::Not(required(&names[..])),
        KeyRule::OneAdvised(_) | KeyRule::FirstCounts(_) => return None,
    }))
}

fn property(object: &Object, key: &Key) -> SchemaNode {
    let schema = match object.tag.filter(|(name, _)| *name == key.name) {
        Some((_, word)) => SchemaNode::from(SchemaKeyword::Const(word)),
        None => value(&key.ty, &key.limits),
    };
    let unit = if key.unit.is_empty() { String::new() } else { format!(" ({})", key.unit) };
    let example = serde_json::from_str(key.example).ok();
    schema
        .and((key.items > 0).then_some(SchemaKeyword::MinItems(key.items)))
        .and([SchemaKeyword::Description(format!("{}{unit}", key.doc))])
        .and(default(key).map(SchemaKeyword::Default))
        .and(example.map(|example| SchemaKeyword::Examples([example])))
}

/// The schema of a type.
fn value(ty: &Type, limits: &Limits) -> SchemaNode {
    let none = Limits::default();
    match ty {
        Type::Text | Type::Name(_) | Type::Html | Type::Code(_) => typed("string"),
        Type::Number => bounded("number", limits),
        Type::Whole => bounded("integer", limits),
        Type::Flag => typed("boolean"),
        Type::Null => typed("null"),
        Type::Scalar => SchemaNode::from(SchemaKeyword::Types(["number", "string", "boolean"])),
        Type::Words(words) => SchemaNode::from(SchemaKeyword::Enum(words.iter().map(|w| w.text).collect())),
        Type::List(item) => typed("array").and([SchemaKeyword::Items(value(item, limits))]),
        Type::Numbers(n) => array_of(*n, SchemaKeyword::Items(typed("number"))),
        Type::Pair(parts) => {
            let part = |p: &PairHalf| value(&p.ty, &none).and([SchemaKeyword::Description(p.what.into())]);
            array_of(2, SchemaKeyword::PrefixItems(parts.iter().map(part).collect()))
        }
        Type::Map(map) => typed("object").and([SchemaKeyword::AdditionalProperties(value(&map.ty, &none))]),
        Type::Switches(words) => closed(
            words.iter().map(|w| (w.text, typed("boolean").and([SchemaKeyword::Description(w.doc.into())]))),
        ),
        Type::Object(o) => reference(o.name),
        Type::OneOf(family) => reference(family.name),
        Type::Either(a, b) => {
            SchemaNode::from(SchemaKeyword::AnyOf(vec![value(a, limits), value(b, limits)]))
        }
    }
}

fn bounded(kind: &'static str, limits: &Limits) -> SchemaNode {
    typed(kind)
        .and(limits.above.map(|x| SchemaKeyword::ExclusiveMinimum(number(x))))
        .and(limits.least.map(|x| SchemaKeyword::Minimum(number(x))))
        .and(limits.most.map(|x| SchemaKeyword::Maximum(number(x))))
}

fn array_of(n: usize, items: SchemaKeyword) -> SchemaNode {
    typed("array").and([items, SchemaKeyword::MinItems(n), SchemaKeyword::MaxItems(n)])
}

/// An object with only these keys.
fn closed(properties: impl Iterator<Item = (&'static str, SchemaNode)>) -> SchemaNode {
    typed("object")
        .and([SchemaKeyword::Properties(NamedSchemas(properties.collect())), SchemaKeyword::Open(false)])
}

/// The schema of a family: the family key selects the object. With any other value, the object is treated as the first one,
/// whose schema rejects the value.
fn one_of(family: &Family) -> SchemaNode {
    let tagged = |object: &&'static Object| object.tag.map(|(key, word)| (key, word, object.name));
    let mut rest = family.objects.first().map(|o| reference(o.name)).unwrap_or_default();
    for (key, word, name) in family.objects.iter().skip(1).rev().filter_map(tagged) {
        let properties = NamedSchemas(vec![(key, SchemaNode::from(SchemaKeyword::Const(word)))]);
        let tag = [SchemaKeyword::Properties(properties), SchemaKeyword::Required(vec![key])];
        rest = when(SchemaNode(tag.into()), reference(name), rest);
    }
    SchemaNode::from(SchemaKeyword::Description(family.doc.into()))
        .and([SchemaKeyword::Type("object")])
        .and(rest.0)
}

fn when(condition: SchemaNode, then: SchemaNode, otherwise: SchemaNode) -> SchemaNode {
    SchemaNode(vec![SchemaKeyword::If(condition), SchemaKeyword::Then(then), SchemaKeyword::Else(otherwise)])
}

fn required(keys: &[&'static str]) -> SchemaNode {
    SchemaNode::from(SchemaKeyword::Required(keys.to_vec()))
}

fn reference(name: &str) -> SchemaNode {
    SchemaNode::from(SchemaKeyword::Reference(format!("#/$defs/{name}")))
}

fn typed(kind: &'static str) -> SchemaNode {
    SchemaNode::from(SchemaKeyword::Type(kind))
}
