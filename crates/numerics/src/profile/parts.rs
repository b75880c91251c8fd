//! The parts of the engine that a lab uses in addition to its stages: pairs of geoms, the solver, the
//! integrator, tree algorithms.

use labspec::run::INTEGRATORS;
use labspec_core::reflect::{Stage, data, option};
use labspec_core::{self as core, AccessSet, Model, PairFilterReason, Plan, geom, solver};
use schemars::JsonSchema;
use serde::Serialize;

/// An algorithm of which a lab uses one or none.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, JsonSchema)]
pub struct EngineOption {
    /// Its name.
    pub name: &'static str,
    /// It is used.
    pub keep: bool,
    /// Why, or why not.
    pub reason: String,
}

/// The consequence if a program writes an option.
const WHEN_WRITTEN: &str = "a program that changes it triggers a new plan";

/// A tree algorithm, and the number of trees that use it: for kinematics, for inertia and bias forces, and for accelerations.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TreeAlgorithmUse {
    /// Its name.
    pub name: &'static str,
    /// The numbers of trees.
    pub trees: [usize; 3],
}

/// A sensor.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, JsonSchema)]
pub struct SensorRow {
    /// Its name; its number where it has none.
    pub name: String,
    /// Its values are computed.
    pub keep: bool,
    /// Why, or why not.
    pub reason: &'static str,
}

/// Counts of the steps that were run.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ConstraintCounts {
    /// Pairs within reach of each other: the mean and the maximum.
    pub in_reach: [f64; 2],
    /// Contacts: the mean and the maximum.
    pub contacts: [f64; 2],
    /// Constraint rows: the mean and the maximum.
    pub rows: [f64; 2],
    /// Iterations of the solver: the mean and the maximum.
    pub iterations: [f64; 2],
}

/// The pairs of geoms.
#[derive(Clone, Debug, PartialEq)]
pub struct PairSummary {
    /// The number of all pairs.
    pub all: usize,
    /// The number of pairs that can touch; zero if contacts are disabled.
    pub can_touch: usize,
    /// The other pairs by reason.
    pub excluded: Vec<(&'static str, usize)>,
    /// The tests of the pairs that can touch: the shapes, the number, and whether the general search is used.
    pub tests: Vec<([&'static str; 2], usize, bool)>,
    /// The counts of the measured run.
    pub seen: Option<ConstraintCounts>,
}

pub(super) fn pairs(model: &Model, plan: &Plan, seen: Option<ConstraintCounts>) -> PairSummary {
    let statistics = plan.pairs(model);
    let all = statistics.iter().map(|(_, n)| n).sum();
    if !plan.keeps(Stage::Collision)
        && statistics.iter().any(|(reason, _)| *reason == PairFilterReason::CanTouch)
    {
        let excluded = vec![("contacts are switched off", all)];
        return PairSummary { all, can_touch: 0, excluded, tests: Vec::new(), seen };
    }
    let can_touch =
        statistics.iter().find(|(reason, _)| *reason == PairFilterReason::CanTouch).map_or(0, |(_, n)| *n);
    let others = statistics.iter().filter(|(reason, _)| *reason != PairFilterReason::CanTouch);
    let tests = plan.tests(model).into_iter().map(|(types, n, searched)| (types.map(shape), n, searched));
    PairSummary {
        all,
        can_touch,
        excluded: others.map(|(reason, n)| (reason.reason(), *n)).collect(),
        tests: tests.collect(),
        seen,
    }
}

fn shape(kind: i32) -> &'static str {
    match kind {
        geom::PLANE => "plane",
        geom::HFIELD => "height field",
        geom::SPHERE => "sphere",
        geom::CAPSULE => "capsule",
        geom::ELLIPSOID => "ellipsoid",
        geom::CYLINDER => "cylinder",
        geom::BOX => "box",
        _ => "mesh",
    }
}

/// The sensors in their order.
pub(super) fn sensors(model: &Model, plan: &Plan) -> Vec<SensorRow> {
    let sensor = |sensor: core::SensorId| {
        let read = |i| plan.access().reads.contains_element(data::sensordata, i);
        let keep = plan.evaluates(model, sensor);
        let reason = match keep {
            true if sensor.values(model).any(read) => "its values are read",
            true => "the state or the energies contain what it measures",
            false => "nothing reads it",
        };
        let name = model.name_of(core::Obj::Sensor, sensor.index());
        let name = name.map_or_else(|| format!("sensor {}", sensor.index()), String::from);
        SensorRow { name, keep, reason }
    };
    model.sensors().map(sensor).collect()
}

/// The methods of the solver.
pub(super) fn solvers(model: &Model, plan: &Plan) -> Vec<EngineOption> {
    const METHODS: [(&str, i32); 3] = [("newton", solver::NEWTON), ("cg", solver::CG), ("pgs", solver::PGS)];
    let runs = plan.keeps(Stage::Solve);
    let nothing = plan.decisions().iter().find(|d| d.stage == Stage::Solve).map_or("", |d| d.reason.as_str());
    let named = METHODS.iter().find(|(_, id)| *id == model.opt.solver).map_or("newton", |(name, _)| name);
    let written = plan.access().writes.contains(option::solver);
    let methods = METHODS.iter().map(|&(name, _)| EngineOption {
        name,
        keep: runs && name == named,
        reason: match () {
            () if !runs => nothing.to_string(),
            () if name == named => "the options name it".into(),
            () if written => format!("the options name {named}; {WHEN_WRITTEN}"),
            () => format!("the options name {named}"),
        },
    });
    let slips = plan.access().writes.contains(option::noslip_iterations);
    let noslip = EngineOption {
        name: "noslip",
        keep: runs && model.opt.noslip_iterations > 0,
        reason: match () {
            () if !runs => nothing.to_string(),
            () if model.opt.noslip_iterations > 0 => "the options request it".into(),
            () if slips => format!("the options request no iterations of it; {WHEN_WRITTEN}"),
            () => "the options request no iterations of it".into(),
        },
    };
    methods.chain([noslip]).collect()
}

/// The integrators.
pub(super) fn integrators(model: &Model, access: &AccessSet) -> Vec<EngineOption> {
    let integrator = labspec::run::Integrator::of_model(model);
    let written = access.writes.contains(option::integrator);
    let code = |i: labspec::run::Integrator| EngineOption {
        name: i.name,
        keep: i == integrator,
        reason: match () {
            () if i == integrator => "the options name it".into(),
            () if written => format!("the options name {}; {WHEN_WRITTEN}", integrator.name),
            () => format!("the options name {}", integrator.name),
        },
    };
    INTEGRATORS.into_iter().map(code).collect()
}

/// The tree algorithms in their order.
pub(super) fn tree_algorithms(model: &Model, plan: &Plan) -> Vec<TreeAlgorithmUse> {
    let trees = plan.tree_algorithms(model);
    let count = |algorithm: core::TreeAlgorithm| {
        let uses = |i: usize| trees.iter().filter(|t| t.get(i) == Some(&algorithm)).count();
        TreeAlgorithmUse { name: algorithm.name(), trees: [uses(0), uses(1), uses(2)] }
    };
    core::TreeAlgorithm::all().map(count).collect()
}
