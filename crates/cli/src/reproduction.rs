//! `labspec check --record FILE`: every verdict with what it rests on; and `--since FILE`: what has changed since.
//!
//! Files are named from the folder of the record, so that it says the same on every machine.

use super::common::Failure;
use super::course::CourseResults;
use super::output::write_file;
use super::output_kind::OutputKind;
use labspec::check::{Basis, Checked, Claim, ClaimBasis, LabBasis, RunSettings};
use labspec::ledger::{Entry, Ledger};
use labspec::report::{self, key, printable_path, set_number};
use labspec::source::read_text;
use serde_json::{Map, Value, json};
use std::path::{Path, PathBuf};

/// Bytes of a record, at most.
const MOST: u64 = 64 << 20;
/// Whose meaning the engine has.
const ENGINE: &str = "MuJoCo 3.14.0";
/// The format of lessons.
const FORMAT: &str = "0.1";

/// What a results says now, as it would be recorded in this file.
pub(super) fn now(file: &Path, results: &CourseResults) -> Value {
    let folder = folder_of(file);
    let mut lessons: Vec<(String, Value)> = results
        .checked
        .iter()
        .zip(&results.bases)
        .map(|(c, basis)| {
            let name = name_of(&folder, c.lesson.file.path());
            (name.clone(), lesson(&name, c, basis, &results.ledger))
        })
        .collect();
    lessons.sort_by(|a, b| a.0.cmp(&b.0));
    let lessons: Vec<Value> = lessons.into_iter().map(|(_, value)| value).collect();
    let head = json!({
        "labspec": env!("CARGO_PKG_VERSION"), "format": FORMAT, "engine": ENGINE, "lessons": lessons,
    });
    report::report("reproduction", head)
}

/// Writes a record.
///
/// # Errors
/// The file cannot be written.
pub(super) fn write(file: &Path, record: &Value) -> Result<(), Failure> {
    let text = serde_json::to_string_pretty(record).map_err(|e| e.to_string())?;
    write_file(file, OutputKind::Record, &(text + "\n"))
}

/// Reads a record.
///
/// # Errors
/// It cannot be read, or is none.
pub(super) fn read(file: &Path) -> Result<Value, Failure> {
    let no = |why: &str| {
        format!(
            "{} is not a record of a check: {why}; labspec check --record writes one",
            printable_path(file)
        )
    };
    let text = read_text(file, MOST, "a record of a check")?;
    let value: Value = serde_json::from_str(&text).map_err(|e| no(&e.to_string()))?;
    if value["report"] != "reproduction" || value["schemaVersion"] != report::SCHEMA_VERSION {
        return Err(no("its version is missing or unsupported"));
    }
    if !value["lessons"].is_array() {
        return Err(no("it has no lessons"));
    }
    Ok(value)
}

fn folder_of(file: &Path) -> PathBuf {
    let folder = file.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
    folder.canonicalize().unwrap_or_else(|_| folder.to_path_buf())
}

/// A file from a folder, with `/` on every system.
fn name_of(folder: &Path, path: &str) -> String {
    let path = Path::new(path);
    let whole = path.canonicalize().unwrap_or_else(|_| path.to_path_buf());
    for (up, above) in folder.ancestors().enumerate() {
        if let Ok(rest) = whole.strip_prefix(above) {
            let parts = rest.components().map(|c| c.as_os_str().to_string_lossy().into_owned());
            return std::iter::repeat_n("..".to_string(), up).chain(parts).collect::<Vec<_>>().join("/");
        }
    }
    path.display().to_string()
}

fn lesson(name: &str, c: &Checked, basis: &Basis, ledger: &Ledger) -> Value {
    let claims = basis.claims.iter().map(|b| claim(b, c.claims.iter().find(|claim| claim.name == b.name)));
    let path = c.lesson.file.path();
    let mut verdicts: Vec<(String, Value)> =
        ledger.entries().iter().filter(|e| e.path == *path).map(|e| verdict(name, path, e)).collect();
    verdicts.sort_by(|a, b| a.0.cmp(&b.0));
    json!({
        "file": name,
        "labs": basis.labs.iter().map(lab).collect::<Vec<_>>(),
        "claims": claims.collect::<Vec<_>>(),
        "verdicts": verdicts.into_iter().map(|(_, value)| value).collect::<Vec<_>>(),
    })
}

fn lab(b: &LabBasis) -> Value {
    json!({
        "lab": b.lab, "block": b.block, "model": b.model, "settings": b.settings.as_ref().map(settings),
    })
}

fn settings(s: &RunSettings) -> Value {
    let mut value = json!({
        "model": s.model, "timestep": null, "integrator": s.integrator, "solver": s.solver, "cone": s.cone,
        "iterations": s.iterations, "tolerance": null, "options": s.options, "contacts": s.contacts,
    });
    set_number(&mut value, "timestep", s.timestep);
    set_number(&mut value, "tolerance", s.tolerance);
    value
}

fn claim(b: &ClaimBasis, judged: Option<&Claim>) -> Value {
    let runs: Vec<Value> =
        b.runs.iter().map(|(name, s)| json!({"name": name, "settings": s.as_ref().map(settings)})).collect();
    let (mut measures, mut quotes) = (Map::new(), Vec::new());
    if let Some(judgement) = judged.map(|c| &c.judgement) {
        let mut sorted: Vec<_> = judgement.measures.iter().collect();
        sorted.sort_by(|a, b| a.name.cmp(&b.name));
        for m in sorted {
            let mut value = json!({"value": null, "halved": null});
            set_number(&mut value, "value", m.value);
            if let Some(halved) = m.halved {
                set_number(&mut value, "halved", halved);
            }
            measures.insert(m.name.clone(), value);
        }
        quotes.extend(judgement.quotes.iter().map(|q| {
            let mut value = json!({"text": q.text, "computed": null});
            set_number(&mut value, "computed", q.computed);
            value
        }));
    }
    json!({
        "name": b.name, "block": b.block, "model": b.model, "runs": runs, "measures": measures, "quotes": quotes,
    })
}

/// What became of a claim, and by what it is sorted.
fn verdict(name: &str, path: &str, e: &Entry) -> (String, Value) {
    // A file is named from the record's folder, as everywhere in it.
    let owner = if e.owner == path { name } else { &e.owner };
    let value = json!({
        "subject": key(e.subject.as_str()), "owner": owner, "what": e.what, "state": key(e.state.as_str()),
        "word": e.word,
    });
    (format!("{owner}\n{}\n{}", e.subject.as_str(), e.what), value)
}
