//! Makes plans: which stages a scene needs, with the reason for each. A plan is made once and used in every step.
//!
//! It depends on the structure of the model, on the fields that are read, and on those that are written: a parameter that a
//! program writes is treated as if it had any value. A plan never changes a number: the results of the stages that it leaves out
//! are not used by stages that run, and are not read.

use super::analysis::{AccessSet, FLAGS, ModelAnalysis};
use super::pipeline::STAGES;
use super::sequence::passes;
use crate::model::Model;
use crate::model::plan::{Decision, PlanFlag, PlanTable};
use crate::model::stage::Stage;
use crate::model::tree_algorithm::TreeAlgorithms;

/// Stages that only sensors need. The stages of a Runge–Kutta method leave them out.
const SENSOR_STAGES: [Stage; 3] = [Stage::SubtreeVel, Stage::RnePost, Stage::Sensors];

impl PlanTable {
    /// A plan in which every stage runs, needed or not. Tests compare plans with it.
    pub fn full() -> PlanTable {
        let mut plan = PlanTable::default();
        for row in &STAGES {
            plan.decide(row.stage, true, "the full pipeline was requested".into());
        }
        plan.arranged()
    }

    /// A plan with every stage except the one that puts trees to sleep. Constants are computed with all trees awake.
    pub fn awake() -> PlanTable {
        let mut plan = PlanTable::full();
        plan.keep(Stage::Sleep, false);
        plan.arranged()
    }

    /// The stages that a scene needs.
    ///
    /// The stages are decided from the last to the first. A stage runs if there is a reason to run it for its own sake, or if a
    /// later stage that runs uses its results.
    pub fn new(m: &Model, access: &AccessSet, algorithms: TreeAlgorithms) -> PlanTable {
        PlanTable::with(m, access, algorithms, None)
    }

    /// Like [`PlanTable::new`], with an additional stage and the stages that it uses, to measure their cost.
    pub fn with(m: &Model, access: &AccessSet, algorithms: TreeAlgorithms, more: Option<Stage>) -> PlanTable {
        let mut analysis = ModelAnalysis::new(m, access, algorithms);
        analysis.every_sensor |= more == Some(Stage::Sensors);
        let mut plan = PlanTable::default();
        (plan.algorithms, plan.more) = (algorithms, more);
        (plan.sensed, plan.every_sensor) = (access.reads.sensed_elements(), analysis.every_sensor);
        for (flag, holds) in FLAGS {
            plan.set_flag(flag, holds(&analysis));
        }
        for row in STAGES.iter().rev() {
            let user =
                STAGES.iter().find(|later| plan.keeps(later.stage) && later.uses(&analysis, row.stage));
            let why = (row.keep_reason)(&analysis)
                .or_else(|| user.map(|u| format!("the {} stage uses it", u.name)));
            let why = why.or_else(|| (more == Some(row.stage)).then(|| "it was requested".into()));
            match why {
                Some(reason) => plan.decide(row.stage, true, reason),
                None => plan.decide(row.stage, false, (row.omit_reason)(&analysis).into()),
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

    /// A plan in which every stage runs, without the list of reasons.
    pub(crate) fn everything() -> PlanTable {
        let mut plan = PlanTable::default();
        STAGES.iter().for_each(|row| plan.keep(row.stage, true));
        plan.arranged()
    }

    fn decide(&mut self, stage: Stage, keep: bool, reason: String) {
        self.keep(stage, keep);
        self.decisions.push(Decision { stage, keep, reason });
    }

    /// Sets the functions that each part of a forward pass runs.
    fn arranged(mut self) -> PlanTable {
        self.passes = [
            passes(|stage| self.keeps(stage)),
            passes(|stage| self.keeps(stage) && !SENSOR_STAGES.contains(&stage)),
        ];
        self
    }
}
