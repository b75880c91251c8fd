//! Plans as everybody but the engine sees them: what a demand leads to.

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

/// Which stages run, and why.
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
/// // What nobody asked for was not computed, and says so.
/// assert!(data.get("xpos").is_err());
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Debug)]
pub struct Plan {
    pub(super) inner: Inner,
    pub(super) access: AccessSet,
    /// The contents that it was made for; `None` where it holds for any.
    pub(super) made_for: Option<Contents>,
    /// The fields of which it holds for any value.
    pub(super) any: FieldSet,
}

impl PartialEq for Plan {
    /// Whether two plans decide the same for the same demand, whatever model they were made for.
    fn eq(&self, other: &Plan) -> bool {
        self.inner == other.inner && self.access == other.access
    }
}

impl Plan {
    /// The stages that a scene needs, for what is read and written.
    ///
    /// What decides it is taken as the model has it now, also where programs may write it: data that were planned are planned
    /// again when such a value changes.
    pub fn new(m: &Model, access: &AccessSet) -> Plan {
        Plan::by_algorithms(m, access, TreeAlgorithms::ALL)
    }

    /// The same with trees computed by some algorithms alone: to measure the gain of each, or to compare it with the general one.
    pub fn by_algorithms(m: &Model, access: &AccessSet, algorithms: TreeAlgorithms) -> Plan {
        Plan::made(m, access, deciding::never_asked(access), |d| Inner::new(m, d, algorithms))
    }

    /// The same with a stage more, and what it uses, wanted or not: to measure what it would cost. No number changes.
    pub fn with(m: &Model, access: &AccessSet, more: Stage) -> Plan {
        Plan::made(m, access, deciding::never_asked(access), |d| {
            Inner::with(m, d, TreeAlgorithms::ALL, Some(more))
        })
    }

    /// The stages that a scene may come to need, whatever programs write.
    pub fn for_any_value(m: &Model, access: &AccessSet) -> Plan {
        Plan::made(m, access, access.writes, |d| Inner::new(m, d, TreeAlgorithms::ALL))
    }

    /// A plan that holds for any values of some fields and for those at hand of all others.
    pub(super) fn made(
        m: &Model,
        access: &AccessSet,
        any: FieldSet,
        inner: impl FnOnce(&AccessSet) -> Inner,
    ) -> Plan {
        let inner = inner(&AccessSet { reads: access.reads, writes: any });
        Plan { inner, access: *access, made_for: Some(m.contents.clone()), any }
    }

    /// Every stage, needed or not: the reference that plans are held against.
    pub fn full() -> Plan {
        Plan { inner: Inner::full(), access: AccessSet::ANY, made_for: None, any: FieldSet::ALL }
    }

    /// Every stage but the one that lets trees sleep.
    pub fn awake() -> Plan {
        Plan { inner: Inner::awake(), access: AccessSet::ANY, made_for: None, any: FieldSet::ALL }
    }

    /// What it was made for.
    pub fn access(&self) -> &AccessSet {
        &self.access
    }

    /// Whether a stage runs.
    pub fn keeps(&self, stage: Stage) -> bool {
        self.inner.keeps(stage)
    }

    /// How many pairs of geoms of the model can ever touch, and how many cannot for which reason. Pairs of which programs may
    /// write what keeps them apart can touch.
    pub fn pairs(&self, m: &Model) -> Vec<(PairFilterReason, usize)> {
        collision::pair_statistics(m, analysis::changes(&self.inner))
    }

    /// How the pairs that can touch are tested: two types of geoms, how many such pairs there are, and whether their contacts
    /// are searched for by the general algorithm of convex shapes. Of more than 4096 pairs, those at the start.
    pub fn tests(&self, m: &Model) -> Vec<([i32; 2], usize, bool)> {
        collision::pair_methods(m, analysis::changes(&self.inner))
    }

    /// The algorithms that compute each tree of the model: for where its bodies are, for its inertia and forces, for its accelerations.
    pub fn tree_algorithms(&self, m: &Model) -> Vec<[TreeAlgorithm; 3]> {
        (0..m.ntree).map(|tree| tree_algorithms::selected_for(m, self.inner.algorithms, tree)).collect()
    }

    /// Whether the values of a sensor are computed. A sensor that nobody reads is left out by itself.
    pub fn evaluates(&self, m: &Model, sensor: SensorId) -> bool {
        let read = || sensor::is_read(m, sensor.index(), self.inner.sensed);
        self.keeps(Stage::Sensors) && (self.inner.every_sensor || read())
    }

    /// Every stage with the reason to keep it or leave it out, in the order of the pipeline.
    pub fn decisions(&self) -> &[Decision] {
        self.inner.decisions()
    }
}
