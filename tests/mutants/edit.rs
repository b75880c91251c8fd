//! Changes to the JSON of a lab or a quiz, at every possible location.

use serde_json::Value;
use std::fmt::Write;

/// Copies of an object, each with one of the values at this path changed; `*` is every element of a list. There is no copy for
/// a value for which `change` returns `None`.
pub(super) fn each(json: &Value, path: &[&str], change: impl Fn(&Value) -> Option<Value>) -> Vec<Value> {
    let mut places = vec![String::new()];
    for part in path {
        let mut longer = Vec::new();
        for place in places {
            let at = json.pointer(&place).unwrap_or(&Value::Null);
            match *part {
                "*" => {
                    let count = at.as_array().map_or(0, Vec::len);
                    longer.extend((0..count).map(|i| format!("{place}/{i}")));
                }
                key if at.get(key).is_some() => longer.push(format!("{place}/{key}")),
                _ => {}
            }
        }
        places = longer;
    }
    let made = |place: String| {
        let new = change(json.pointer(&place)?)?;
        let mut copy = json.clone();
        *copy.pointer_mut(&place)? = new;
        (copy != *json).then_some(copy)
    };
    places.into_iter().filter_map(made).collect()
}

/// As `each`, for texts.
pub(super) fn text(json: &Value, path: &[&str], change: impl Fn(&str) -> Option<String>) -> Vec<Value> {
    each(json, path, |old| Some(Value::from(change(old.as_str()?)?)))
}

/// Changes every control.
pub(super) fn controls(json: &Value, change: impl Fn(&mut Value) -> Option<()>) -> Vec<Value> {
    each(json, &["controls", "*"], |old| {
        let mut new = old.clone();
        change(&mut new)?;
        Some(new)
    })
}

/// Changes the expression of every trace and readout.
pub(super) fn displayed_code(json: &Value, change: impl Fn(&str) -> Option<String>) -> Vec<Value> {
    let mut all = text(json, &["plots", "*", "traces", "*", "expr"], &change);
    all.extend(text(json, &["readouts", "*", "expr"], &change));
    all
}

/// Changes all statements and targets.
pub(super) fn statements(json: &Value, change: impl Fn(&str) -> Option<String>) -> Vec<Value> {
    let mut all = text(json, &["setup"], &change);
    all.extend(text(json, &["controller"], &change));
    for key in ["set", "apply", "run"] {
        all.extend(text(json, &["controls", "*", key], &change));
    }
    all
}

/// Changes all code.
pub(super) fn code(json: &Value, change: impl Fn(&str) -> Option<String>) -> Vec<Value> {
    let mut all = statements(json, &change);
    all.extend(displayed_code(json, &change));
    all
}

/// The lab with a top-level key set.
pub(super) fn with(json: &Value, key: &str, value: Value) -> Vec<Value> {
    let mut copy = json.clone();
    if let Some(object) = copy.as_object_mut() {
        object.insert(key.into(), value);
    }
    vec![copy]
}

/// The lab without a top-level key.
pub(super) fn without(json: &Value, key: &str) -> Vec<Value> {
    let mut copy = json.clone();
    let had = copy.as_object_mut().and_then(|o| o.shift_remove(key));
    had.map_or(Vec::new(), |_| vec![copy])
}

/// The lab with statements added after its setup.
pub(super) fn setup(json: &Value, more: &str) -> Vec<Value> {
    let old = json["setup"].as_str().unwrap_or("");
    with(json, "setup", Value::from(if old.is_empty() { more.into() } else { format!("{old}; {more}") }))
}

/// Replaces the first occurrence of a word; `None` if the text does not contain it.
pub(super) fn swap(text: &str, word: &str, other: &str) -> Option<String> {
    text.contains(word).then(|| text.replacen(word, other, 1))
}

/// Increases the first index `[n]` of a text by `by`.
pub(super) fn move_index(text: &str, by: usize) -> Option<String> {
    let open = text.match_indices('[').map(|(i, _)| i).find(|&i| {
        let rest = &text[i + 1..];
        rest.starts_with(|c: char| c.is_ascii_digit()) && i > 0 && !text[..i].ends_with([' ', '('])
    })?;
    let close = open + text[open..].find(']')?;
    let n: usize = text[open + 1..close].parse().ok()?;
    Some(format!("{}{}{}", &text[..=open], n + by, &text[close..]))
}

/// Lists the differences between two objects.
pub(super) fn differences(path: &str, a: &Value, b: &Value, page: &mut String) {
    let keys = |v: &Value| -> Vec<String> {
        match v {
            Value::Object(map) => map.keys().cloned().collect(),
            Value::Array(list) => (0..list.len()).map(|i| i.to_string()).collect(),
            _ => Vec::new(),
        }
    };
    let mut all = keys(a);
    all.extend(keys(b).into_iter().filter(|k| !keys(a).contains(k)));
    if a == b {
    } else if all.is_empty() || a.is_object() != b.is_object() {
        writeln!(page, "    {path}: {a}\n      -> {b}").unwrap();
    } else {
        let at = |v: &Value, key: &str| v.pointer(&format!("/{key}")).cloned().unwrap_or(Value::Null);
        all.iter().for_each(|k| differences(&format!("{path}/{k}"), &at(a, k), &at(b, k), page));
    }
}
