//! The results as proposals for the author: a `verify` object for each lab.

use super::lesson::Traces;
use super::rank::{MeasureMatch, Origin};
use super::trials::TraceRun;
use super::words::split_words;
use labspec::json::Scalar;
use labspec::spec::LabAddress;
use serde::{Serialize, Serializer};
use serde_json::Value;
use std::collections::BTreeMap;

/// A `verify` object for each lab from which numbers originate. Evaluated formulas are added to the first one.
pub fn blocks(found: &Traces<'_>) -> Vec<(LabAddress, ProposedVerify)> {
    let mut all = Vec::new();
    let mut quoted: Vec<&str> = Vec::new();
    let first = found.numbers.iter().find_map(|n| match &n.origin {
        Origin::From(MeasureMatch { place: Some((lab, _)), .. }) => Some(*lab),
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
        let line = |(quote, factor, mut value): (String, String, String)| {
            if let Some((_, measure)) = value.rsplit_once('.').filter(|(run, _)| single && block.is_run(run))
            {
                value = measure.to_string();
            }
            if !factor.is_empty() && !block.is_measure(&value) {
                value = format!("({value})");
            }
            (quote, format!("{factor}{value}"))
        };
        block.says = says.into_iter().map(line).collect();
        if single && block.runs.values().all(|(_, run)| *run == ProposedRun::default()) {
            block.runs.clear();
        }
        all.push((tried.address.clone(), block));
    }
    all
}

/// A `verify` object as an author would write it: a line for every run, measure and quote.
pub fn format_verify(verify: &ProposedVerify) -> String {
    let line = |value: &Value| {
        let text = value.to_string();
        // JSON without spaces; spaces for readability are added outside of strings.
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
    let verify = serde_json::to_value(verify).unwrap_or_default();
    let parts = verify.as_object().into_iter().flatten().map(|(key, part)| {
        let part = match part {
            Value::Object(map) => {
                let lines = map.iter().map(|(name, value)| format!("{}: {}", quoted(name), line(value)));
                block('{', '}', lines.collect())
            }
            Value::Array(list) => block('[', ']', list.iter().map(line).collect()),
            other => line(other),
        };
        format!("  {}: {part}", quoted(key))
    });
    format!("{{\n{}\n}}", parts.collect::<Vec<_>>().join(",\n"))
}

fn quoted(text: &str) -> Value {
    Value::from(text)
}

/// A `verify` object under construction.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct ProposedVerify {
    /// The address of the lab, if it is not obvious.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) lab: Option<String>,
    /// By index of the trial: a name, and the settings of the run.
    #[serde(skip_serializing_if = "BTreeMap::is_empty", serialize_with = "runs_by_name")]
    runs: BTreeMap<usize, (String, ProposedRun)>,
    /// Names and expressions.
    #[serde(skip_serializing_if = "Vec::is_empty", serialize_with = "by_name")]
    measure: Vec<(String, String)>,
    /// A condition for each option.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub(crate) options: Vec<String>,
    /// The value of a numeric question.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) value: Option<String>,
    /// Quotes and their expressions.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub(crate) says: Vec<(String, String)>,
}

/// The settings of a run that differ from those of the unchanged lab.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
struct ProposedRun {
    /// Controls and their values.
    #[serde(skip_serializing_if = "Vec::is_empty", serialize_with = "by_name")]
    set: Vec<(String, Value)>,
    /// Buttons and the times at which they are pressed, s.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    press: Vec<(String, u8)>,
    /// Statements before the first step.
    #[serde(skip_serializing_if = "Option::is_none")]
    setup: Option<String>,
    /// Its length, s.
    #[serde(skip_serializing_if = "Option::is_none")]
    until: Option<f64>,
}

fn by_name<S: Serializer>(entries: &[(String, impl Serialize)], to: S) -> Result<S::Ok, S::Error> {
    to.collect_map(entries.iter().map(|(name, value)| (name, value)))
}

fn runs_by_name<S: Serializer>(
    runs: &BTreeMap<usize, (String, ProposedRun)>,
    to: S,
) -> Result<S::Ok, S::Error> {
    to.collect_map(runs.values().map(|(name, run)| (name, run)))
}

impl ProposedVerify {
    /// Adds a measure in a run, and returns its name.
    pub(crate) fn measured(&mut self, place: usize, trial: Option<&TraceRun>, text: &str) -> String {
        let used: Vec<&str> = self.runs.values().map(|(name, _)| name.as_str()).collect();
        let run = match (self.runs.get(&place), trial) {
            (Some((name, _)), _) => name.clone(),
            (None, None) => String::new(),
            (None, Some(trial)) => {
                let name =
                    free(if place == 0 { "plain".into() } else { name_of(&trial.words, "run") }, &used);
                self.runs.insert(place, (name.clone(), run(trial)));
                name
            }
        };
        let measure = self.measure.iter().find(|(_, measure)| measure == text).map(|(name, _)| name.clone());
        let measure = measure.unwrap_or_else(|| {
            let used: Vec<&str> = self.measure.iter().map(|(name, _)| name.as_str()).collect();
            let name = free(name_of(text, "value"), &used);
            self.measure.push((name.clone(), text.to_string()));
            name
        });
        format!("{run}.{measure}")
    }

    fn is_run(&self, name: &str) -> bool {
        self.runs.values().any(|(run_name, _)| run_name == name)
    }

    fn is_measure(&self, value: &str) -> bool {
        value.split('.').all(|part| self.is_run(part) || self.measure.iter().any(|(name, _)| name == part))
    }
}

/// The maximum number of words of a name.
const WORDS: usize = 4;
/// Words that carry no information in a name.
const EMPTY: [&str; 9] = ["data", "model", "with", "contact", "joint", "math", "time", "opt", "1000"];

/// A valid name in the language, made of the words of a text.
fn name_of(text: &str, otherwise: &str) -> String {
    let words: Vec<String> = split_words(text).filter(|w| !EMPTY.contains(&w.as_str())).take(WORDS).collect();
    let name: String = words.join("_").chars().filter(|c| c.is_ascii_alphanumeric() || *c == '_').collect();
    match name.chars().next() {
        Some(c) if c.is_ascii_alphabetic() => name,
        Some(_) => format!("{otherwise}_{name}"),
        None => otherwise.to_string(),
    }
}

fn free(name: String, used: &[&str]) -> String {
    if !used.contains(&name.as_str()) {
        return name;
    }
    let numbered = (2..).map(|n| format!("{name}_{n}")).find(|name| !used.contains(&name.as_str()));
    numbered.unwrap_or(name)
}

/// The settings of a run.
fn run(trial: &TraceRun) -> ProposedRun {
    let scalar = |value: &Scalar| match value {
        Scalar::Number(n) => n.value.into(),
        Scalar::Text(text) => text.value.as_str().into(),
        Scalar::Bool(b, _) => (*b).into(),
    };
    ProposedRun {
        set: trial.set.iter().map(|(label, value)| (label.clone(), scalar(value))).collect(),
        press: trial.press.iter().map(|label| (label.clone(), 0)).collect(),
        setup: trial.setup(),
        until: trial.until,
    }
}
