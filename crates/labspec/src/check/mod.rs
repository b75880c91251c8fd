//! The whole check of a lesson: structure, names, runs of every lab, verdicts of every question.

mod allowed;
pub(crate) mod choices;
mod claim_id;
mod claims;
mod curves;
mod entries;
mod expect;
mod judge;
pub(crate) mod lab_runs;
pub(crate) mod observations;
mod partners;
mod prepared_lab;
pub(crate) mod programs;
mod reproduce;
mod resolved_labs;
pub(crate) mod setconst;
mod snapshot;
mod stored;
mod units;

pub use allowed::Allowed;
pub use claim_id::is_about;
pub use claims::Claim;
pub use curves::{Drawn, curves};
pub use entries::{evidence, ledger};
pub use judge::{CrossCheck, Recording, Request, file_name, hear};
pub use lab_runs::Tried;
pub use reproduce::{Basis, ClaimBasis, LabBasis, RunSettings, basis};
pub use snapshot::{Divergence, Renewal, RenewedLab, SnapshotResult, renew};
pub use units::labels as labels_of;

pub(crate) use prepared_lab::PreparedLab;

use crate::bind::Programs;
use crate::bind::scene::Models;
use crate::finding::{self, Finding, InFile, Severity};
use crate::rules;
use crate::source::{SourceMap, Text};
use crate::spec::{Lab, LabAddress, Lesson, ModelSource};
use labspec_core::Model;
use serde::{Deserialize, Serialize};
use std::sync::{Arc, LazyLock};

/// A lab that was run, for the report.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct RanLab {
    /// Its address in the lesson.
    pub address: LabAddress,
    /// Its title, possibly empty.
    pub title: String,
    /// Number of runs that were made: as it stands, and with each control moved to its ends.
    pub runs: usize,
    /// `false` when it could not be run.
    pub ran: bool,
    /// What its runs covered; `None` when it could not be run.
    pub tried: Option<Tried>,
    /// Mistakes in its code: what these texts would do was not run.
    pub mistakes: usize,
    /// The lesson says that it breaks.
    pub expected: bool,
}

/// A lesson with everything that is known about it.
#[derive(Debug)]
pub struct Checked {
    /// The lesson.
    pub lesson: Lesson,
    /// Everything that is wrong, in order.
    pub findings: Vec<Finding>,
    /// The labs.
    pub labs: Vec<RanLab>,
    /// The questions and the labs with claims.
    pub claims: Vec<Claim>,
    /// Of each lab, whether it shows what is stored; nothing where nothing is.
    pub snapshots: Vec<SnapshotResult>,
    /// What would be found, and the author has suppressed with a reason.
    pub allowed: Vec<Allowed>,
    /// What was asked for.
    pub level: CheckLevel,
}

/// What a check does beyond structure, models and the names in every text.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CheckLevel {
    /// Try what programs do that a page lets pass in silence.
    pub programs: bool,
    /// Run every lab.
    pub labs: bool,
    /// Verify every claim.
    pub claims: bool,
}

impl CheckLevel {
    /// Everything.
    pub const FULL: CheckLevel = CheckLevel { programs: true, labs: true, claims: true };
    /// The claims alone.
    pub const CLAIMS: CheckLevel = CheckLevel { labs: false, ..CheckLevel::FULL };
    /// Nothing is run: labs and claims stand in the ledger as left out.
    pub const STATIC: CheckLevel = CheckLevel { programs: false, labs: false, claims: false };
}

/// What a check found beyond the structure of a lesson, not yet tied to its file.
#[derive(Debug, Default, Serialize, Deserialize)]
pub struct LabOutcome {
    /// What is wrong.
    #[serde(with = "stored")]
    pub findings: Vec<Finding>,
    /// The labs that ran.
    pub labs: Vec<RanLab>,
    /// What is claimed, and what became of it.
    pub claims: Vec<Claim>,
    pub(crate) snapshots: Vec<SnapshotResult>,
}

impl LabOutcome {
    /// These findings, and nothing else.
    pub fn from_findings(findings: Vec<Finding>) -> LabOutcome {
        LabOutcome { findings, ..LabOutcome::default() }
    }

    /// One finding, and nothing else.
    pub fn from_finding(finding: Finding) -> LabOutcome {
        LabOutcome { findings: vec![finding], ..LabOutcome::default() }
    }
}

/// Checks a lesson that has been read. Findings of model files are left in `models`.
pub fn check_lesson(lesson: Lesson, models: &Models, level: CheckLevel) -> Checked {
    let found = run_checks(&lesson, models, level);
    join(lesson, found, level)
}

/// Binds, runs and verifies.
pub fn run_checks(lesson: &Lesson, models: &Models, level: CheckLevel) -> LabOutcome {
    let mut findings = Vec::new();
    let labs = lesson.all_labs();
    let mut ready: Vec<PreparedLab<'_>> =
        labs.into_iter().filter_map(|lab| prepare(lab, models, level, &mut findings)).collect();
    if level.programs {
        ready.iter().for_each(|r| rules::param_unread::check_params(lesson, r, &mut findings));
        ready.iter().for_each(|r| rules::contact_time_late::check_contact_times(r, &mut findings));
    }
    let labs = if level.labs { lab_runs::run_labs(lesson, &ready, &mut findings) } else { Vec::new() };
    deduplicate(lesson, &mut findings);
    let snapshots = snapshot::check_snapshots(lesson, &ready, level, &mut findings);
    // An editor looks at a block at a time, and cannot know what the others claim.
    if level.claims {
        rules::numbers_unclaimed::check_left_out(lesson, &mut findings);
    }
    ready.extend(beside(lesson, models));
    let claims = if level.claims {
        claims::check_claims(lesson, &mut ready, models, &mut findings)
    } else {
        claims::bind(lesson, &ready, models, &mut findings);
        Vec::new()
    };
    LabOutcome { findings, labs, claims, snapshots }
}

/// All labs that claims of a lesson are about. What is wrong with them has been reported.
fn of_claims<'l>(lesson: &'l Lesson, models: &Models) -> Vec<PreparedLab<'l>> {
    let labs = lesson.all_labs().into_iter();
    let prepared = labs.filter_map(|lab| prepare(lab, models, CheckLevel::STATIC, &mut Vec::new()));
    prepared.chain(beside(lesson, models)).collect()
}

/// The labs of claims that are none of the lesson's own: those of other lessons, and one in which nothing is, for formulas.
fn beside<'l>(lesson: &'l Lesson, models: &Models) -> impl Iterator<Item = PreparedLab<'l>> {
    let labs = lesson.others.iter().filter_map(|other| other.lab.as_ref().ok());
    let others = labs.filter_map(|lab| {
        // What is wrong with it is reported at its own place.
        let (model, programs, mistakes) = bind(lab, models, &mut Vec::new())?;
        (mistakes == 0).then_some(PreparedLab { lab, model, programs, mistakes })
    });
    others.chain(if claims::have_formulas(lesson) { empty() } else { None })
}

/// A lab in which nothing is.
static NOTHING: LazyLock<Lab> =
    LazyLock::new(|| Lab::of_model(Text { value: String::new(), map: SourceMap::point(0) }));

fn empty() -> Option<PreparedLab<'static>> {
    let model = Arc::new(Model::from_xml("<mujoco/>").ok()?);
    let programs = Programs::compile(&NOTHING, &model, &mut Vec::new());
    Some(PreparedLab { lab: &NOTHING, model, programs, mistakes: 0 })
}

/// A control of which a reset takes everything away changes nothing, and the reset is reported.
fn deduplicate(lesson: &Lesson, findings: &mut Vec<Finding>) {
    let of = |code: &str, f: &Finding| f.code == code;
    let lost = |span: &std::ops::Range<usize>, findings: &[Finding]| {
        let inside = |f: &Finding| span.start <= f.span.start && f.span.end <= span.end;
        findings.iter().any(|f| of(rules::LOST_AT_RESET.code, f) && inside(f))
    };
    let labs = lesson.all_labs();
    let controls = labs.iter().flat_map(|lab| &lab.controls).map(|c| c.span.clone());
    let spans: Vec<_> = controls.filter(|span| lost(span, findings)).collect();
    findings.retain(|f| {
        !of(rules::IDLE_CONTROL.code, f) || !spans.iter().any(|span| span.contains(&f.span.start))
    });
}

/// A lesson together with what was found.
pub fn join(lesson: Lesson, found: LabOutcome, level: CheckLevel) -> Checked {
    let LabOutcome { mut findings, labs, claims, snapshots } = found;
    let mut all = lesson.findings.clone();
    crate::lint::withhold_fixes(&lesson, &mut findings);
    all.extend(findings);
    let mut allowed = allowed::suppress_allowed(&lesson, &mut all, level);
    let mut all: Vec<Finding> = all.into_iter().map(|f| f.at(&lesson.file)).collect();
    for suppressed in &mut allowed {
        suppressed.finding = suppressed.finding.clone().at(&lesson.file);
    }
    finding::sort(&mut all);
    Checked { lesson, findings: all, labs, claims, snapshots, allowed, level }
}

/// Loads the model of a lab and binds its programs, and looks at what they do.
fn prepare<'l>(
    lab: &'l Lab,
    models: &Models,
    level: CheckLevel,
    findings: &mut Vec<Finding>,
) -> Option<PreparedLab<'l>> {
    let (model, programs, mistakes) = bind(lab, models, findings)?;
    if level.programs {
        setconst::check_setconst(lab, &model, &programs, findings);
        rules::lost_at_reset::check_resets(lab, &model, &programs, findings);
        units::check_units(lab, &model, &programs, findings);
        rules::label_names_another::check_names(lab, &model, &programs, findings);
    }
    Some(PreparedLab { lab, model, programs, mistakes })
}

/// Loads the model of a lab and binds its programs; with the number of errors in its code.
pub fn bind(
    lab: &Lab,
    models: &Models,
    findings: &mut Vec<Finding>,
) -> Option<(Arc<Model>, Programs, usize)> {
    let Some(model) = models.model_of_lab(lab, findings) else {
        // A folder that has no such model is a matter of the lesson's structure, which knows what the folder has.
        if let (Some(ModelSource::Model(name)), None) = (lab.scene(), models.folder().names()) {
            findings.extend(rules::no_model_folder::check_folder(name, models.folder()));
            findings.extend(rules::unknown_model::check_unlisted(name, models.folder()));
        }
        return None;
    };
    rules::check_model(lab, &model, findings);
    let before = findings.len();
    let programs = Programs::compile_with(lab, &model, models.functions(), findings);
    let mistakes = findings.iter().skip(before).filter(|f| f.severity == Severity::Error).count();
    Some((model, programs, mistakes))
}
