//! The results as proposals for the author: a `verify` object for each lab.

use super::candidates::Candidate;
use super::lab::TracedLab;
use super::lesson::Traces;
use super::names::{measure_name, slug};
use super::origin::{MeasureMatch, Origin};
use super::tables::TracedTable;
use super::trials::TraceRun;
use labspec::json::Scalar;
use labspec::spec::LabAddress;
use labspec::verify::Stated;
use serde::{Serialize, Serializer};
use serde_json::Value;
use std::collections::BTreeMap;

/// A `verify` object for each lab from which numbers originate. Evaluated formulas are added to the first one. Numbers whose digits
/// change with half the timestep are left out, and so are labs that compare integrators, whose runs have names of their own.
pub fn blocks(found: &Traces<'_>) -> Vec<(LabAddress, ProposedVerify)> {
    let in_tables = |s: &Stated| {
        let cells = found.tables.iter().flat_map(|table| &table.columns).flat_map(|column| &column.cells);
        cells.into_iter().any(|cell| cell.start <= s.span.start && s.span.start < cell.end)
    };
    blocks_of(found, &|s| !in_tables(s), &found.tables)
}

/// Comments that claim these numbers, in the order of the labs; with formulas alone, one without a lab.
pub fn comments_of(found: &Traces<'_>, is_chosen: &dyn Fn(&Stated) -> bool) -> Vec<ProposedVerify> {
    let blocks = blocks_of(found, is_chosen, &[]);
    let with_lab =
        |(lab, block): (LabAddress, ProposedVerify)| ProposedVerify { lab: Some(lab.to_string()), ..block };
    let mut all: Vec<ProposedVerify> = blocks.into_iter().map(with_lab).collect();
    if all.is_empty() {
        let formulas = found.numbers.iter().filter(|n| is_chosen(&n.stated));
        let says = formulas.filter_map(|n| match &n.origin {
            Origin::From(hit) if hit.place.is_none() => Some((n.stated.quote.clone(), hit.description())),
            _ => None,
        });
        let says: Vec<_> = says.collect();
        all.extend((!says.is_empty()).then(|| ProposedVerify { says, ..ProposedVerify::default() }));
    }
    all
}

/// The objects for the numbers that `is_chosen` accepts.
fn blocks_of(
    found: &Traces<'_>,
    is_chosen: &dyn Fn(&Stated) -> bool,
    tables: &[TracedTable],
) -> Vec<(LabAddress, ProposedVerify)> {
    let mut all = Vec::new();
    let mut quoted: Vec<&str> = Vec::new();
    let chosen = || found.numbers.iter().filter(|n| is_chosen(&n.stated));
    // Formulas go with the first lab.
    let first = chosen().find_map(|n| match &n.origin {
        Origin::From(MeasureMatch { place: Some((lab, _)), .. }) => Some(*lab),
        _ => None,
    });
    for (l, tried) in found.labs.iter().enumerate() {
        if tried.lab.comparison.is_some() {
            continue;
        }
        let mut block = ProposedVerify::default();
        let mut says = Vec::new();
        for n in chosen() {
            let Origin::From(hit) = &n.origin else { continue };
            if hit.fragile {
                continue;
            }
            let here = hit.place.map_or(first == Some(l), |(lab, _)| lab == l);
            if !here || n.stated.answer || quoted.contains(&n.stated.quote.as_str()) {
                continue;
            }
            quoted.push(&n.stated.quote);
            let value = match hit.place {
                None => hit.measure.clone(),
                Some((_, trial)) => {
                    let candidate = tried.candidates.iter().find(|c| c.text == hit.measure);
                    block.measured(trial, tried.trials.get(trial), &hit.measure, candidate)
                }
            };
            says.push((n.stated.quote.clone(), hit.factor.clone(), value));
        }
        for (k, table) in tables.iter().filter(|table| table.lab == l).enumerate() {
            block.add_table(k, table, tried);
        }
        if says.is_empty() && block.table.is_empty() {
            continue;
        }
        block.add_quotes(says);
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

/// Added to the places of the sweeps of tables.
const OF_TABLE: usize = 2000;

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
    /// Columns of tables.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    table: Vec<ProposedTable>,
}

/// The columns of a table that a sweep gives.
#[derive(Clone, Debug, PartialEq, Serialize)]
struct ProposedTable {
    /// The heading of the column with the values of the sweep, and the list of these values.
    by: [String; 2],
    /// The headings of the other columns, and the lists of their numbers.
    #[serde(serialize_with = "by_name")]
    columns: Vec<(String, String)>,
}

/// The settings of a run that differ from those of the unchanged lab.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
struct ProposedRun {
    /// Controls and their values.
    #[serde(skip_serializing_if = "Vec::is_empty", serialize_with = "by_name")]
    set: Vec<(String, Value)>,
    /// A control and the values that it has in turn.
    #[serde(skip_serializing_if = "Vec::is_empty", serialize_with = "by_name")]
    sweep: Vec<(String, Vec<f64>)>,
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
    /// Adds a run, and returns its name.
    pub(crate) fn run(&mut self, place: usize, trial: &TraceRun) -> String {
        if let Some((name, _)) = self.runs.get(&place) {
            return name.clone();
        }
        let used: Vec<&str> = self.runs.values().map(|(name, _)| name.as_str()).collect();
        let name = free(identifier(&trial.name, "run"), &used);
        self.runs.insert(place, (name.clone(), run(trial)));
        name
    }

    /// Adds a measure in a run, and returns its name.
    pub(crate) fn measured(
        &mut self,
        place: usize,
        trial: Option<&TraceRun>,
        text: &str,
        candidate: Option<&Candidate>,
    ) -> String {
        let run = trial.map_or(String::new(), |trial| self.run(place, trial));
        let measure = self.measure.iter().find(|(_, measure)| measure == text).map(|(name, _)| name.clone());
        let measure = measure.unwrap_or_else(|| {
            let used: Vec<&str> = self.measure.iter().map(|(name, _)| name.as_str()).collect();
            let requested = candidate.map_or_else(|| slug(text), measure_name);
            let name = free(identifier(&requested, "value"), &used);
            self.measure.push((name.clone(), text.to_string()));
            name
        });
        format!("{run}.{measure}")
    }

    /// Adds a measure of a run of the trace. A run with the same settings as an earlier one has its name.
    pub(crate) fn traced(&mut self, place: usize, tried: &TracedLab<'_>, trial: usize, text: &str) -> String {
        let candidate = tried.candidates.iter().find(|c| c.text == text);
        let trial = tried.trials.get(trial);
        let same =
            trial.map(run).and_then(|requested| self.runs.iter().find(|(_, (_, run))| *run == requested));
        let place = same.map_or(place, |(place, _)| *place);
        self.measured(place, trial, text, candidate)
    }

    /// Adds quotes with their factors and measures. If there is only one run, its measures have no prefix.
    fn add_quotes(&mut self, says: Vec<(String, String, String)>) {
        let single = self.runs.len() == 1;
        let line = |(quote, factor, mut value): (String, String, String)| {
            if let Some((_, measure)) = value.rsplit_once('.').filter(|(run, _)| single && self.is_run(run)) {
                value = measure.to_string();
            }
            if !factor.is_empty() && !self.is_measure(&value) {
                value = format!("({value})");
            }
            (quote, format!("{factor}{value}"))
        };
        self.says = says.into_iter().map(line).collect();
        if single
            && self.table.is_empty()
            && self.runs.values().all(|(_, run)| *run == ProposedRun::default())
        {
            self.runs.clear();
        }
    }

    /// Adds the sweep, the measures and the columns of a table.
    fn add_table(&mut self, k: usize, table: &TracedTable, tried: &TracedLab<'_>) {
        let place = OF_TABLE + k;
        let used: Vec<&str> = self.runs.values().map(|(name, _)| name.as_str()).collect();
        let requested = match table.run.set.is_empty() {
            true => "rows".to_string(),
            false => format!("rows_{}", table.run.name),
        };
        let name = free(identifier(&requested, "rows"), &used);
        let sweep = vec![(table.control.clone(), table.values.clone())];
        self.runs.insert(place, (name.clone(), ProposedRun { sweep, ..run(&table.run) }));
        let mut columns = Vec::new();
        for column in &table.columns {
            let candidate = tried.candidates.iter().find(|c| c.text == column.measure);
            let measured = self.measured(place, Some(&table.run), &column.measure, candidate);
            let value = match column.factor.as_str() {
                "" => measured,
                factor => format!("{measured}.map(x => {factor}x)"),
            };
            columns.push((column.head.clone(), value));
        }
        self.table.push(ProposedTable { by: [table.by.clone(), format!("{name}.value")], columns });
    }

    fn is_run(&self, name: &str) -> bool {
        self.runs.values().any(|(run_name, _)| run_name == name)
    }

    fn is_measure(&self, value: &str) -> bool {
        value.split('.').all(|part| self.is_run(part) || self.measure.iter().any(|(name, _)| name == part))
    }
}

/// A valid name in the language.
fn identifier(name: &str, otherwise: &str) -> String {
    let name: String = name.chars().filter(|c| c.is_ascii_alphanumeric() || *c == '_').collect();
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
        sweep: Vec::new(),
        press: trial.press.iter().map(|label| (label.clone(), 0)).collect(),
        setup: trial.setup(),
        until: trial.until,
    }
}
