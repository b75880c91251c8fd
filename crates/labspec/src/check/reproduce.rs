//! The basis of a check: models, settings and contacts of every lab and every run. With it a check can be reproduced, and a
//! changed result can be attributed to its cause.

use super::PreparedLab;
use super::claims::{self, Owner};
use super::resolved_labs::start_runs;
use crate::bind::parts::Hash;
use crate::bind::scene::Models;
use crate::run::Integrator;
use crate::run::{Budget, Session, Start};
use crate::spec::Lesson;
use crate::verify::RunCache;
use labspec_core::reflect::{self, FieldId, Object, model};
use labspec_core::{self as core, AccessSet, Data, Model, Obj, Plan, solver};
use std::collections::BTreeMap;
use std::ops::Range;

/// The settings of a run at its start.
#[derive(Clone, Debug, PartialEq)]
pub struct RunSettings {
    /// The digest of the model, including changes by the controls and the setup of the run.
    pub model: String,
    /// Its name in MJCF.
    pub integrator: &'static str,
    /// Its name in MJCF.
    pub solver: &'static str,
    /// Its name in MJCF.
    pub cone: &'static str,
    /// `opt.timestep`, s.
    pub timestep: f64,
    /// `opt.iterations`.
    pub iterations: i32,
    /// `opt.tolerance`.
    pub tolerance: f64,
    /// All other options that differ from MuJoCo's default, by name.
    pub options: BTreeMap<&'static str, Vec<f64>>,
    /// Parameters of contacts that differ from MuJoCo's default, by geom and parameter.
    pub contacts: BTreeMap<String, BTreeMap<&'static str, Vec<f64>>>,
}

/// The basis of a lab.
#[derive(Clone, Debug, PartialEq)]
pub struct LabBasis {
    /// Its address: `#1`.
    pub lab: String,
    /// The digest of its text in the lesson.
    pub block: String,
    /// The digest of its compiled model; `None` where it cannot run.
    pub model: Option<String>,
    /// Its settings as loaded; `None` where it cannot run.
    pub settings: Option<RunSettings>,
}

/// A question or a lab with claims.
#[derive(Clone, Debug, PartialEq)]
pub struct ClaimBasis {
    /// The owner of the claims: `quiz fall, question 2`.
    pub name: String,
    /// The digest of its text in the lesson: the question, or the lab.
    pub block: String,
    /// The digest of the compiled model of its lab; `None` where that cannot run.
    pub model: Option<String>,
    /// The runs by name; `None` for one that cannot be started.
    pub runs: Vec<(String, Option<RunSettings>)>,
}

/// The basis of the check of a lesson.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Basis {
    /// Its labs.
    pub labs: Vec<LabBasis>,
    /// All owners of a `verify` object.
    pub claims: Vec<ClaimBasis>,
}

/// Determines the basis of a check of the lesson: compiles models and sets up runs, without executing them. `hash` computes
/// digests.
pub fn basis(lesson: &Lesson, models: &Models, hash: Hash) -> Basis {
    let ready = super::of_claims(lesson, models);
    let block = |span: &Range<usize>| hash(&[lesson.file.slice(span.clone()).as_bytes()]);
    let compiled = |ready: &PreparedLab<'_>| hash(&[&ready.model.to_bytes()]);
    let labs = lesson.addressed().into_iter().map(|(address, lab)| {
        let one = ready.iter().find(|r| std::ptr::eq(r.lab, lab));
        let settings = one.map(|r| {
            let start = Start { budget: Budget::TRIAL, ..Start::of_lab(lab) };
            let session = Session::start(&r.programs, &r.model, start);
            settings(&session.world.model, hash)
        });
        LabBasis { lab: address.to_string(), block: block(&lab.span), model: one.map(compiled), settings }
    });
    let labs = labs.collect();
    let stage = RunCache::new(models, lesson.conventions.languages);
    let claims = claims::owners(lesson).into_iter().filter_map(|(name, owner)| {
        let (verify, written, _) = owner.claim(lesson)?;
        let span = match &owner {
            Owner::Lab(lab) => &lab.span,
            Owner::Question(question) => &question.span,
            Owner::ClaimComment(comment) => &comment.span,
        };
        let started = start_runs(lesson, &ready, verify, written, &stage);
        let model = started.as_ref().and_then(|b| b.model.as_ref()).map(|m| hash(&[&m.to_bytes()]));
        let runs = started.map_or(Vec::new(), |started| started.runs);
        let runs = runs.into_iter().map(|(name, model)| (name, model.map(|m| settings(&m, hash)))).collect();
        Some(ClaimBasis { name, block: block(span), model, runs })
    });
    let claims = claims.collect();
    Basis { labs, claims }
}

fn settings(model: &Model, hash: Hash) -> RunSettings {
    let opt = &model.opt;
    RunSettings {
        model: hash(&[&model.to_bytes()]),
        integrator: Integrator::of_model(model).name,
        solver: match opt.solver {
            solver::PGS => "PGS",
            solver::CG => "CG",
            _ => "Newton",
        },
        cone: if opt.cone == 0 { "pyramidal" } else { "elliptic" },
        timestep: opt.timestep,
        iterations: opt.iterations,
        tolerance: opt.tolerance,
        options: options(model),
        contacts: contacts(model),
    }
}

/// Options that have a separate key, or affect no number.
const SEPARATE_OPTIONS: [&str; 7] =
    ["timestep", "integrator", "solver", "cone", "iterations", "tolerance", "jacobian"];

fn options(model: &Model) -> BTreeMap<&'static str, Vec<f64>> {
    let Some(plain) = Model::from_xml("<mujoco/>").ok() else { return BTreeMap::new() };
    let fields = || reflect::fields().filter(|f| f.info().object == Object::Option);
    let [written, plain] = [model, &plain].map(|m| numbers(m, fields()));
    let is_reported = |name: &&'static str| SEPARATE_OPTIONS.contains(name);
    written
        .into_iter()
        .zip(plain)
        .filter(|((name, current), (_, default))| current != default && !is_reported(name))
        .map(|(written, _)| written)
        .collect()
}

/// Parameters of contacts of a geom, with MuJoCo's defaults.
const CONTACT: [(&str, FieldId, &[f64]); 6] = [
    ("condim", model::geom_condim, &[3.0]),
    ("friction", model::geom_friction, &[1.0, 0.005, 0.0001]),
    ("gap", model::geom_gap, &[0.0]),
    ("margin", model::geom_margin, &[0.0]),
    ("solimp", model::geom_solimp, &[0.9, 0.95, 0.001, 0.5, 2.0]),
    ("solref", model::geom_solref, &[0.02, 1.0]),
];

fn contacts(model: &Model) -> BTreeMap<String, BTreeMap<&'static str, Vec<f64>>> {
    let names = model.names.of_kind(Obj::Geom);
    let mut all: BTreeMap<String, BTreeMap<&'static str, Vec<f64>>> = BTreeMap::new();
    let fields = CONTACT.iter().map(|(_, field, _)| *field);
    for ((key, _, default), (_, values)) in CONTACT.into_iter().zip(numbers(model, fields)) {
        for (geom, written) in
            values.chunks(default.len()).enumerate().filter(|(_, written)| *written != default)
        {
            let name = names.get(geom).filter(|name| !name.is_empty());
            let name = name.cloned().unwrap_or_else(|| format!("geom {geom}"));
            all.entry(name).or_default().insert(key, written.to_vec());
        }
    }
    all
}

/// The values of some fields of a model, with the names of the fields.
fn numbers(model: &Model, fields: impl Iterator<Item = FieldId>) -> Vec<(&'static str, Vec<f64>)> {
    let data = Data::planned(model, Plan::new(model, &AccessSet::OBSERVE));
    let describe_field = |f: FieldId| {
        let view = core::view(model, &data, f).ok();
        view.map_or(Vec::new(), |view| (0..view.len()).filter_map(|i| view.get(i)).collect())
    };
    fields.map(|f| (f.info().name, describe_field(f))).collect()
}
