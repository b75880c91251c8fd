//! The type of a key in words, for the reference page and for editors.

use super::{Absent, Key, Limits, Type, texts};
use crate::spec::CodeForm;
use serde_json::{Map, Value};

/// The type of a key, with its unit and its limits: `number above 0, in s`.
pub(super) fn takes(key: &Key) -> String {
    let mut text = kind(&key.ty);
    text.push_str(&limits(&key.limits));
    if !key.unit.is_empty() {
        text.push_str(&format!(", in {}", key.unit));
    }
    match key.items {
        0 => {}
        1 => text.push_str(", at least one"),
        n => text.push_str(&format!(", at least {n}")),
    }
    text
}

fn kind(ty: &Type) -> String {
    match ty {
        Type::Text | Type::Name(_) => "text".into(),
        Type::Html => "text, can contain HTML".into(),
        Type::Code(CodeForm::Expression) => "code: an expression".into(),
        Type::Code(CodeForm::Statements) => "code: statements".into(),
        Type::Code(CodeForm::Target) => "code: an assignable field".into(),
        Type::Number => "number".into(),
        Type::Whole => "integer".into(),
        Type::Flag => "true or false".into(),
        Type::Null => "`null`".into(),
        Type::Scalar => "number, text, true or false".into(),
        Type::Words(words) => {
            let all: Vec<String> = texts(words).map(|w| format!("\"{w}\"")).collect();
            all.join(", ")
        }
        Type::List(item) => format!("list of {}", plural(item)),
        Type::Numbers(n) => format!("list of {n} numbers"),
        Type::Pair([first, second]) => format!("[{}, {}]", first.what, second.what),
        Type::Map(map) => format!("object: {} → {}", map.names, kind(&map.ty)),
        Type::Switches(_) => "object: word → true or false".into(),
        Type::Object(object) => object.what.into(),
        Type::OneOf(family) => family.what.into(),
        Type::Either(a, b) => format!("{}, or {}", kind(a), kind(b)),
    }
}

fn plural(ty: &Type) -> String {
    match ty {
        Type::Text | Type::Name(_) => "texts".into(),
        Type::Html => "texts, can contain HTML".into(),
        Type::Code(CodeForm::Expression) => "expressions".into(),
        Type::Number => "numbers".into(),
        Type::Object(object) => format!("{} objects", object.name),
        Type::OneOf(family) => format!("{} objects", family.name),
        Type::Pair(_) => format!("pairs {}", kind(ty)),
        Type::Words(_) => format!("words: {}", kind(ty)),
        other => kind(other),
    }
}

fn limits(limits: &Limits) -> String {
    match (limits.above, limits.least, limits.most) {
        (_, Some(least), Some(most)) => format!(" from {least} to {most}"),
        (Some(above), ..) => format!(" above {above}"),
        (_, Some(least), _) => format!(" of at least {least}"),
        (.., Some(most)) => format!(" of at most {most}"),
        _ => String::new(),
    }
}

/// The default of a key, as JSON. `None` if it has none, or if the default depends on other values.
pub(super) fn default(key: &Key) -> Option<Value> {
    Some(match key.absent {
        Absent::Nothing | Absent::Described(_) => return None,
        Absent::Number(x) => number(x),
        Absent::Text(text) => text.into(),
        Absent::False => false.into(),
        Absent::Numbers(all) => all.iter().map(|x| number(*x)).collect(),
        Absent::Empty if matches!(key.ty, Type::List(_)) => Value::Array(Vec::new()),
        Absent::Empty => Map::new().into(),
    })
}

/// A number in the usual notation: an integer is written without decimals.
pub(super) fn number(x: f64) -> Value {
    if x.fract() == 0.0 && x.abs() < 1e15 { Value::from(x as i64) } else { Value::from(x) }
}

impl Key {
    /// Whether an object without this key is invalid.
    pub fn required(&self) -> bool {
        self.items > 0 || matches!(self.need, super::Need::Must(_))
    }
}
