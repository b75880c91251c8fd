//! The plan of a lab with its costs.

use super::measure::{self, StageCost, StepCost};
use super::parts::{self, EngineOption, PairSummary, SensorRow, TreeAlgorithmUse};
use super::reader::{self, ExtraReader};
use super::start::plan_at_start;
use labspec::bind::Programs;
use labspec::run::{RunError, is_steady};
use labspec::spec::Lab;
use labspec_core::reflect::Stage;
use labspec_core::{AccessSet, Model};

/// A stage.
#[derive(Clone, Debug, PartialEq)]
pub struct StageRow {
    /// Which.
    pub stage: Stage,
    /// Whether it runs in every step.
    pub keep: bool,
    /// Why, or why not.
    pub reason: String,
    /// What it costs; `None` where nothing was run, or it does not run.
    pub cost: Option<StageCost>,
    /// What a step would take longer, ns, if it ran, with all that it uses; `None` where nothing was run, or it runs.
    pub forced: Option<f64>,
}

/// The plan of a lab.
#[derive(Clone, Debug, PartialEq)]
pub struct PlanReport {
    /// What its programs read and write.
    pub access: AccessSet,
    /// The stages, in the order of a step.
    pub rows: Vec<StageRow>,
    /// When the lab's controller runs, where it has one.
    pub controller: Option<&'static str>,
    /// What a step costs; `None` where nothing was run.
    pub step: Option<StepCost>,
    /// The pairs of geoms.
    pub pairs: PairSummary,
    /// The cone of friction.
    pub cone: &'static str,
    /// Methods of the constraint solver, integrators, and algorithms of trees.
    pub solvers: Vec<EngineOption>,
    /// Likewise.
    pub integrators: Vec<EngineOption>,
    /// Likewise.
    pub tree_algorithms: Vec<TreeAlgorithmUse>,
    /// The sensors, one by one.
    pub sensors: Vec<SensorRow>,
    /// What more readers would cost.
    pub readers: Vec<ExtraReader>,
}

/// What is asked of a plan.
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// More readers: fields, sensors, or expressions.
    pub read: Vec<String>,
    /// Runs the lab, to measure.
    pub run: bool,
}

/// The plan of a lab.
///
/// # Errors
/// A reader that is not to be found, or a lab that cannot run.
pub fn plan(
    lab: &Lab,
    model: &Model,
    programs: &Programs,
    options: &Options,
) -> Result<PlanReport, RunError> {
    let access = programs.access;
    let (plan, now) = plan_at_start(lab, model, programs);
    let mut readers = reader::readers(model, programs, &options.read)?;
    let measured = match options.run {
        true => measure::measure(lab, model, programs, &readers)?,
        false => None,
    };
    let rows = plan.decisions().iter().enumerate().map(|(i, d)| StageRow {
        stage: d.stage,
        keep: d.keep,
        reason: d.reason.clone(),
        cost: measured.as_ref().and_then(|m| m.stages.get(i).copied().flatten()),
        forced: measured.as_ref().and_then(|m| m.forced.get(i).copied().flatten()),
    });
    let rows = rows.collect();
    for (i, reader) in readers.iter_mut().enumerate() {
        reader.cost = measured.as_ref().and_then(|m| m.readers.get(i).copied());
    }
    Ok(PlanReport {
        access,
        rows,
        controller: programs.controller.as_ref().map(|bound| match is_steady(&bound.program) {
            true => "the program of the lab runs only when something that it reads or writes changes",
            false => "the program of the lab runs before every step",
        }),
        pairs: parts::pairs(&now, &plan, measured.as_ref().map(|m| m.seen)),
        cone: if now.opt.cone == 0 { "pyramidal" } else { "elliptic" },
        solvers: parts::solvers(&now, &plan),
        integrators: parts::integrators(&now, &access),
        tree_algorithms: parts::tree_algorithms(&now, &plan),
        sensors: parts::sensors(&now, &plan),
        readers,
        step: measured.map(|m| m.step),
    })
}

/// A stage's name in lower case with hyphens.
pub fn name(stage: Stage) -> String {
    let mut name = String::new();
    for c in format!("{stage:?}").chars() {
        if c.is_uppercase() && !name.is_empty() {
            name.push('-');
        }
        name.extend(c.to_lowercase());
    }
    name
}
