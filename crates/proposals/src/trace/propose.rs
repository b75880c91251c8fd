//! What was found, as an author takes it over: a `verify` object for each lab.

use super::lesson::Traces;
use super::rank::{Hit, Origin};
use super::trials::Trial;
use super::words::split_words;
use labspec::json::Scalar;
use labspec::spec::LabAddress;
use serde_json::{Map, Value, json};
use std::collections::BTreeMap;

/// A `verify` object for each lab that numbers come from. What is worked out goes to the first one.
pub fn blocks(found: &Traces<'_>) -> Vec<(LabAddress, Value)> {
    let mut all = Vec::new();
    let mut quoted: Vec<&str> = Vec::new();
    let first = found.numbers.iter().find_map(|n| match &n.origin {
        Origin::From(Hit { place: Some((lab, _)), .. }) => Some(*lab),
        _ => None,
    });
    for (l, tried) in found.labs.iter().enumerate() {
        let mut block = ProposedVerify::default();
        let mut says = Vec::new();
        for n in &found.numbers {
            let Origin::From(hit) = &n.origin else { continue };
            let here = hit.place.map_or(first == Some(l), |(lab, _)| lab == l);
            if !here || n.stated.answer || quoted.contains(&n.stated.quote.as_str()) {
                continue;
            }
            quoted.push(&n.stated.quote);
            let value = match hit.place {
                None => hit.measure.clone(),
                Some((_, trial)) => block.measured(trial, tried.trials.get(trial), &hit.measure),
            };
            says.push((n.stated.quote.clone(), hit.factor.clone(), value));
        }
        if says.is_empty() {
            continue;
        }
        let single = block.runs.len() == 1;
        let mut verify = Map::new();
        let plain = single && block.runs.values().all(|(_, run)| run.as_object().is_some_and(Map::is_empty));
        block.put(&mut verify);
        if plain {
            verify.remove("runs");
        }
        let line = |(quote, factor, value): (String, String, String)| {
            let value = if single {
                value
                    .rsplit_once('.')
                    .filter(|(run, _)| block.is_run(run))
                    .map_or(value.clone(), |(_, m)| m.to_string())
            } else {
                value
            };
            let value =
                if factor.is_empty() || block.is_measure(&value) { value } else { format!("({value})") };
            json!([quote, format!("{factor}{value}")])
        };
        verify.insert("says".into(), says.into_iter().map(line).collect());
        all.push((tried.address.clone(), Value::Object(verify)));
    }
    all
}

/// A `verify` object as an author would write it: a line for every run, measure and quote.
pub fn laid_out(verify: &Value) -> String {
    let line = |value: &Value| {
        let text = value.to_string();
        // JSON without the spaces that a reader wants: outside of texts.
        let (mut out, mut inside, mut escaped) = (String::new(), false, false);
        for c in text.chars() {
            inside ^= c == '"' && !escaped;
            escaped = inside && c == '\\' && !escaped;
            out.push(c);
            if !inside && matches!(c, ':' | ',') {
                out.push(' ');
            }
        }
        out
    };
    let block = |open: char, close: char, lines: Vec<String>| {
        format!("{open}\n    {}\n  {close}", lines.join(",\n    "))
    };
    let parts = verify.as_object().into_iter().flatten().map(|(key, part)| {
        let part = match part {
            Value::Object(map) => {
                let lines = map.iter().map(|(name, value)| format!("{}: {}", json!(name), line(value)));
                block('{', '}', lines.collect())
            }
            Value::Array(list) => block('[', ']', list.iter().map(line).collect()),
            other => line(other),
        };
        format!("  {}: {part}", json!(key))
    });
    format!("{{\n{}\n}}", parts.collect::<Vec<_>>().join(",\n"))
}

/// A `verify` object that grows.
#[derive(Default)]
pub(crate) struct ProposedVerify {
    /// By the place of the trial: a name, and how it is run.
    runs: BTreeMap<usize, (String, Value)>,
    measures: Vec<(String, String)>,
}

impl ProposedVerify {
    /// The name of a measure in a run.
    pub(crate) fn measured(&mut self, place: usize, trial: Option<&Trial>, text: &str) -> String {
        let taken: Vec<&str> = self.runs.values().map(|(name, _)| name.as_str()).collect();
        let run = match (self.runs.get(&place), trial) {
            (Some((name, _)), _) => name.clone(),
            (None, None) => String::new(),
            (None, Some(trial)) => {
                let name =
                    free(if place == 0 { "plain".into() } else { name_of(&trial.words, "run") }, &taken);
                self.runs.insert(place, (name.clone(), written(trial)));
                name
            }
        };
        let measure = self.measures.iter().find(|(_, measure)| measure == text).map(|(name, _)| name.clone());
        let measure = measure.unwrap_or_else(|| {
            let taken: Vec<&str> = self.measures.iter().map(|(name, _)| name.as_str()).collect();
            let name = free(name_of(text, "value"), &taken);
            self.measures.push((name.clone(), text.to_string()));
            name
        });
        format!("{run}.{measure}")
    }

    /// Puts runs and measures into an object.
    pub(crate) fn put(&self, verify: &mut Map<String, Value>) {
        if !self.runs.is_empty() {
            let runs = self.runs.values().map(|(name, run)| (name.clone(), run.clone()));
            verify.insert("runs".into(), Value::Object(runs.collect()));
        }
        if !self.measures.is_empty() {
            let measures = self.measures.iter().map(|(name, text)| (name.clone(), json!(text)));
            verify.insert("measure".into(), Value::Object(measures.collect()));
        }
    }

    fn is_run(&self, name: &str) -> bool {
        self.runs.values().any(|(run_name, _)| run_name == name)
    }

    fn is_measure(&self, value: &str) -> bool {
        value.split('.').all(|part| self.is_run(part) || self.measures.iter().any(|(name, _)| name == part))
    }
}

/// Most words of a name.
const WORDS: usize = 4;
/// Words that say nothing in one.
const EMPTY: [&str; 9] = ["data", "model", "with", "contact", "joint", "math", "time", "opt", "1000"];

/// A name that the language knows as one: the words of a text.
fn name_of(text: &str, otherwise: &str) -> String {
    let words: Vec<String> = split_words(text).filter(|w| !EMPTY.contains(&w.as_str())).take(WORDS).collect();
    let name: String = words.join("_").chars().filter(|c| c.is_ascii_alphanumeric() || *c == '_').collect();
    match name.chars().next() {
        Some(c) if c.is_ascii_alphabetic() => name,
        Some(_) => format!("{otherwise}_{name}"),
        None => otherwise.to_string(),
    }
}

fn free(name: String, taken: &[&str]) -> String {
    if !taken.contains(&name.as_str()) {
        return name;
    }
    let numbered = (2..).map(|n| format!("{name}_{n}")).find(|name| !taken.contains(&name.as_str()));
    numbered.unwrap_or(name)
}

/// How a run is made, as JSON.
fn written(trial: &Trial) -> Value {
    let mut run = Map::new();
    let scalar = |value: &Scalar| match value {
        Scalar::Number(n) => json!(n.value),
        Scalar::Text(text) => json!(text.value),
        Scalar::Bool(b, _) => json!(b),
    };
    if !trial.set.is_empty() {
        let set = trial.set.iter().map(|(label, value)| (label.clone(), scalar(value)));
        run.insert("set".into(), Value::Object(set.collect()));
    }
    if !trial.press.is_empty() {
        run.insert("press".into(), trial.press.iter().map(|label| json!([label, 0])).collect());
    }
    if let Some(statements) = trial.setup() {
        run.insert("setup".into(), json!(statements));
    }
    if let Some(until) = trial.until {
        run.insert("until".into(), json!(until));
    }
    Value::Object(run)
}
