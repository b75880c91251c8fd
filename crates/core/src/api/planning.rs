//! `Plan` as embedders see it: the stages that an access set requires.

use super::contents::Contents;
use super::model::{Model, SensorId};
use crate::collision::{self, PairFilterReason};
use crate::dynamics::tree_algorithms;
use crate::model::plan::{Decision, PlanTable as Inner};
use crate::model::reflect::FieldSet;
use crate::model::stage::Stage;
use crate::model::tree_algorithm::{TreeAlgorithm, TreeAlgorithms};
use crate::sensor;
use crate::step::analysis::{self, AccessSet};
use crate::step::deciding;

/// Which stages run, and the reason for each.
///
/// ```
/// # fn main() -> Result<(), labspec_core::Error> {
/// use labspec_core::{Data, AccessSet, Model, Plan, reflect, step};
/// let model = Model::from_xml(
///     "<mujoco><worldbody><body><joint axis='0 1 0'/><geom size='0.1' pos='1 0 0'/></body></worldbody></mujoco>",
/// )?;
/// let mut access = AccessSet { reads: Default::default(), writes: Default::default() };
/// access.reads.insert(reflect::field(reflect::Object::Data, "qpos").expect("a field of the data"));
/// let plan = Plan::new(&model, &access);
/// assert!(plan.decisions().iter().any(|d| !d.keep));
/// let mut data = Data::planned(&model, plan);
/// step(&model, &mut data)?;
/// assert_eq!(data.get("qpos")?.len(), 1);
/// // A field outside of the requested set is not computed, and reading it is an error.
/// assert!(data.get("xpos").is_err());
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Debug)]
pub struct Plan {
    pub(super) inner: Inner,
    pub(super) access: AccessSet,
    /// The contents that the plan was made for, or `None` if it is valid for any contents.
    pub(super) made_for: Option<Contents>,
    /// The fields for which the plan is valid with any value.
    pub(super) any: FieldSet,
}

impl PartialEq for Plan {
    /// Whether two plans make the same decisions for the same access set. The models that they were made for are not compared.
    fn eq(&self, other: &Plan) -> bool {
        self.inner == other.inner && self.access == other.access
    }
}

impl Plan {
    /// The stages that a model needs for an access set.
    ///
    /// The plan assumes the current values of the model, even those that programs may write. Planned data get a new plan when
    /// such a value changes.
    pub fn new(m: &Model, access: &AccessSet) -> Plan {
        Plan::by_algorithms(m, access, TreeAlgorithms::ALL)
    }

    /// Like [`Plan::new`], with some tree algorithms only: to measure the gain of each, or to compare it with the general one.
    pub fn by_algorithms(m: &Model, access: &AccessSet, algorithms: TreeAlgorithms) -> Plan {
        Plan::make_plan(m, access, deciding::undecisive_writes(access), |d| Inner::new(m, d, algorithms))
    }

    /// Like [`Plan::new`], with an additional stage and the stages that it uses, to measure their cost. No number changes.
    pub fn with(m: &Model, access: &AccessSet, more: Stage) -> Plan {
        Plan::make_plan(m, access, deciding::undecisive_writes(access), |d| {
            Inner::with(m, d, TreeAlgorithms::ALL, Some(more))
        })
    }

    /// The stages that a model may need for any values that programs write.
    pub fn for_any_value(m: &Model, access: &AccessSet) -> Plan {
        Plan::make_plan(m, access, access.writes, |d| Inner::new(m, d, TreeAlgorithms::ALL))
    }

    /// A plan that is valid for any value of the fields `any`, and for the current values of all other fields.
    pub(super) fn make_plan(
        m: &Model,
        access: &AccessSet,
        any: FieldSet,
        inner: impl FnOnce(&AccessSet) -> Inner,
    ) -> Plan {
        let inner = inner(&AccessSet { reads: access.reads, writes: any });
        Plan { inner, access: *access, made_for: Some(m.contents.clone()), any }
    }

    /// A plan with every stage, needed or not. Tests compare plans with it.
    pub fn full() -> Plan {
        Plan { inner: Inner::full(), access: AccessSet::ANY, made_for: None, any: FieldSet::ALL }
    }

    /// A plan with every stage except the one that puts trees to sleep.
    pub fn awake() -> Plan {
        Plan { inner: Inner::awake(), access: AccessSet::ANY, made_for: None, any: FieldSet::ALL }
    }

    /// The access set that the plan was made for.
    pub fn access(&self) -> &AccessSet {
        &self.access
    }

    /// Whether a stage runs.
    pub fn keeps(&self, stage: Stage) -> bool {
        self.inner.keeps(stage)
    }

    /// The number of pairs of geoms of the model that can touch, and the number of those that cannot, by reason. A pair counts as
    /// able to touch if programs may write the fields that prevent it.
    pub fn pairs(&self, m: &Model) -> Vec<(PairFilterReason, usize)> {
        collision::pair_statistics(m, analysis::changes(&self.inner))
    }

    /// How the pairs that can touch are tested: two types of geoms, the number of such pairs, and whether the general algorithm
    /// for convex shapes finds their contacts. Covers the first 4096 pairs.
    pub fn tests(&self, m: &Model) -> Vec<([i32; 2], usize, bool)> {
        collision::pair_methods(m, analysis::changes(&self.inner))
    }

    /// The algorithms for each tree of the model: for the poses of its bodies, for its inertia and forces, and for its
    /// accelerations.
    pub fn tree_algorithms(&self, m: &Model) -> Vec<[TreeAlgorithm; 3]> {
        (0..m.ntree).map(|tree| tree_algorithms::selected_for(m, self.inner.algorithms, tree)).collect()
    }

    /// Whether the values of a sensor are computed. Each sensor that is not read is left out.
    pub fn evaluates(&self, m: &Model, sensor: SensorId) -> bool {
        let read = || sensor::is_read(m, sensor.index(), self.inner.sensed);
        self.keeps(Stage::Sensors) && (self.inner.every_sensor || read())
    }

    /// Every stage with the reason to run it or to leave it out, in the order of the pipeline.
    pub fn decisions(&self) -> &[Decision] {
        self.inner.decisions()
    }
}
