//! The version of the contents of a model: each field has a stamp that identifies its last write.
//!
//! Clones of a model share the stamps of the fields that are equal in them. A plan stores the stamps of the contents that it was
//! made for. The fields that differ from these contents are therefore known for every clone, and for any order in which clones
//! are written.

use crate::dynamics::tree_algorithms;
use crate::model::reflect::{self, FieldId, FieldSet, NFIELD, Object};
use crate::model::stage::Stage;
use std::sync::LazyLock;
use std::sync::atomic::{AtomicU64, Ordering};

/// The fields that the tree algorithms copy.
static COPIED: LazyLock<FieldSet> = LazyLock::new(|| {
    let mut set = FieldSet::EMPTY;
    tree_algorithms::copied().for_each(|field| set.insert(field));
    set
});

/// The source of identities and stamps. No two writes have the same stamp.
static NEXT: AtomicU64 = AtomicU64::new(1);

fn next() -> u64 {
    NEXT.fetch_add(1, Ordering::Relaxed)
}

/// The identity of a model and the stamps of its fields.
#[derive(Clone, Debug)]
pub(super) struct Contents {
    /// The identity of the model, independent of the values of its parameters.
    pub(super) model: u64,
    /// The stamp of the last write. Contents with the same version are equal.
    pub(super) version: u64,
    /// The stamp of the last write to a field that the tree algorithms copy.
    pub(super) copied: u64,
    /// The stamp of the last write to each field.
    stamps: Box<[u64; NFIELD]>,
}

impl Contents {
    /// The contents of a newly compiled model.
    pub(super) fn new() -> Contents {
        Contents { model: next(), version: next(), copied: next(), stamps: Box::new([0; NFIELD]) }
    }

    /// Records a write to one field.
    pub(super) fn touch(&mut self, field: FieldId) {
        self.version = next();
        if COPIED.contains(field) {
            self.copied = self.version;
        }
        if let Some(stamp) = self.stamps.get_mut(field.index()) {
            *stamp = self.version;
        }
    }

    /// Records that any field may have been written.
    pub(super) fn touch_all(&mut self) {
        self.version = next();
        self.copied = self.version;
        self.stamps.fill(self.version);
    }

    /// Records a write to the fields that `mj_setConst` computes.
    pub(super) fn touch_constants(&mut self) {
        self.version = next();
        self.copied = self.version;
        for field in constants() {
            if let Some(stamp) = self.stamps.get_mut(field.index()) {
                *stamp = self.version;
            }
        }
    }

    /// The fields whose stamps differ from those of other contents of the same model.
    pub(super) fn changed(&self, other: &Contents) -> FieldSet {
        let mut changed = FieldSet::EMPTY;
        if self.version == other.version {
            return changed;
        }
        let mut first = 0;
        for (a, b) in self.stamps.chunks(8).zip(other.stamps.chunks(8)) {
            if a != b {
                let differing = a.iter().zip(b).enumerate().filter(|(_, (a, b))| a != b);
                differing
                    .filter_map(|(i, _)| FieldId::new(first + i))
                    .for_each(|field| changed.insert(field));
            }
            first += 8;
        }
        changed
    }

    /// Copies the stamps of some fields from other contents.
    pub(super) fn copy_stamps(&mut self, other: &Contents, fields: &FieldSet) {
        for field in fields.iter() {
            if let (Some(stamp), Some(new)) =
                (self.stamps.get_mut(field.index()), other.stamps.get(field.index()))
            {
                *stamp = *new;
            }
        }
    }

    /// Copies the stamps of the fields that `mj_setConst` computes. The plan has already been checked for their values.
    pub(super) fn accept_constants(&mut self, other: &Contents) {
        for field in constants() {
            if let (Some(stamp), Some(new)) =
                (self.stamps.get_mut(field.index()), other.stamps.get(field.index()))
            {
                *stamp = *new;
            }
        }
        self.version = next();
    }

    /// Becomes equal to other contents, without allocation.
    pub(super) fn follow(&mut self, other: &Contents) {
        (self.model, self.version, self.copied) = (other.model, other.version, other.copied);
        self.stamps.copy_from_slice(&*other.stamps);
    }
}

/// The fields of a model that `mj_setConst` computes.
fn constants() -> impl Iterator<Item = FieldId> {
    reflect::fields().filter(|f| f.info().object != Object::Data && f.info().stage == Stage::SetConst)
}

#[cfg(test)]
#[allow(clippy::unwrap_used)] // a panic is the report of a failed test
mod tests {
    use crate::api::{call, data::Data, model::Model, planning::Plan};
    use crate::model::reflect::{FieldId, FieldSet, ViewMut, data, model, option};
    use crate::step::analysis::AccessSet;
    use proptest::prelude::*;

    const SCENE: &str = "<mujoco><worldbody><geom name='floor' type='plane' size='2 2 1'/>\
        <body pos='0 0 .12'><freejoint/><geom type='box' size='.1 .1 .1'/></body>\
        <body pos='1 0 .5'><joint axis='0 1 0'/><geom size='.05' pos='.2 0 0'/>\
        <body pos='.2 0 0'><joint axis='0 1 0'/><geom size='.05' pos='.2 0 0'/></body></body>\
        <body pos='-1 0 .04'><joint type='slide' axis='0 0 1'/><geom size='.05'/></body></worldbody>\
        <actuator><motor joint='push' gear='2'/></actuator></mujoco>";

    /// The fields that are written in the clones, and the values.
    const WRITES: [(FieldId, f64); 13] = [
        (model::geom_contype, 0.0),
        (model::geom_conaffinity, 2.0),
        (model::geom_friction, 0.2),
        (model::geom_solref, 0.05),
        (model::body_mass, 3.0),
        (model::body_pos, 0.3),
        (model::dof_damping, 0.7),
        (model::dof_frictionloss, 0.2),
        (model::dof_armature, 0.1),
        (model::jnt_stiffness, 5.0),
        (model::body_gravcomp, 0.5),
        (option::density, 50.0),
        (option::timestep, 0.003),
    ];

    fn scene() -> Model {
        Model::from_xml(&SCENE.replacen("<joint type='slide'", "<joint name='push' type='slide'", 1)).unwrap()
    }

    fn write(m: &mut Model, d: &mut Data<crate::api::data::Planned>, what: usize, index: usize) {
        let (field, value) = WRITES[what];
        let mut view = call::view_mut(m, d, field).unwrap();
        let len = match &view {
            ViewMut::F64(v) => v.len(),
            ViewMut::I32(v) => v.len(),
            ViewMut::Bool(v) => v.len(),
            ViewMut::Fixed => 0,
        };
        view.set(index % len.max(1), value);
    }

    fn coordinates() -> AccessSet {
        let mut access = AccessSet { reads: FieldSet::EMPTY, writes: FieldSet::EMPTY };
        access.reads.insert(data::qpos);
        access
    }

    /// Steps that alternate between clones, which are written directly and through edits, give the same result as full steps.
    fn check_clones_agree(
        events: &[(usize, usize, usize)],
        made_with: usize,
        announced: &[usize],
    ) -> Result<(), TestCaseError> {
        let mut clones = [scene(), Model::new(crate::mjcf::compile("<mujoco/>").unwrap())];
        clones[1] = clones[0].clone();
        let mut access = coordinates();
        announced.iter().for_each(|&i| access.writes.insert(WRITES[i].0));
        let mut planned = Data::planned(&clones[0], Plan::new(&clones[made_with], &access));
        let mut full = Data::unplanned(&clones[0]);
        for &(what, index, which) in events {
            let other = clones[(which + 1) % 2].clone();
            let clone = &mut clones[which % 2];
            match what.checked_sub(WRITES.len()) {
                None => write(clone, &mut planned, what, index),
                Some(0) => clone.edit().geom_contype[0] ^= 1,
                Some(1) => *clone = other,
                Some(_) => {}
            }
            let clone = &clones[index % 2];
            for _ in 0..4 {
                call::step(clone, &mut planned).unwrap();
                call::step(clone, &mut full).unwrap();
            }
            let bits = |q: &[f64]| q.iter().map(|x| x.to_bits()).collect::<Vec<_>>();
            prop_assert_eq!(bits(&planned.fields().qpos), bits(&full.qpos));
        }
        Ok(())
    }

    proptest! {
        #[test]
        fn data_that_are_moved_between_clones_step_as_full_data(
            events in prop::collection::vec((0..WRITES.len() + 3, 0..40usize, 0..2usize), 1..12),
            announced in prop::collection::vec(0..WRITES.len(), 0..3),
        ) {
            check_clones_agree(&events, 0, &announced)?;
        }
    }

    /// A planned run uses the floor of the model that it steps with, not that of the clone for which the plan was made.
    #[test]
    fn a_body_does_not_fall_through_the_floor_of_another_clone() {
        let with = scene();
        let mut without = with.clone();
        without.edit().geom_contype.fill(0);
        without.edit().geom_conaffinity.fill(0);
        let made = Data::planned(&without, Plan::new(&without, &coordinates()));
        let given = Data::planned(&with, Plan::new(&without, &coordinates()));
        for mut d in [made, given] {
            (0..200).for_each(|_| call::step(&with, &mut d).unwrap());
            assert!(d.fields().qpos[2] > 0.09, "{}", d.fields().qpos[2]);
        }
    }

    /// Trees that fell asleep with one clone wake up with another clone that does not allow sleep.
    #[test]
    fn sleepers_wake_where_nothing_may_sleep() {
        let text = SCENE.replacen("<mujoco>", "<mujoco><option><flag sleep='enable'/></option>", 1);
        let text = text.replacen("<joint type='slide'", "<joint name='push' type='slide'", 1);
        let sleepy = Model::from_xml(&text).unwrap();
        let mut awake = sleepy.clone();
        awake.set_enabled(crate::kinds::enable::SLEEP, false);
        let mut access = coordinates();
        access.reads.insert(data::tree_asleep);
        let mut planned = Data::planned(&sleepy, Plan::new(&sleepy, &access));
        let mut full = Data::unplanned(&sleepy);
        let mut slept = false;
        for (model, steps) in [(&sleepy, 3000), (&awake, 20)] {
            for _ in 0..steps {
                call::step(model, &mut planned).unwrap();
                call::step(model, &mut full).unwrap();
            }
            slept |= full.tree_asleep.iter().any(|&island| island >= 0);
            assert_eq!(planned.fields().qpos, full.qpos);
            assert_eq!(planned.fields().tree_asleep, full.tree_asleep);
        }
        assert!(slept && full.tree_asleep.iter().all(|&island| island < 0), "{:?}", full.tree_asleep);
    }

    /// Forces that are part of a copied state act, whether the access set announces them or not.
    #[test]
    fn forces_of_a_state_that_is_set_act() {
        let m = scene();
        let mut from = Data::unplanned(&m);
        from.edit().xfrc_applied[8] = 500.0;
        let mut d = Data::planned(&m, Plan::new(&m, &coordinates()));
        call::step(&m, &mut d).unwrap();
        call::state::copy(&m, &from, &mut d, call::state::INTEGRATION).unwrap();
        (0..20).for_each(|_| {
            call::step(&m, &mut from).unwrap();
            call::step(&m, &mut d).unwrap();
        });
        assert_eq!(d.fields().qpos, from.qpos);
    }

    /// A write in every step to a field that the access set announces causes one new plan. That plan is valid for any value of
    /// the field.
    #[test]
    fn writes_in_every_step_do_not_plan() {
        let mut m = scene();
        let mut access = coordinates();
        access.writes.insert(model::dof_damping);
        let mut d = Data::planned(&m, Plan::new(&m, &access));
        m.edit().body_mass[1] *= 2.0;
        call::step(&m, &mut d).unwrap();
        let mut plans = Vec::new();
        for i in 0..1000 {
            call::view_mut(&mut m, &mut d, model::dof_damping).unwrap().set(0, 0.1 * f64::from(i));
            call::step(&m, &mut d).unwrap();
            plans.push(d.plan().any);
        }
        plans.dedup();
        assert_eq!(plans.len(), 1, "{plans:?}");
        let before = d.plan_version();
        call::view_mut(&mut m, &mut d, model::body_mass).unwrap().set(1, 0.5);
        call::step(&m, &mut d).unwrap();
        assert_ne!(d.plan_version(), before);
    }
}
