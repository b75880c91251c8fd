//! What a check rested on: models, settings and contacts of every lab and every run, so that it can be made again and that a
//! change can be distinguished from its cause.

use super::PreparedLab;
use super::claims::{self, Owner};
use super::resolved_labs::start_runs;
use crate::bind::parts::Hash;
use crate::bind::scene::Models;
use crate::run::Integrator;
use crate::run::{Budget, Session, Start};
use crate::spec::Lesson;
use crate::verify::Stage;
use labspec_core::reflect::{self, FieldId, Object, model};
use labspec_core::{self as core, AccessSet, Data, Model, Obj, Plan, solver};
use std::collections::BTreeMap;
use std::ops::Range;

/// The settings of a run, as it begins.
#[derive(Clone, Debug, PartialEq)]
pub struct RunSettings {
    /// The digest of the model, with what the run's controls and setup have changed in it.
    pub model: String,
    /// By name, as MJCF writes it.
    pub integrator: &'static str,
    /// By name, as MJCF writes it.
    pub solver: &'static str,
    /// By name, as MJCF writes it.
    pub cone: &'static str,
    /// `opt.timestep`, s.
    pub timestep: f64,
    /// `opt.iterations`.
    pub iterations: i32,
    /// `opt.tolerance`.
    pub tolerance: f64,
    /// All other options that are not MuJoCo's default, by name.
    pub options: BTreeMap<&'static str, Vec<f64>>,
    /// Parameters of contacts that are not MuJoCo's default: by geom, then by parameter.
    pub contacts: BTreeMap<String, BTreeMap<&'static str, Vec<f64>>>,
}

/// A lab, as it stands.
#[derive(Clone, Debug, PartialEq)]
pub struct LabBasis {
    /// Its address: `#1`.
    pub lab: String,
    /// The digest of its text in the lesson.
    pub block: String,
    /// The digest of its compiled model; `None` where it cannot run.
    pub model: Option<String>,
    /// As it stands; `None` where it cannot run.
    pub settings: Option<RunSettings>,
}

/// A question or a lab with claims.
#[derive(Clone, Debug, PartialEq)]
pub struct ClaimBasis {
    /// What claims it: `quiz fall, question 2`.
    pub name: String,
    /// The digest of its text in the lesson: the question, or the lab.
    pub block: String,
    /// The digest of the compiled model of the lab that it is about; `None` where that cannot run.
    pub model: Option<String>,
    /// The runs by name; `None` for one that cannot be made.
    pub runs: Vec<(String, Option<RunSettings>)>,
}

/// What the check of a lesson rested on.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Basis {
    /// Its labs.
    pub labs: Vec<LabBasis>,
    /// Everybody who claims something by a `verify` object.
    pub claims: Vec<ClaimBasis>,
}

/// Finds what a check of the lesson rests on: models are compiled and runs are set up, and nothing is run. `hash` makes digests.
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
    let stage = Stage::new(models);
    let claims = claims::owners(lesson).into_iter().filter_map(|(name, owner)| {
        let (verify, written, _) = owner.claim(lesson)?;
        let span = match &owner {
            Owner::Lab(lab) => &lab.span,
            Owner::Question(question) => &question.span,
            Owner::Remark(remark) => &remark.span,
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

/// Options that have a key of their own, or change no number.
const TOLD: [&str; 7] = ["timestep", "integrator", "solver", "cone", "iterations", "tolerance", "jacobian"];

fn options(model: &Model) -> BTreeMap<&'static str, Vec<f64>> {
    let Some(plain) = Model::from_xml("<mujoco/>").ok() else { return BTreeMap::new() };
    let fields = || reflect::fields().filter(|f| f.info().object == Object::Option);
    let [written, plain] = [model, &plain].map(|m| numbers(m, fields()));
    let is_reported = |name: &&'static str| TOLD.contains(name);
    written
        .into_iter()
        .zip(plain)
        .filter(|((name, now), (_, default))| now != default && !is_reported(name))
        .map(|(written, _)| written)
        .collect()
}

/// Parameters of a geom's contacts, with MuJoCo's defaults.
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

/// The numbers of some fields of a model, with the names of the fields.
fn numbers(model: &Model, fields: impl Iterator<Item = FieldId>) -> Vec<(&'static str, Vec<f64>)> {
    let data = Data::planned(model, Plan::new(model, &AccessSet::OBSERVE));
    let of = |f: FieldId| {
        let view = core::view(model, &data, f).ok();
        view.map_or(Vec::new(), |view| (0..view.len()).filter_map(|i| view.get(i)).collect())
    };
    fields.map(|f| (f.info().name, of(f))).collect()
}
