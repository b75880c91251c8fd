//! What has changed between two records of a check: verdicts and values, and the settings and models that changed with them.

use labspec::report::printable;
use labspec::verify::significant;
use serde_json::{Value, json};
use std::collections::BTreeSet;
use std::fmt::Write;

/// What changed of one lab, one question, or of labspec itself.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct LessonChange {
    /// The lesson; empty for what concerns all of them.
    pub(super) file: String,
    /// The lab or the question.
    pub(super) owner: String,
    /// What it came to: verdicts and values.
    pub(super) effects: Vec<ChangedValue>,
    /// What changed with it: settings, contacts, models, texts.
    pub(super) causes: Vec<ChangedValue>,
}

/// Something that was one thing and is another.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct ChangedValue {
    pub(super) what: String,
    /// `null` where it was not there.
    pub(super) before: Value,
    /// `null` where it is gone.
    pub(super) now: Value,
}

/// Everything that differs, in the order of the files.
pub(super) fn changes(before: &Value, now: &Value) -> Vec<LessonChange> {
    let mut all = Vec::new();
    let mut head = LessonChange {
        file: String::new(),
        owner: "labspec".into(),
        effects: Vec::new(),
        causes: Vec::new(),
    };
    for key in ["labspec", "format", "engine"] {
        differ(key, &before[key], &now[key], &mut head.causes);
    }
    let files = |v: &Value| names(&v["lessons"], "file");
    for file in files(before).union(&files(now)) {
        let [old, new] = [before, now].map(|v| one(&v["lessons"], "file", file));
        if old.is_null() || new.is_null() {
            let what =
                if old.is_null() { "new lesson" } else { "lesson that was not checked, or no longer exists" };
            let step = ChangedValue { what: what.into(), before: Value::Null, now: Value::Null };
            all.push(LessonChange {
                file: file.clone(),
                owner: String::new(),
                effects: vec![step],
                causes: Vec::new(),
            });
            continue;
        }
        lesson(file, old, new, &mut all);
    }
    all.retain(|change| !change.effects.is_empty() || !change.causes.is_empty());
    if !head.causes.is_empty() {
        all.insert(0, head);
    }
    all
}

fn lesson(file: &str, old: &Value, new: &Value, all: &mut Vec<LessonChange>) {
    let owners = |v: &Value| {
        let verdicts = names(&v["verdicts"], "owner");
        let labs = names(&v["labs"], "lab").into_iter().map(|lab| format!("lab {lab}"));
        verdicts.into_iter().chain(labs).chain(names(&v["claims"], "name")).collect::<BTreeSet<String>>()
    };
    for owner in owners(old).union(&owners(new)) {
        let mut change =
            LessonChange { file: file.into(), owner: owner.clone(), effects: Vec::new(), causes: Vec::new() };
        let of = |v: &Value| {
            let list = v["verdicts"].as_array().into_iter().flatten();
            list.filter(|e| e["owner"] == owner.as_str()).cloned().collect::<Vec<Value>>()
        };
        verdicts(&of(old), &of(new), &mut change.effects);
        let [a, b] = [old, new].map(|v| one(&v["claims"], "name", owner));
        values(a, b, &mut change.effects);
        let lab = owner.strip_prefix("lab ").unwrap_or_default();
        let [c, d] = [old, new].map(|v| one(&v["labs"], "lab", lab));
        differ("the text", &c["block"], &d["block"], &mut change.causes);
        differ("the model", &c["model"], &d["model"], &mut change.causes);
        // What the model itself is has been said.
        let compiled = c["model"] != d["model"];
        settings("", &c["settings"], &d["settings"], compiled, &mut change.causes);
        if c.is_null() && d.is_null() {
            differ("the text", &a["block"], &b["block"], &mut change.causes);
        }
        let model_changed = change.causes.iter().any(|s| s.what == "the model");
        if !model_changed {
            differ("the model", &a["model"], &b["model"], &mut change.causes);
        }
        let compiled = a["model"] != b["model"];
        for name in names(&a["runs"], "name").union(&names(&b["runs"], "name")) {
            let [a, b] = [a, b].map(|v| one(&v["runs"], "name", name));
            let of = format!(" of the run {name}");
            settings(&of, &a["settings"], &b["settings"], compiled, &mut change.causes);
        }
        all.push(change);
    }
}

/// Verdicts about one owner: of several of the same kind in their order.
fn verdicts(old: &[Value], new: &[Value], steps: &mut Vec<ChangedValue>) {
    let mark = |e: &Value| (e["subject"].to_string(), e["what"].to_string());
    let keys: BTreeSet<(String, String)> = old.iter().chain(new).map(mark).collect();
    for key in keys {
        let of = |all: &[Value]| all.iter().filter(|e| mark(e) == key).cloned().collect::<Vec<Value>>();
        let [a, b] = [of(old), of(new)];
        for i in 0..a.len().max(b.len()) {
            let [a, b] = [a.get(i), b.get(i)].map(|e| e.cloned().unwrap_or(Value::Null));
            let one = if a.is_null() { &b } else { &a };
            let subject = describe_key(one["subject"].as_str().unwrap_or_default());
            let what =
                one["what"].as_str().filter(|w| !w.is_empty()).map_or(String::new(), |w| format!(" \"{w}\""));
            differ(&format!("{subject}{what}"), &a["word"], &b["word"], steps);
        }
    }
}

/// Values of measures and of what is quoted.
fn values(a: &Value, b: &Value, steps: &mut Vec<ChangedValue>) {
    let measures = |v: &Value| v["measures"].as_object().cloned().unwrap_or_default();
    let [old, new] = [measures(a), measures(b)];
    let all: BTreeSet<&String> = old.keys().chain(new.keys()).collect();
    for name in all {
        let value = |m: &serde_json::Map<String, Value>| m.get(name).map_or(Value::Null, number);
        differ(name, &value(&old), &value(&new), steps);
    }
    let quotes = |v: &Value| v["quotes"].as_array().cloned().unwrap_or_default();
    for (a, b) in quotes(a).iter().zip(&quotes(b)).filter(|(a, b)| a["text"] == b["text"]) {
        let what = format!("what \"{}\" quotes", a["text"].as_str().unwrap_or_default());
        differ(&what, &quoted(a), &quoted(b), steps);
    }
}

/// The value of a measure: a number, or the name of what JSON has no number for.
fn number(measure: &Value) -> Value {
    if measure["value"].is_null() { measure["nonfinite"]["value"].clone() } else { measure["value"].clone() }
}

fn quoted(quote: &Value) -> Value {
    if quote["computed"].is_null() {
        quote["nonfinite"]["computed"].clone()
    } else {
        quote["computed"].clone()
    }
}

/// Settings of a run that begins. `compiled`: that the model changed has been said.
fn settings(of: &str, a: &Value, b: &Value, compiled: bool, steps: &mut Vec<ChangedValue>) {
    let before = steps.len();
    for key in ["timestep", "integrator", "solver", "cone", "iterations", "tolerance"] {
        differ(&format!("{key}{of}"), &a[key], &b[key], steps);
    }
    for (key, default) in [("options", "the default"), ("contacts", "the defaults")] {
        for name in keys(&a[key]).union(&keys(&b[key])) {
            let [a, b] = [&a[key][name.as_str()], &b[key][name.as_str()]];
            if key == "options" {
                differ(&format!("{name}{of}"), &or(a, default), &or(b, default), steps);
                continue;
            }
            for parameter in keys(a).union(&keys(b)) {
                let [a, b] = [a, b].map(|v| or(&v[parameter.as_str()], default));
                differ(&format!("{parameter} of the geom \"{name}\"{of}"), &a, &b, steps);
            }
        }
    }
    // Something of the model that has no name here: a mass, a length.
    if !compiled && before == steps.len() {
        differ(&format!("the initial model{of}"), &a["model"], &b["model"], steps);
    }
}

fn or(value: &Value, default: &str) -> Value {
    if value.is_null() { json!(default) } else { value.clone() }
}

fn differ(what: &str, before: &Value, now: &Value, steps: &mut Vec<ChangedValue>) {
    if before != now {
        steps.push(ChangedValue { what: what.into(), before: before.clone(), now: now.clone() });
    }
}

fn keys(value: &Value) -> BTreeSet<String> {
    value.as_object().into_iter().flat_map(|o| o.keys().cloned()).collect()
}

/// The names of the entries of a list.
fn names(list: &Value, key: &str) -> BTreeSet<String> {
    list.as_array().into_iter().flatten().filter_map(|e| e[key].as_str().map(String::from)).collect()
}

/// The entry of a list with this name; `null` where there is none.
fn one<'v>(list: &'v Value, key: &str, name: &str) -> &'v Value {
    list.as_array().into_iter().flatten().find(|e| e[key] == name).unwrap_or(&Value::Null)
}

/// `quotedNumber` in words.
fn describe_key(key: &str) -> String {
    let mut words = String::new();
    for c in key.chars() {
        if c.is_ascii_uppercase() {
            words.push(' ');
        }
        words.push(c.to_ascii_lowercase());
    }
    words
}

/// All changes, for people.
pub(super) fn summary(name: &str, all: &[LessonChange]) -> String {
    let name = printable(name);
    if all.is_empty() {
        return format!("nothing has changed since {name}\n");
    }
    let mut text = format!("since {name}:\n");
    for change in all {
        let at = match (change.file.as_str(), change.owner.as_str()) {
            ("", owner) => owner.to_string(),
            (file, "") => file.to_string(),
            (file, owner) if file == owner => file.to_string(),
            (file, owner) => format!("{file}, {owner}"),
        };
        let _ = writeln!(text, "  {}", printable(&at));
        for step in &change.effects {
            let _ = writeln!(text, "    {}", printable(&line(step)));
        }
        for step in &change.causes {
            let _ = writeln!(text, "    with {}", printable(&line(step)));
        }
    }
    text
}

fn line(step: &ChangedValue) -> String {
    let digest = |v: &Value| v.as_str().is_some_and(|t| t.len() == 64);
    let by = difference(step)
        .map_or(String::new(), |d| format!(" ({}{})", if d > 0.0 { "+" } else { "" }, significant(d)));
    match (&step.before, &step.now) {
        (Value::Null, Value::Null) => step.what.clone(),
        (a, b) if digest(a) && digest(b) => format!("{}: changed", step.what),
        (a, b) => format!("{}: {} → {}{by}", step.what, format_value(a), format_value(b)),
    }
}

/// By how much a number has changed.
fn difference(step: &ChangedValue) -> Option<f64> {
    Some(step.now.as_f64()? - step.before.as_f64()?)
}

fn format_value(value: &Value) -> String {
    match value {
        Value::Null => "missing".into(),
        Value::String(text) if text.len() == 64 => "there".into(),
        Value::String(text) => text.clone(),
        Value::Number(n) => n.as_f64().map_or(n.to_string(), significant),
        Value::Array(list) => list.iter().map(format_value).collect::<Vec<_>>().join(" "),
        other => other.to_string(),
    }
}

/// All changes, for programs.
pub(super) fn machine(all: &[LessonChange]) -> Value {
    let step = |s: &ChangedValue| json!({"what": s.what, "before": s.before, "now": s.now, "difference": difference(s)});
    let steps = |list: &[ChangedValue]| list.iter().map(step).collect::<Vec<_>>();
    let change = |c: &LessonChange| json!({"file": c.file, "owner": c.owner, "effects": steps(&c.effects), "causes": steps(&c.causes)});
    all.iter().map(change).collect()
}
