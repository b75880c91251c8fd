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

/// A stage of the plan.
#[derive(Clone, Debug, PartialEq)]
pub struct StageRow {
    /// The stage.
    pub stage: Stage,
    /// Whether it runs in every step.
    pub keep: bool,
    /// The reason for or against it.
    pub reason: String,
    /// Its cost; `None` if nothing was measured or it does not run.
    pub cost: Option<StageCost>,
    /// The additional time of a step, ns, if it ran with all stages that it needs; `None` if nothing was measured or it runs.
    pub forced: Option<f64>,
}

/// The plan of a lab.
#[derive(Clone, Debug, PartialEq)]
pub struct PlanReport {
    /// The fields that its programs read and write.
    pub access: AccessSet,
    /// The stages, in the order of a step.
    pub rows: Vec<StageRow>,
    /// When the lab's controller runs, if it has one.
    pub controller: Option<&'static str>,
    /// The cost of a step; `None` if nothing was measured.
    pub step: Option<StepCost>,
    /// The pairs of geoms.
    pub pairs: PairSummary,
    /// The friction cone.
    pub cone: &'static str,
    /// The methods of the constraint solver.
    pub solvers: Vec<EngineOption>,
    /// The integrators.
    pub integrators: Vec<EngineOption>,
    /// The tree algorithms.
    pub tree_algorithms: Vec<TreeAlgorithmUse>,
    /// The sensors, one by one.
    pub sensors: Vec<SensorRow>,
    /// The cost of additional readers.
    pub readers: Vec<ExtraReader>,
}

/// The options of a plan report.
#[derive(Clone, Debug, Default)]
pub struct PlanOptions {
    /// Additional readers: fields, sensors, or expressions.
    pub read: Vec<String>,
    /// Whether the lab is run to measure it.
    pub run: bool,
}

/// The friction cones, by the number of the option.
pub const CONES: [&str; 2] = ["pyramidal", "elliptic"];

/// Makes the plan report of a lab.
///
/// # Errors
/// A reader does not exist, or the lab cannot run.
pub fn plan(
    lab: &Lab,
    model: &Model,
    programs: &Programs,
    options: &PlanOptions,
) -> Result<PlanReport, RunError> {
    let access = programs.access;
    let (plan, current) = plan_at_start(lab, model, programs);
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
        pairs: parts::pairs(&current, &plan, measured.as_ref().map(|m| m.seen)),
        cone: CONES[usize::from(current.opt.cone != 0)],
        solvers: parts::solvers(&current, &plan),
        integrators: parts::integrators(&current, &access),
        tree_algorithms: parts::tree_algorithms(&current, &plan),
        sensors: parts::sensors(&current, &plan),
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
