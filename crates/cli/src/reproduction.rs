//! `labspec check --record FILE` writes every verdict with its basis, and `--since FILE` reports the changes since then.
//!
//! File names are relative to the folder of the record, so that a record is the same on every machine.

use super::common::Failure;
use super::course::CourseResults;
use super::output_kind::OutputKind;
use super::report_json::{MeasureRow, NonFinite, StoredReport, finite, nonfinite, read_report, write_report};
use labspec::check::{Basis, Checked, Claim, ClaimBasis, LabBasis, RunSettings};
use labspec::ledger::{Entry, Ledger};
use labspec::report::key;
use labspec::verify::Quote;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// The simulator whose semantics the engine implements.
const ENGINE: &str = "MuJoCo 3.14.0";
/// The version of the lesson format.
const FORMAT: &str = "0.1";

const STORED: StoredReport = StoredReport {
    name: "reproduction",
    what: "a record of a check",
    next_step: "labspec check --record writes one",
    output: OutputKind::Record,
};

/// The results of a check, and their basis.
#[derive(Debug, Serialize, Deserialize)]
pub(super) struct ReproductionRecord {
    pub(super) labspec: String,
    pub(super) format: String,
    pub(super) engine: String,
    pub(super) lessons: Vec<LessonRecord>,
}

#[derive(Debug, Serialize, Deserialize)]
pub(super) struct LessonRecord {
    pub(super) file: String,
    pub(super) labs: Vec<LabRecord>,
    pub(super) claims: Vec<ClaimRecord>,
    pub(super) verdicts: Vec<VerdictRecord>,
}

/// A lab: digests of its text and of its model, and its settings, which are `None` if it cannot run.
#[derive(Debug, Serialize, Deserialize)]
pub(super) struct LabRecord {
    pub(super) lab: String,
    pub(super) block: String,
    pub(super) model: Option<String>,
    pub(super) settings: Option<SettingsRecord>,
}

/// Numbers by name; `None` for a number that JSON cannot represent.
type Numbers = BTreeMap<String, Vec<Option<f64>>>;

/// The settings of a run at its start; the timestep is in s.
#[derive(Debug, Serialize, Deserialize)]
pub(super) struct SettingsRecord {
    pub(super) model: String,
    pub(super) timestep: Option<f64>,
    pub(super) integrator: String,
    pub(super) solver: String,
    pub(super) cone: String,
    pub(super) iterations: i32,
    pub(super) tolerance: Option<f64>,
    /// Options that differ from MuJoCo's defaults.
    pub(super) options: Numbers,
    /// Contact parameters that differ from the defaults, by geom.
    pub(super) contacts: BTreeMap<String, Numbers>,
    #[serde(default, skip_serializing_if = "NonFinite::is_empty")]
    nonfinite: NonFinite,
}

/// A question, or a lab with claims, with digests as in [`LabRecord`].
#[derive(Debug, Serialize, Deserialize)]
pub(super) struct ClaimRecord {
    pub(super) name: String,
    pub(super) block: String,
    pub(super) model: Option<String>,
    pub(super) runs: Vec<RunRecord>,
    pub(super) measures: BTreeMap<String, MeasureRow>,
    pub(super) quotes: Vec<QuoteRecord>,
}

#[derive(Debug, Serialize, Deserialize)]
pub(super) struct RunRecord {
    pub(super) name: String,
    pub(super) settings: Option<SettingsRecord>,
}

/// The quoted text, and the computed value in its unit.
#[derive(Debug, Serialize, Deserialize)]
pub(super) struct QuoteRecord {
    pub(super) text: String,
    pub(super) computed: Option<f64>,
    #[serde(default, skip_serializing_if = "NonFinite::is_empty")]
    pub(super) nonfinite: NonFinite,
}

#[derive(Debug, Serialize, Deserialize)]
pub(super) struct VerdictRecord {
    pub(super) subject: String,
    pub(super) owner: String,
    pub(super) what: String,
    state: String,
    pub(super) word: String,
}

/// The record of the current check, as it would be written to this file.
pub(super) fn current(file: &Path, results: &CourseResults) -> ReproductionRecord {
    let folder = folder_of(file);
    let both = results.checked.iter().zip(&results.bases);
    let mut lessons: Vec<LessonRecord> = both
        .map(|(c, basis)| lesson(name_of(&folder, c.lesson.file.path()), c, basis, &results.ledger))
        .collect();
    lessons.sort_by(|a, b| a.file.cmp(&b.file));
    ReproductionRecord {
        labspec: env!("CARGO_PKG_VERSION").into(),
        format: FORMAT.into(),
        engine: ENGINE.into(),
        lessons,
    }
}

/// Writes a record.
///
/// # Errors
/// The file cannot be written.
pub(super) fn write(file: &Path, record: &ReproductionRecord) -> Result<(), Failure> {
    write_report(file, &STORED, record)
}

/// Reads a record.
///
/// # Errors
/// The file cannot be read, or is not a record.
pub(super) fn read(file: &Path) -> Result<ReproductionRecord, Failure> {
    read_report(file, &STORED)
}

fn folder_of(file: &Path) -> PathBuf {
    let folder = file.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
    folder.canonicalize().unwrap_or_else(|_| folder.to_path_buf())
}

/// A file name relative to a folder, with `/` on every system.
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

fn lesson(file: String, c: &Checked, basis: &Basis, ledger: &Ledger) -> LessonRecord {
    let claims = basis.claims.iter().map(|b| claim(b, c.claims.iter().find(|claim| claim.name == b.name)));
    let path = c.lesson.file.path();
    let mut entries: Vec<(String, VerdictRecord)> =
        ledger.entries().iter().filter(|e| e.path == *path).map(|e| verdict(&file, path, e)).collect();
    entries.sort_by(|a, b| a.0.cmp(&b.0));
    let verdicts = entries.into_iter().map(|(_, verdict)| verdict).collect();
    LessonRecord { labs: basis.labs.iter().map(lab).collect(), claims: claims.collect(), verdicts, file }
}

fn lab(b: &LabBasis) -> LabRecord {
    let settings = b.settings.as_ref().map(settings);
    LabRecord { lab: b.lab.clone(), block: b.block.clone(), model: b.model.clone(), settings }
}

fn settings(s: &RunSettings) -> SettingsRecord {
    let numbers = |all: &BTreeMap<&str, Vec<f64>>| -> Numbers {
        all.iter()
            .map(|(name, list)| (name.to_string(), list.iter().copied().map(finite).collect()))
            .collect()
    };
    SettingsRecord {
        model: s.model.clone(),
        timestep: finite(s.timestep),
        integrator: s.integrator.into(),
        solver: s.solver.into(),
        cone: s.cone.into(),
        iterations: s.iterations,
        tolerance: finite(s.tolerance),
        options: numbers(&s.options),
        contacts: s.contacts.iter().map(|(geom, values)| (geom.clone(), numbers(values))).collect(),
        nonfinite: nonfinite(&[("timestep", &s.timestep), ("tolerance", &s.tolerance)]),
    }
}

fn claim(b: &ClaimBasis, judged: Option<&Claim>) -> ClaimRecord {
    let run = |(name, s): &(String, Option<RunSettings>)| RunRecord {
        name: name.clone(),
        settings: s.as_ref().map(settings),
    };
    let quote = |q: &Quote| QuoteRecord {
        text: q.text.clone(),
        computed: finite(q.computed),
        nonfinite: nonfinite(&[("computed", &q.computed)]),
    };
    let judgement = judged.map(|c| &c.judgement);
    let measures = judgement.iter().flat_map(|j| &j.measures);
    ClaimRecord {
        name: b.name.clone(),
        block: b.block.clone(),
        model: b.model.clone(),
        runs: b.runs.iter().map(run).collect(),
        measures: measures.map(|m| (m.name.clone(), MeasureRow::new(m))).collect(),
        quotes: judgement.iter().flat_map(|j| &j.quotes).map(quote).collect(),
    }
}

/// The verdict of a claim, and the key by which verdicts are sorted.
fn verdict(name: &str, path: &str, e: &Entry) -> (String, VerdictRecord) {
    // The owner is named relative to the record's folder if it is a file.
    let owner = if e.owner == path { name } else { &e.owner };
    let verdict = VerdictRecord {
        subject: key(e.subject.as_str()),
        owner: owner.into(),
        what: e.what.clone(),
        state: key(e.state.as_str()),
        word: e.word.into(),
    };
    (format!("{owner}\n{}\n{}", e.subject.as_str(), e.what), verdict)
}
