//! `Data` as embedders see it: the data belong to one model, fields can be read by name, and state and inputs can be written.

use super::addresses::Addresses;
use super::assumed::{Assumed, SETTLED};
use super::error::Error;
use super::model::{Cell, Model, access};
use super::planning::Plan;
use crate::dynamics::tree_algorithms;
use crate::model::fields::data_fields;
use crate::model::plan::{PlanFlag, PlanTable};
use crate::model::reflect::{self, FieldId, FieldSet, Kind, Object, View, ViewMut, data};
use crate::model::stage::Stage;
use crate::model::{Fields, Names};
use crate::step::analysis::AccessSet;
use crate::step::deciding::{deciding, undecisive_writes};
use crate::step::reset;
use crate::step::workspace::{StepScratch, Workspace};
use std::marker::PhantomData;
use std::ops::Deref;
use std::sync::Arc;

/// Marks data of which all fields are computed and can be read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Full;

/// Marks data of which only the requested fields are computed. See [`Data::planned`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Planned;

/// Which fields of data are computed: all, or those of a plan.
pub trait Scope: Copy + std::fmt::Debug + PartialEq + sealed::Sealed {
    /// Whether all fields are computed.
    const FULL: bool;
}
impl Scope for Full {
    const FULL: bool = true;
}
impl Scope for Planned {
    const FULL: bool = false;
}
mod sealed {
    pub trait Sealed {}
    impl Sealed for super::Full {}
    impl Sealed for super::Planned {}
}

/// State, inputs and results of a simulation of one model. All fields of MuJoCo's `mjData` can be read by their names, as
/// `data.qpos` or `data.xpos`; state and inputs are written through [`Data::edit`].
///
/// Data belong to the model that they were made for, and to its clones. A call with another model is an error.
///
/// ```
/// # fn main() -> Result<(), labspec_core::Error> {
/// use labspec_core::{Data, Model, step};
/// let model = Model::from_xml(
///     "<mujoco><worldbody><body name='ball' pos='0 0 1'><freejoint/><geom size='0.05'/></body></worldbody></mujoco>",
/// )?;
/// let mut data = Data::new(&model);
/// data.edit().qvel[2] = 1.0;
/// for _ in 0..100 {
///     step(&model, &mut data)?;
/// }
/// let [_, _, height] = data.body("ball")?.xpos();
/// assert!((data.time - 0.2).abs() < 1e-12 && height > 0.9);
/// # Ok(())
/// # }
/// ```
#[derive(Clone)]
pub struct Data<S: Scope = Full> {
    pub(super) fields: Fields,
    pub(super) scratch: StepScratch,
    pub(super) names: Arc<Names>,
    pub(super) addresses: Arc<Addresses>,
    /// The identity of the model, and the version of its contents at the last use of the data; 0 if the plan has not been
    /// compared with any contents.
    model: u64,
    pub(super) version: u64,
    /// The stamp of the last write to the fields that the tree algorithms copy, at the time of the copy.
    copied: u64,
    /// What the plan assumes.
    pub(super) assumed: Assumed,
    pub(super) access: AccessSet,
    /// Whether inputs may have been written that the access set does not announce.
    pub(super) touched: bool,
    scope: PhantomData<S>,
}

impl<S: Scope> std::fmt::Debug for Data<S> {
    /// Prints the time and the state only: all of the data are thousands of numbers.
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Fields { time, qpos, qvel, .. } = &self.fields;
        f.debug_struct("Data")
            .field("time", time)
            .field("qpos", qpos)
            .field("qvel", qvel)
            .finish_non_exhaustive()
    }
}

impl<S: Scope> PartialEq for Data<S> {
    fn eq(&self, other: &Data<S>) -> bool {
        self.fields == other.fields && self.scratch == other.scratch
    }
}

impl Deref for Data<Full> {
    type Target = Fields;

    #[cfg_attr(not(feature = "small"), inline(always))]
    fn deref(&self) -> &Fields {
        &self.fields
    }
}

impl Data<Full> {
    /// Data for a model, in the default configuration. Nothing is computed yet: call [`forward`](crate::forward).
    pub fn new(m: &Model) -> Data<Full> {
        Data::with_plan(m, Plan::new(m, &AccessSet::ANY))
    }
}

impl Data<Full> {
    /// Data for which every stage runs in every step, needed or not. Tests compare plans with such data.
    pub fn unplanned(m: &Model) -> Data<Full> {
        Data::with_plan(m, Plan::full())
    }
}

impl Data<Planned> {
    /// Data that compute only the stages that a plan keeps. Other fields cannot be read.
    pub fn planned(m: &Model, plan: Plan) -> Data<Planned> {
        Data::with_plan(m, plan)
    }
}

impl<S: Scope> Data<S> {
    fn with_plan(m: &Model, mut plan: Plan) -> Data<S> {
        let assumed = Assumed::from_plan(&mut plan);
        let Workspace { fields, scratch } = Workspace::planned(m, plan.inner);
        Data {
            assumed,
            fields,
            scratch,
            names: Arc::clone(&m.names),
            addresses: Arc::clone(&m.addresses),
            model: m.contents.model,
            version: 0,
            copied: m.contents.copied,
            access: plan.access,
            touched: !S::FULL,
            scope: PhantomData,
        }
    }

    /// Simulated time, s.
    pub fn time(&self) -> f64 {
        self.fields.time
    }

    /// All fields, computed or not, for hosts that know which fields they requested.
    #[doc(hidden)]
    #[cfg_attr(not(feature = "small"), inline(always))]
    pub fn fields(&self) -> &Fields {
        &self.fields
    }

    /// The writable fields: state, inputs, and the acceleration from which [`inverse`](crate::inverse) starts. All other fields
    /// can be read.
    pub fn edit(&mut self) -> Edit<'_> {
        self.touched = !S::FULL;
        Edit::from_fields(&mut self.fields)
    }

    /// The numbers of a field of the data, by its name.
    pub fn get(&self, name: &str) -> Result<View<'_>, Error> {
        let field = reflect::field(Object::Data, name).ok_or_else(|| Error::NoField(name.into()))?;
        self.read(field)
    }

    /// The numbers of a field of the data.
    pub fn read(&self, field: FieldId) -> Result<View<'_>, Error> {
        let info = field.info();
        if info.object != Object::Data {
            return Err(Error::NoField(info.name.into()));
        }
        let written = matches!(info.kind, Kind::State | Kind::Input);
        let view = reflect::view_data(&self.fields, field);
        if S::FULL || written || self.access.reads.contains_whole(field, view.len()) {
            Ok(view)
        } else {
            Err(Error::LeftOut { field, stage: info.stage })
        }
    }

    /// The numbers of a field of the data, for writing.
    pub fn write(&mut self, field: FieldId) -> Result<ViewMut<'_>, Error> {
        let info = field.info();
        if info.object != Object::Data {
            return Err(Error::NoField(info.name.into()));
        }
        if !reflect::is_writable(field) {
            return Err(Error::NotWritable(field));
        }
        self.touched |= !S::FULL && !self.access.writes.contains(field);
        Ok(reflect::view_data_mut(&mut self.fields, field))
    }

    /// The fields that are read and written in these data.
    pub fn access(&self) -> &AccessSet {
        &self.access
    }

    /// The plan that determines which stages run.
    pub fn plan(&self) -> Plan {
        let (inner, made_for) = (self.fields.plan.clone(), self.assumed.made_for.clone());
        Plan { inner, access: self.access, made_for, any: self.assumed.any() }
    }

    /// The fields and the scratch, after a check that the data belong to the model and that the plan is valid for its parameters.
    #[cfg_attr(not(feature = "small"), inline(always))]
    pub(super) fn engine(&mut self, m: &Model) -> Result<(&mut Fields, &mut StepScratch), Error> {
        if self.version != m.contents.version {
            self.catch_up(m, false)?;
        }
        self.engine_in_step(m)
    }

    /// Like [`Data::engine`], for a call that computes all fields.
    #[cfg_attr(not(feature = "small"), inline(always))]
    pub(super) fn engine_for_pass(&mut self, m: &Model) -> Result<(&mut Fields, &mut StepScratch), Error> {
        if self.version != m.contents.version {
            self.catch_up(m, true)?;
        }
        self.engine_in_step(m)
    }

    #[cfg_attr(not(feature = "small"), inline(always))]
    fn engine_in_step(&mut self, m: &Model) -> Result<(&mut Fields, &mut StepScratch), Error> {
        if self.touched {
            self.replan_for_inputs(m)?;
        }
        Ok((&mut self.fields, &mut self.scratch))
    }

    /// Like [`Data::engine`], for a call that may write inputs. See [`Data::edit`].
    pub(super) fn engine_to_write(&mut self, m: &Model) -> Result<(&mut Fields, &mut StepScratch), Error> {
        self.engine(m)?;
        self.touched = !S::FULL;
        Ok((&mut self.fields, &mut self.scratch))
    }

    /// Replaces the plan if forces or controls are applied that the access set does not announce, or if an equality constraint is
    /// switched on. With the old plan they would have no effect.
    #[cold]
    fn replan_for_inputs(&mut self, m: &Model) -> Result<(), Error> {
        self.belongs_to(m)?;
        self.touched = false;
        let before = self.access.writes;
        let Fields { qfrc_applied, xfrc_applied, ctrl, eq_active, .. } = &self.fields;
        for (field, list) in [(data::qfrc_applied, qfrc_applied), (data::xfrc_applied, xfrc_applied)] {
            if list.iter().any(|&x| x != 0.0) {
                self.access.writes.insert(field);
            }
        }
        let plan = &self.fields.plan;
        if !plan.keeps(Stage::Actuation) && ctrl.iter().any(|&u| u != 0.0) {
            self.access.writes.insert(data::ctrl);
        }
        if !plan.has(PlanFlag::Equalities) && eq_active.contains(&true) {
            self.access.writes.insert(data::eq_active);
        }
        if self.access.writes != before {
            self.plan_again(m);
            self.touched = false;
        }
        Ok(())
    }

    /// The version of the contents that the plan was made for.
    #[cfg(test)]
    pub(super) fn plan_version(&self) -> Option<u64> {
        self.assumed.made_for.as_ref().map(|planned| planned.version)
    }

    #[cfg_attr(not(feature = "small"), inline(always))]
    pub(super) fn belongs_to(&self, m: &Model) -> Result<(), Error> {
        if self.model == m.contents.model { Ok(()) } else { Err(Error::ForeignData) }
    }

    /// Records that the plan has been checked for the constants that were computed with these data.
    pub(super) fn mark_synced(&mut self, m: &Model) {
        self.version = self.assumed.version_of(&m.contents);
        self.assumed.accept_constants(&m.contents);
    }

    /// Replaces the plan.
    pub(super) fn replan(&mut self, m: &Model, mut plan: Plan) -> Result<(), Error> {
        self.belongs_to(m)?;
        (self.version, self.access, self.assumed) = (0, plan.access, Assumed::from_plan(&mut plan));
        reset::set_plan(m, &mut self.fields, &mut self.scratch, plan.inner);
        self.touched = !S::FULL;
        Ok(())
    }

    /// Checks that fields of the data are computed.
    #[cfg_attr(not(feature = "small"), inline(always))]
    pub(super) fn has(&self, fields: &[FieldId]) -> Result<(), Error> {
        if S::FULL { Ok(()) } else { self.missing_fields(fields) }
    }

    fn missing_fields(&self, fields: &[FieldId]) -> Result<(), Error> {
        let all_read = |field: &FieldId| self.access.reads.contains_whole(*field, usize::MAX);
        fields.iter().filter(|f| !all_read(f)).try_for_each(|field| self.read(*field).map(|_| ()))
    }
}

impl<S: Scope> Data<S> {
    /// Updates the plan when the parameters of the model differ from those at the last use of the data, when the model is a clone
    /// with other values, or when the plan is wider than necessary. The plan stays if the parameters differ from those that it
    /// was made for only in fields that may have any value. Otherwise a new plan is made.
    #[cold]
    pub(super) fn catch_up(&mut self, m: &Model, whole: bool) -> Result<(), Error> {
        self.belongs_to(m)?;
        if self.copied != m.contents.copied {
            self.copied = m.contents.copied;
            tree_algorithms::load(m, &mut self.scratch.dynamics);
        }
        let Some(planned) = &mut self.assumed.made_for else {
            self.version = m.contents.version;
            return Ok(());
        };
        let current = self.fields.meter.cost;
        let calm = current >= self.assumed.settled;
        let unrest = current.saturating_add(SETTLED.saturating_mul(self.fields.meter.pass()));
        let changed = planned.changed(&m.contents);
        let mut narrower = whole && self.assumed.wide && (calm || self.assumed.due);
        if !changed.difference(&self.assumed.any).is_empty() {
            narrower |= whole && calm;
            if !narrower {
                self.assumed.due |= calm;
                let mut any = self.assumed.any;
                any.extend(&changed.intersection(&self.access.writes));
                self.plan_for(m, any);
            }
            self.assumed.settled = self.assumed.settled.max(unrest);
        } else if self.assumed.wide {
            let moved = changed.intersection(&deciding());
            if !moved.is_empty() {
                planned.copy_stamps(&m.contents, &moved);
                self.assumed.settled = self.assumed.settled.max(unrest);
                narrower &= self.assumed.due;
            }
        }
        if narrower {
            self.assumed.due = false;
            self.plan_for(m, undecisive_writes(&self.access));
        }
        self.version = self.assumed.version_of(&m.contents);
        Ok(())
    }

    /// Whether the plan is valid only for the values that the model had when the plan was made.
    pub(super) fn assumes_values(&self) -> bool {
        self.assumed.made_for.is_some()
    }

    /// Makes a new plan for the current values of the model.
    pub(super) fn plan_again(&mut self, m: &Model) {
        let mut any = self.assumed.any;
        any.extend(&undecisive_writes(&self.access));
        self.plan_for(m, any);
    }

    /// Makes a new plan that is valid for any value of some fields.
    fn plan_for(&mut self, m: &Model, any: FieldSet) {
        let PlanTable { algorithms, more, .. } = self.fields.plan;
        let plan =
            Plan::make_plan(m, &self.access, any, |access| PlanTable::with(m, access, algorithms, more));
        reset::set_plan(m, &mut self.fields, &mut self.scratch, plan.inner);
        // The data may contain values that the plan does not assume.
        self.touched = !S::FULL;
        self.assumed.any = any;
        self.assumed.wide = any != undecisive_writes(&self.access);
        match &mut self.assumed.made_for {
            Some(planned) => planned.follow(&m.contents),
            None => self.assumed.made_for = plan.made_for,
        }
    }
}

macro_rules! edits {
    ($($name:ident: $ty:ty, [$($dim:tt),*], $kind:ident, $stage:ident, $unit:literal, $doc:literal;)*) => {
        /// The writable fields of data, by MuJoCo's names. State and inputs can be changed, results can be read.
        #[allow(non_snake_case, missing_debug_implementations)] // MuJoCo's names; `Data` implements `Debug`
        pub struct Edit<'a> {
            $(#[doc = $doc] pub $name: access!(type 'a $kind $ty),)*
        }
        impl<'a> Edit<'a> {
            fn from_fields(d: &'a mut Fields) -> Edit<'a> {
                Edit { $($name: access!(value $kind d.$name),)* }
            }
        }
    };
}
data_fields!(edits);

impl<S: Scope> Data<S> {
    /// Sets the acceleration, m/s² or rad/s², whose forces [`inverse`](crate::inverse) computes.
    pub fn set_qacc(&mut self, qacc: &[f64]) -> Result<(), Error> {
        let to = &mut self.fields.qacc;
        if to.len() != qacc.len() {
            return Err(Error::Length { what: "an acceleration", expected: to.len(), found: qacc.len() });
        }
        to.copy_from_slice(qacc);
        Ok(())
    }
}
