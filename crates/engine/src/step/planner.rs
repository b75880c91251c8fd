//! The plan: which stages a scene needs, with the reason for each, decided once and followed by every step.
//!
//! It follows from the structure of the model, from what will be read, and from what will be written: a
//! parameter that some program writes is treated as if it had any value. A plan never changes a number: the
//! stages it leaves out compute nothing that what is kept, or read, depends on.

use super::analysis::{AccessSet, FLAGS, ModelAnalysis};
use super::pipeline::STAGES;
use super::sequence::passes;
use crate::model::Model;
use crate::model::plan::{Decision, PlanFlag, PlanTable};
use crate::model::stage::Stage;
use crate::model::tree_algorithm::TreeAlgorithms;

/// What shows in sensors alone: the stages of Runge and Kutta's method leave it out.
const SENSOR_STAGES: [Stage; 3] = [Stage::SubtreeVel, Stage::RnePost, Stage::Sensors];

impl PlanTable {
    /// Every stage runs, needed or not: the reference that plans are held against.
    pub fn full() -> PlanTable {
        let mut plan = PlanTable::default();
        for row in &STAGES {
            plan.decide(row.stage, true, "the full pipeline was requested".into());
        }
        plan.arranged()
    }

    /// Every stage but the one that lets trees sleep: what computes constants wants all of them awake.
    pub fn awake() -> PlanTable {
        let mut plan = PlanTable::full();
        plan.keep(Stage::Sleep, false);
        plan.arranged()
    }

    /// The stages that this scene needs.
    ///
    /// From the last stage to the first: a stage runs when it is wanted for its own sake, or when a later
    /// stage that runs uses its results.
    pub fn new(m: &Model, access: &AccessSet, algorithms: TreeAlgorithms) -> PlanTable {
        PlanTable::with(m, access, algorithms, None)
    }

    /// The same with a stage more, and what it uses, wanted or not: to see what it would cost.
    pub fn with(m: &Model, access: &AccessSet, algorithms: TreeAlgorithms, more: Option<Stage>) -> PlanTable {
        let mut analysis = ModelAnalysis::new(m, access, algorithms);
        analysis.every_sensor |= more == Some(Stage::Sensors);
        let mut plan = PlanTable::default();
        (plan.algorithms, plan.more) = (algorithms, more);
        (plan.sensed, plan.every_sensor) = (access.reads.sensed(), analysis.every_sensor);
        for (flag, holds) in FLAGS {
            plan.set_flag(flag, holds(&analysis));
        }
        for row in STAGES.iter().rev() {
            let user =
                STAGES.iter().find(|later| plan.keeps(later.stage) && later.uses(&analysis, row.stage));
            let why =
                (row.wanted)(&analysis).or_else(|| user.map(|u| format!("the {} stage uses it", u.name)));
            let why = why.or_else(|| (more == Some(row.stage)).then(|| "it was requested".into()));
            match why {
                Some(reason) => plan.decide(row.stage, true, reason),
                None => plan.decide(row.stage, false, (row.left_out)(&analysis).into()),
            }
        }
        plan.decisions.reverse();
        let forced = plan.keeps(Stage::Passive) || plan.keeps(Stage::Actuation) || analysis.applies_forces();
        plan.set_flag(PlanFlag::Unforced, !forced);
        let ties = plan.has(PlanFlag::General) || plan.keeps(Stage::Solve) || plan.keeps(Stage::Sleep);
        plan.set_flag(PlanFlag::Ballistic, !forced && !ties);
        plan.set_flag(PlanFlag::BodyInertias, analysis.needs_body_inertias(&plan));
        let for_rows = analysis.mass_for_rows(&plan);
        plan.set_flag(PlanFlag::MassForRows, for_rows);
        plan.arranged()
    }

    /// Every stage runs; no list of reasons.
    pub(crate) fn everything() -> PlanTable {
        let mut plan = PlanTable::default();
        STAGES.iter().for_each(|row| plan.keep(row.stage, true));
        plan.arranged()
    }

    fn decide(&mut self, stage: Stage, keep: bool, reason: String) {
        self.keep(stage, keep);
        self.decisions.push(Decision { stage, keep, reason });
    }

    /// With what a forward pass runs.
    fn arranged(mut self) -> PlanTable {
        self.passes = [
            passes(|stage| self.keeps(stage)),
            passes(|stage| self.keeps(stage) && !SENSOR_STAGES.contains(&stage)),
        ];
        self
    }
}
