//! `labspec check --record FILE` writes every verdict with its basis, and `--since FILE` reports the changes since then.
//!
//! File names are relative to the folder of the record, so that a record is the same on every machine.

use super::common::Failure;
use super::course::CourseResults;
use super::output_kind::OutputKind;
use super::report_json::{MeasureRow, NonFinite, StoredReport, finite, nonfinite, read_report, write_report};
use super::schema_words::{AnyNumber, WordOf};
use labspec::check::{Basis, Checked, Claim, ClaimBasis, LabBasis, RunSettings};
use labspec::ledger::{Entry, Ledger, State};
use labspec::report::key;
use labspec::verify::Quote;
use schemars::JsonSchema;
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

/// Every verdict of a check with everything needed to reproduce it: versions, the settings of every run, digests (SHA-256) of
/// models and texts.
#[derive(Debug, Serialize, Deserialize, JsonSchema)]
pub(super) struct ReproductionRecord {
    /// The version of labspec.
    pub(super) labspec: String,
    /// The version of the lesson format.
    pub(super) format: String,
    /// The simulator whose semantics the engine implements, with its version.
    pub(super) engine: String,
    /// All lessons, in the order of their names.
    pub(super) lessons: Vec<LessonRecord>,
}

/// A lesson.
#[derive(Debug, Serialize, Deserialize, JsonSchema)]
pub(super) struct LessonRecord {
    /// Its path from the folder of this file, with `/`.
    pub(super) file: String,
    /// Its labs, in order.
    pub(super) labs: Vec<LabRecord>,
    /// Questions and labs with a `verify` object, in order.
    pub(super) claims: Vec<ClaimRecord>,
    /// The verdict of every claim: the ledger without places, sorted by owner, subject and what is claimed.
    pub(super) verdicts: Vec<VerdictRecord>,
}

/// A lab as it is in the lesson.
#[derive(Debug, Serialize, Deserialize, JsonSchema)]
pub(super) struct LabRecord {
    /// Its address: `#1`.
    pub(super) lab: String,
    /// The digest of its text.
    pub(super) block: String,
    /// The digest of its compiled model; null if it cannot run.
    #[schemars(required)]
    pub(super) model: Option<String>,
    /// The settings at its start; null if it cannot run.
    #[schemars(required)]
    pub(super) settings: Option<SettingsRecord>,
}

/// Numbers by name; `None` for a number that JSON cannot represent.
type Numbers = BTreeMap<String, Vec<Option<f64>>>;

/// The settings of a run at its start.
#[derive(Debug, Serialize, Deserialize, JsonSchema)]
pub(super) struct SettingsRecord {
    /// The digest of the model after the changes by the controls and the setup of the run.
    pub(super) model: String,
    /// The length of a step in s.
    #[schemars(with = "AnyNumber")]
    pub(super) timestep: Option<f64>,
    /// The integrator, as MJCF names it.
    pub(super) integrator: String,
    /// The solver, as MJCF names it.
    pub(super) solver: String,
    /// The friction cone, as MJCF names it.
    pub(super) cone: String,
    /// The maximum number of iterations of the solver.
    pub(super) iterations: i32,
    /// The tolerance at which the solver stops.
    #[schemars(with = "AnyNumber")]
    pub(super) tolerance: Option<f64>,
    /// All other options that differ from MuJoCo's defaults, by name.
    pub(super) options: Numbers,
    /// By geom: the parameters of its contacts that differ from MuJoCo's defaults.
    pub(super) contacts: BTreeMap<String, Numbers>,
    #[serde(default, skip_serializing_if = "NonFinite::is_empty")]
    nonfinite: NonFinite,
}

/// A question, or a lab with a `verify` object.
#[derive(Debug, Serialize, Deserialize, JsonSchema)]
pub(super) struct ClaimRecord {
    /// What makes the claim: `quiz fall, question 2`.
    pub(super) name: String,
    /// The digest of its text.
    pub(super) block: String,
    /// The digest of the compiled model of the lab that it is about; null if that cannot run.
    #[schemars(required)]
    pub(super) model: Option<String>,
    /// Its runs, in order.
    pub(super) runs: Vec<RunRecord>,
    /// Every measure by name, as in the report `check`.
    pub(super) measures: BTreeMap<String, MeasureRow>,
    /// Every quoted number, in order.
    pub(super) quotes: Vec<QuoteRecord>,
}

/// A run.
#[derive(Debug, Serialize, Deserialize, JsonSchema)]
pub(super) struct RunRecord {
    /// Its name.
    pub(super) name: String,
    /// Its settings at the start; null if it cannot be made.
    #[schemars(required)]
    pub(super) settings: Option<SettingsRecord>,
}

/// A quoted number.
#[derive(Debug, Serialize, Deserialize, JsonSchema)]
pub(super) struct QuoteRecord {
    /// The text that quotes it.
    pub(super) text: String,
    /// The computed value in the unit of the text.
    #[schemars(with = "AnyNumber")]
    pub(super) computed: Option<f64>,
    #[serde(default, skip_serializing_if = "NonFinite::is_empty")]
    pub(super) nonfinite: NonFinite,
}

/// The verdict of a claim.
#[derive(Debug, Serialize, Deserialize, JsonSchema)]
pub(super) struct VerdictRecord {
    /// What it is about, as in the ledger.
    pub(super) subject: String,
    /// Who makes the claim.
    pub(super) owner: String,
    /// What is claimed, if the owner makes several claims; else empty.
    pub(super) what: String,
    /// The verdict.
    #[schemars(with = "WordOf<State>")]
    state: String,
    /// The verdict as people read it.
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
