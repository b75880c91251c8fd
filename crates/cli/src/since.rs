//! The differences between two records of a check: changed verdicts and values, and the settings and
//! models that changed with them.

use super::report_json::NonFinite;
use super::reproduction::{ClaimRecord, LessonRecord, ReproductionRecord, SettingsRecord};
use labspec::report::printable;
use labspec::verify::significant;
use schemars::JsonSchema;
use serde::Serialize;
use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;

/// What changed of one lab or question.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
#[schemars(rename = "change")]
pub(super) struct LessonChange {
    /// The lesson, from the folder of the record; empty for what concerns all.
    file: String,
    /// The lab or the question; `labspec` for its own version.
    owner: String,
    /// Verdicts and values that changed.
    effects: Vec<ChangedValue>,
    /// Settings, contacts, models and texts that changed with them.
    causes: Vec<ChangedValue>,
}

/// A verdict, value or setting that has changed.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
#[schemars(rename = "step")]
struct ChangedValue {
    /// What it is: a subject of the ledger, a measure, a setting.
    what: String,
    /// What it was; null where it was not there.
    #[schemars(extend("type" = RECORDED_TYPES))]
    before: Value,
    /// What it is; null where it is gone.
    #[serde(rename = "now")]
    #[schemars(extend("type" = RECORDED_TYPES))]
    current: Value,
    /// The change of a number, current minus previous; null for other values.
    difference: Option<f64>,
}

/// The types that a recorded value has.
const RECORDED_TYPES: [&str; 4] = ["null", "string", "number", "array"];

/// All differences, in the order of the files.
pub(super) fn changes(before: &ReproductionRecord, current: &ReproductionRecord) -> Vec<LessonChange> {
    let change = |file: &str, owner: &str, effects: Vec<ChangedValue>, causes: Vec<ChangedValue>| {
        LessonChange { file: file.into(), owner: owner.into(), effects, causes }
    };
    let mut causes = Vec::new();
    differ("labspec", &*before.labspec, &*current.labspec, &mut causes);
    differ("format", &*before.format, &*current.format, &mut causes);
    differ("engine", &*before.engine, &*current.engine, &mut causes);
    let mut all = vec![change("", "labspec", Vec::new(), causes)];
    let files: BTreeSet<&String> = before.lessons.iter().chain(&current.lessons).map(|l| &l.file).collect();
    for file in files {
        let what = match [before, current].map(|record| record.lessons.iter().find(|l| l.file == *file)) {
            [Some(old), Some(new)] => {
                for owner in owners(old).union(&owners(new)) {
                    let (effects, causes) = (effects(owner, old, new), causes_of(owner, old, new));
                    all.push(change(file, owner, effects, causes));
                }
                continue;
            }
            [None, _] => "new lesson",
            _ => "lesson that was not checked, or no longer exists",
        };
        let step =
            ChangedValue { what: what.into(), before: Value::Null, current: Value::Null, difference: None };
        all.push(change(file, "", vec![step], Vec::new()));
    }
    all.retain(|change| !change.effects.is_empty() || !change.causes.is_empty());
    all
}

/// All owners of verdicts, settings or values in a lesson.
fn owners(lesson: &LessonRecord) -> BTreeSet<String> {
    let verdicts = lesson.verdicts.iter().map(|v| v.owner.clone());
    let labs = lesson.labs.iter().map(|lab| format!("lab {}", lab.lab));
    verdicts.chain(labs).chain(lesson.claims.iter().map(|c| c.name.clone())).collect()
}

/// The changed verdicts and values of an owner.
fn effects(owner: &str, old: &LessonRecord, new: &LessonRecord) -> Vec<ChangedValue> {
    let mut steps = Vec::new();
    let [a, b] = [old, new].map(|lesson| {
        // Several verdicts with the same subject are distinguished by their order.
        let mut counts: BTreeMap<(&str, &str), usize> = BTreeMap::new();
        let verdicts = lesson.verdicts.iter().filter(|v| v.owner == owner).map(|v| {
            let count = counts.entry((&v.subject, &v.what)).or_default();
            *count += 1;
            ((&*v.subject, &*v.what, *count), Value::from(&*v.word))
        });
        verdicts.collect::<BTreeMap<_, Value>>()
    });
    let in_words = |(subject, what, _): &(&str, &str, usize)| match *what {
        "" => describe_key(subject),
        what => format!("{} \"{what}\"", describe_key(subject)),
    };
    differ_each(&a, &b, in_words, |_| Value::Null, &mut steps);
    let [a, b] = [old, new].map(|lesson| claim(lesson, owner));
    let [x, y] = [a, b].map(|c| {
        let all = c.into_iter().flat_map(|c| &c.measures);
        all.map(|(name, m)| (name, number(m.value, &m.nonfinite, "value"))).collect::<BTreeMap<_, _>>()
    });
    differ_each(&x, &y, |name| name.to_string(), |_| Value::Null, &mut steps);
    let [x, y] = [a, b].map(|c| c.map_or(&[][..], |c| c.quotes.as_slice()));
    for (x, y) in x.iter().zip(y).filter(|(x, y)| x.text == y.text) {
        let [before, current] = [x, y].map(|q| number(q.computed, &q.nonfinite, "computed"));
        differ(&format!("what \"{}\" quotes", x.text), before, current, &mut steps);
    }
    steps
}

fn claim<'r>(lesson: &'r LessonRecord, owner: &str) -> Option<&'r ClaimRecord> {
    lesson.claims.iter().find(|c| c.name == owner)
}

/// A number, or the name of a number that JSON cannot represent.
fn number(x: Option<f64>, nonfinite: &NonFinite, key: &str) -> Value {
    x.map_or_else(|| nonfinite.get(key).cloned().unwrap_or_default(), Value::from)
}

/// The changed texts, models and settings of an owner.
fn causes_of(owner: &str, old: &LessonRecord, new: &LessonRecord) -> Vec<ChangedValue> {
    let mut steps = Vec::new();
    let name = owner.strip_prefix("lab ").unwrap_or_default();
    let [c, d] = [old, new].map(|lesson| lesson.labs.iter().find(|lab| lab.lab == name));
    let [a, b] = [old, new].map(|lesson| claim(lesson, owner));
    differ("the text", c.map(|lab| &*lab.block), d.map(|lab| &*lab.block), &mut steps);
    let [x, y] = [c, d].map(|lab| lab.and_then(|lab| lab.model.as_deref()));
    differ("the model", x, y, &mut steps);
    // A change of the model itself has already been reported.
    let model_changed = x != y;
    let [x, y] = [c, d].map(|lab| lab.and_then(|lab| lab.settings.as_ref()));
    settings("", x, y, model_changed, &mut steps);
    if c.is_none() && d.is_none() {
        differ("the text", a.map(|c| &*c.block), b.map(|c| &*c.block), &mut steps);
    }
    let [x, y] = [a, b].map(|c| c.and_then(|c| c.model.as_deref()));
    if !model_changed {
        differ("the model", x, y, &mut steps);
    }
    let runs = [a, b].map(|c| c.map_or(&[][..], |c| c.runs.as_slice()));
    for name in runs.into_iter().flatten().map(|run| &run.name).collect::<BTreeSet<_>>() {
        let [before, current] = runs.map(|all| all.iter().find(|run| run.name == *name)?.settings.as_ref());
        settings(&format!(" of the run {name}"), before, current, x != y, &mut steps);
    }
    steps
}

/// The settings that every run has.
const NUMERICS: [&str; 6] = ["timestep", "integrator", "solver", "cone", "iterations", "tolerance"];

fn numerics(s: &SettingsRecord) -> [Value; 6] {
    let [integrator, solver, cone] = [&s.integrator, &s.solver, &s.cone].map(|name| Value::from(&**name));
    [s.timestep.into(), integrator, solver, cone, s.iterations.into(), s.tolerance.into()]
}

/// Options, and contact parameters by geom, that differ from the defaults.
fn parameters(s: Option<&SettingsRecord>) -> BTreeMap<(Option<&str>, &str), Value> {
    let options = s.into_iter().flat_map(|s| s.options.iter().map(|(name, value)| ((None, &**name), value)));
    let contacts = s
        .into_iter()
        .flat_map(|s| &s.contacts)
        .flat_map(|(geom, values)| values.iter().map(move |(name, value)| ((Some(&**geom), &**name), value)));
    options.chain(contacts).map(|(key, value)| (key, value.as_slice().into())).collect()
}

/// Compares the settings at the start of a run. `model_changed` states that a changed model has already been reported.
fn settings(
    of: &str,
    a: Option<&SettingsRecord>,
    b: Option<&SettingsRecord>,
    model_changed: bool,
    steps: &mut Vec<ChangedValue>,
) {
    let before = steps.len();
    let [x, y] = [a, b].map(|s| s.map_or_else(Default::default, numerics));
    for ((name, x), y) in NUMERICS.iter().zip(x).zip(y) {
        differ(&format!("{name}{of}"), x, y, steps);
    }
    let in_words = |(geom, name): &(Option<&str>, &str)| match geom {
        None => format!("{name}{of}"),
        Some(geom) => format!("{name} of the geom \"{geom}\"{of}"),
    };
    let default = |(geom, _): &(Option<&str>, &str)| {
        Value::from(if geom.is_none() { "the default" } else { "the defaults" })
    };
    differ_each(&parameters(a), &parameters(b), in_words, default, steps);
    // A property of the model without an entry in the record has changed, such as a mass or a length.
    if !model_changed && before == steps.len() {
        let [x, y] = [a, b].map(|s| s.map(|s| &*s.model));
        differ(&format!("the initial model{of}"), x, y, steps);
    }
}

/// Compares all entries of two maps, in order.
fn differ_each<K: Ord>(
    a: &BTreeMap<K, Value>,
    b: &BTreeMap<K, Value>,
    in_words: impl Fn(&K) -> String,
    missing: impl Fn(&K) -> Value,
    steps: &mut Vec<ChangedValue>,
) {
    for key in a.keys().chain(b.keys()).collect::<BTreeSet<_>>() {
        let [before, current] = [a, b].map(|all| all.get(key).cloned().unwrap_or_else(|| missing(key)));
        differ(&in_words(key), before, current, steps);
    }
}

fn differ(what: &str, before: impl Into<Value>, current: impl Into<Value>, steps: &mut Vec<ChangedValue>) {
    let (before, current) = (before.into(), current.into());
    if before != current {
        let difference = current.as_f64().zip(before.as_f64()).map(|(current, before)| current - before);
        steps.push(ChangedValue { what: what.into(), before, current, difference });
    }
}

/// Turns `quotedNumber` into words.
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
        let subject = match (change.file.as_str(), change.owner.as_str()) {
            ("", owner) => owner.to_string(),
            (file, "") => file.to_string(),
            (file, owner) if file == owner => file.to_string(),
            (file, owner) => format!("{file}, {owner}"),
        };
        let _ = writeln!(text, "  {}", printable(&subject));
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
    let by = step
        .difference
        .map_or(String::new(), |d| format!(" ({}{})", if d > 0.0 { "+" } else { "" }, significant(d)));
    match (&step.before, &step.current) {
        (Value::Null, Value::Null) => step.what.clone(),
        (a, b) if digest(a) && digest(b) => format!("{}: changed", step.what),
        (a, b) => format!("{}: {} → {}{by}", step.what, format_value(a), format_value(b)),
    }
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
