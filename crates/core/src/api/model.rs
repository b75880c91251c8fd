//! `Model` as embedders see it: all fields can be read, parameters can be edited, structure cannot.

use super::addresses::Addresses;
use super::contents::Contents;
use super::error::Error;
use crate::geometry::pair::CONVEX;
use crate::kinds::{disable, enable};
use crate::model::fields::{model_fields, option_fields, statistic_fields};
use crate::model::reflect::{self, FieldId, Object};
use crate::model::{self as inner, Names, Obj};
use crate::sensor;
use crate::setup;
use labspec_finding::nearest;
use std::ops::{Deref, Range};
use std::sync::Arc;

/// A compiled model. All fields of MuJoCo's `mjModel` can be read by their names, as `model.nq` or `model.body_mass`;
/// parameters are written through [`Model::edit`].
///
/// ```
/// # fn main() -> Result<(), labspec_core::Error> {
/// let mut model = labspec_core::Model::from_xml(
///     "<mujoco><worldbody><body name='ball'><freejoint/><geom size='0.05'/></body></worldbody></mujoco>",
/// )?;
/// let ball = model.body("ball")?;
/// assert_eq!((model.nq, ball.index()), (7, 1));
/// model.edit().body_mass[ball.index()] = 2.0;
/// # Ok(())
/// # }
/// ```
#[derive(Clone)]
pub struct Model {
    inner: inner::Model,
    pub(super) names: Arc<Names>,
    pub(super) addresses: Arc<Addresses>,
    /// The identity of the model, independent of its parameters, and the version of its contents.
    pub(super) contents: Contents,
}

impl std::fmt::Debug for Model {
    /// Prints the name and the sizes only: the whole model is thousands of numbers.
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let m = &self.inner;
        let sizes = format!("nq {} nv {} nu {} nbody {} ngeom {}", m.nq, m.nv, m.nu, m.nbody, m.ngeom);
        f.debug_struct("Model").field("name", &m.names.model).field("sizes", &sizes).finish_non_exhaustive()
    }
}

impl PartialEq for Model {
    fn eq(&self, other: &Model) -> bool {
        self.inner == other.inner
    }
}

impl Deref for Model {
    type Target = inner::Model;

    #[cfg_attr(not(feature = "small"), inline(always))]
    fn deref(&self) -> &inner::Model {
        &self.inner
    }
}

impl Model {
    pub(crate) fn new(inner: inner::Model) -> Model {
        let names = Arc::new(inner.names.clone());
        let addresses = Arc::new(Addresses::new(&inner));
        Model { inner, names, addresses, contents: Contents::new() }
    }

    /// Compiles a model from its text. The text cannot refer to files; use [`Model::from_xml_with`] or [`Model::from_file`] for
    /// that.
    ///
    /// # Errors
    ///
    /// All errors that were found: [`Error::diagnostics`].
    pub fn from_xml(xml: &str) -> Result<Model, Error> {
        crate::mjcf::compile(xml).map(Model::new).map_err(Error::Model)
    }

    /// Compiles a model from its text. `files` provides the files that the text includes or names: a folder, a map in memory, or
    /// any other implementation.
    ///
    /// # Errors
    ///
    /// All errors that were found: [`Error::diagnostics`].
    pub fn from_xml_with(xml: &str, files: &dyn crate::source::files::Files) -> Result<Model, Error> {
        crate::mjcf::compile_with(xml, files, None).map(Model::new).map_err(Error::Model)
    }

    /// Compiles a model from a file. The model can refer to files in the same folder and in its subfolders.
    ///
    /// # Errors
    ///
    /// The file cannot be read, is too large, is not UTF-8, or the model has errors.
    #[cfg(feature = "mjcf")]
    pub fn from_file(path: impl AsRef<std::path::Path>) -> Result<Model, Error> {
        crate::mjcf::compile_file(path.as_ref()).map(Model::new).map_err(Error::File)
    }

    /// The model as bytes, for [`Model::from_bytes`]. A frontend can ship a compiled model without the MJCF parser.
    pub fn to_bytes(&self) -> Vec<u8> {
        crate::step::store::write(&self.inner)
    }

    /// A model from the bytes of [`Model::to_bytes`].
    ///
    /// # Errors
    ///
    /// [`Error::NotAModel`] if the bytes were written by another version of the engine, truncated or changed. [`Error::NoConvex`]
    /// if the model needs the general algorithm for convex shapes and the build does not contain it.
    pub fn from_bytes(bytes: &[u8]) -> Result<Model, Error> {
        let inner = crate::step::store::read(bytes).ok_or(Error::NotAModel)?;
        if !CONVEX && let Some([geom1, geom2]) = setup::search(&inner) {
            return Err(Error::NoConvex { geom1, geom2 });
        }
        Ok(Model::new(inner))
    }

    /// The identity of the model. Clones have the same identity, whatever is edited in them. No other model of this program has
    /// it.
    pub fn identity(&self) -> u64 {
        self.contents.model
    }

    /// The writable fields of the model. Data that were planned for other parameters get a new plan at their next use.
    pub fn edit(&mut self) -> ModelEdit<'_> {
        self.contents.touch_all();
        ModelEdit::from_model(&mut self.inner)
    }

    /// The numbers of a field of the model, or `None` for a field of the data.
    pub fn field(&self, field: FieldId) -> Option<reflect::View<'_>> {
        (field.info().object != Object::Data).then(|| reflect::view_model(&self.inner, field))
    }

    /// The numbers of a field of the model, to write. Data that were planned for other parameters get a new plan at their next
    /// use.
    ///
    /// # Errors
    /// [`Error::NotWritable`], also for a field of the data.
    pub fn field_mut(&mut self, field: FieldId) -> Result<reflect::ViewMut<'_>, Error> {
        if field.info().object == Object::Data || !reflect::is_writable(field) {
            return Err(Error::NotWritable(field));
        }
        self.touch(field);
        Ok(reflect::view_model_mut(&mut self.inner, field))
    }

    pub(super) fn engine(&mut self) -> &mut inner::Model {
        &mut self.inner
    }

    /// Records a write to a field of the model.
    pub(super) fn touch(&mut self, field: FieldId) {
        self.contents.touch(field);
    }

    /// Records a write to the fields that `mj_setConst` computes.
    pub(super) fn touch_constants(&mut self) {
        self.contents.touch_constants();
    }
}

/// The reference types with which a type of the field table is read and edited.
pub trait Cell {
    /// The type of a read-only reference.
    type Read<'a>
    where
        Self: 'a;
    /// The type of a writable reference. Lists keep their length.
    type Edit<'a>
    where
        Self: 'a;
    /// A read-only reference.
    fn read(&mut self) -> Self::Read<'_>;
    /// A writable reference.
    fn edit(&mut self) -> Self::Edit<'_>;
}

macro_rules! cells {
    ($($t:ty),*) => { $(
        impl Cell for $t {
            type Read<'a> = &'a $t;
            type Edit<'a> = &'a mut $t;
            fn read(&mut self) -> &$t { self }
            fn edit(&mut self) -> &mut $t { self }
        }
        impl<const N: usize> Cell for [$t; N] {
            type Read<'a> = &'a [$t; N];
            type Edit<'a> = &'a mut [$t; N];
            fn read(&mut self) -> &[$t; N] { self }
            fn edit(&mut self) -> &mut [$t; N] { self }
        }
        impl Cell for Vec<$t> {
            type Read<'a> = &'a [$t];
            type Edit<'a> = &'a mut [$t];
            fn read(&mut self) -> &[$t] { self }
            fn edit(&mut self) -> &mut [$t] { self }
        }
    )* };
}
cells!(f64, i32, bool, usize);

/// The type and the value of a field in an edit. Fields that the engine computes or uses as indexes are read-only.
macro_rules! access {
    (type $a:lifetime Structure $ty:ty) => { <$ty as Cell>::Read<$a> };
    (type $a:lifetime Derived $ty:ty) => { <$ty as Cell>::Read<$a> };
    (type $a:lifetime $kind:ident $ty:ty) => { <$ty as Cell>::Edit<$a> };
    (value Structure $field:expr) => { Cell::read(&mut $field) };
    (value Derived $field:expr) => { Cell::read(&mut $field) };
    (value $kind:ident $field:expr) => { Cell::edit(&mut $field) };
}
pub(super) use access;

macro_rules! edits {
    ($($name:ident: $ty:ty, [$($dim:tt),*], $kind:ident, $stage:ident, $unit:literal, $doc:literal;)*) => {
        /// The writable fields of a model, by MuJoCo's names. Parameters can be changed, structure can only be read.
        #[allow(non_snake_case, missing_debug_implementations)] // MuJoCo's names; `Model` implements `Debug`
        pub struct ModelEdit<'a> {
            /// Options of the simulation.
            pub opt: OptionsEdit<'a>,
            /// Statistics.
            pub stat: StatisticEdit<'a>,
            $(#[doc = $doc] pub $name: access!(type 'a $kind $ty),)*
        }
        impl<'a> ModelEdit<'a> {
            fn from_model(m: &'a mut inner::Model) -> ModelEdit<'a> {
                ModelEdit {
                    opt: OptionsEdit::from_part(&mut m.opt),
                    stat: StatisticEdit::from_part(&mut m.stat),
                    $($name: access!(value $kind m.$name),)*
                }
            }
        }
    };
}
macro_rules! edits_of {
    ($edit:ident, $of:ty, $doc_of:literal; $($name:ident: $ty:ty, [$($dim:tt),*], $kind:ident, $stage:ident, $unit:literal, $doc:literal;)*) => {
        #[doc = $doc_of]
        #[allow(missing_debug_implementations)] // `Model` implements `Debug`
        pub struct $edit<'a> {
            $(#[doc = $doc] pub $name: access!(type 'a $kind $ty),)*
        }
        impl<'a> $edit<'a> {
            fn from_part(part: &'a mut $of) -> $edit<'a> {
                $edit { $($name: access!(value $kind part.$name),)* }
            }
        }
    };
}
macro_rules! option_edits { ($($t:tt)*) => { edits_of! { OptionsEdit, inner::Options, "Options to write."; $($t)* } } }
macro_rules! statistic_edits { ($($t:tt)*) => { edits_of! { StatisticEdit, inner::Statistic, "Statistics to write."; $($t)* } } }
model_fields!(edits);
option_fields!(option_edits);
statistic_fields!(statistic_edits);

/// Enumerations for options that MJCF writes as keywords and MuJoCo stores as numbers.
macro_rules! words {
    ($(#[$doc:meta])* $type:ident, $field:ident, $get:ident, $set:ident { $($(#[$vdoc:meta])* $name:ident = $number:literal,)* }) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        #[repr(i32)]
        pub enum $type { $($(#[$vdoc])* $name = $number,)* }
        impl TryFrom<i32> for $type {
            type Error = Error;
            fn try_from(number: i32) -> Result<$type, Error> {
                match number {
                    $($number => Ok($type::$name),)*
                    _ => Err(Error::Value { what: stringify!($field), must: concat!("one of:" $(, " ", stringify!($name))*) }),
                }
            }
        }
        impl Model {
            #[doc = concat!("`opt.", stringify!($field), "`; `None` where it holds a number without a meaning.")]
            pub fn $get(&self) -> Option<$type> {
                $type::try_from(self.opt.$field).ok()
            }
            #[doc = concat!("Sets `opt.", stringify!($field), "`.")]
            pub fn $set(&mut self, value: $type) {
                *self.edit().opt.$field = value as i32;
            }
        }
    };
}
words! {
    /// The integrator (mjtIntegrator).
    Integrator, integrator, integrator, set_integrator {
        /// Semi-implicit Euler method, with implicit damping of joints.
        Euler = 0,
        /// Runge–Kutta method of fourth order.
        RK4 = 1,
        /// Implicit in velocity.
        Implicit = 2,
        /// Implicit in velocity, without the derivatives of Coriolis and centrifugal forces.
        ImplicitFast = 3,
        /// Evaluates all forces at the end of the step.
        Discrete = 4,
        /// Runge–Kutta method that is of fourth order for rotations too (not MuJoCo's).
        Rkmk4 = 104,
        /// Runge–Kutta method of eighth order for translations and rotations (not MuJoCo's).
        Rkmk8 = 108,
        /// Collocation method of sixth order, symmetric in time (not MuJoCo's).
        Gauss = 106,
        /// Accurate to rounding where forces are smooth. Divides a step into up to 4096 parts (not MuJoCo's).
        Adaptive = 100,
    }
}
words! {
    /// The type of friction cone (mjtCone).
    Cone, cone, cone, set_cone {
        /// A pyramid; its edges are the constraint directions.
        Pyramidal = 0,
        /// An elliptic cone.
        Elliptic = 1,
    }
}
words! {
    /// The solver for constraint forces (mjtSolver).
    Solver, solver, solver, set_solver {
        /// Projected Gauss–Seidel method, applied to the dual problem.
        PGS = 0,
        /// Conjugate gradient method.
        CG = 1,
        /// Newton's method.
        Newton = 2,
    }
}

impl Model {
    /// Sets the timestep, s.
    ///
    /// # Errors
    ///
    /// The timestep is not positive, or not finite.
    pub fn set_timestep(&mut self, seconds: f64) -> Result<(), Error> {
        if !(seconds > 0.0 && seconds.is_finite()) {
            return Err(Error::Value { what: "the timestep", must: "above zero" });
        }
        *self.edit().opt.timestep = seconds;
        Ok(())
    }

    /// Whether a part of the simulation is disabled: one of [`crate::disable`].
    pub fn is_disabled(&self, bit: i32) -> bool {
        self.opt.disabled(bit)
    }

    /// Disables or enables a part of the simulation: one of [`disable`].
    pub fn set_disabled(&mut self, bit: i32, off: bool) {
        let supported = bit & (2 * disable::MULTICCD - 1);
        let flags = self.edit().opt.disableflags;
        *flags = if off { *flags | supported } else { *flags & !supported };
    }

    /// Whether an optional part is enabled: one of [`enable`].
    pub fn is_enabled(&self, bit: i32) -> bool {
        self.opt.enabled(bit)
    }

    /// Enables or disables an optional part: one of [`enable`].
    pub fn set_enabled(&mut self, bit: i32, on: bool) {
        let supported = bit & (2 * enable::IPC - 1);
        let flags = self.edit().opt.enableflags;
        *flags = if on { *flags | supported } else { *flags & !supported };
    }
}

/// Typed ids of objects, and their lookup by name.
macro_rules! ids {
    ($($(#[$doc:meta])* $id:ident $kind:ident $get:ident $of:ident $count:ident;)*) => {
        $(
            $(#[$doc])*
            #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
            pub struct $id(pub(super) usize);

            impl $id {
                /// The index of the object in MuJoCo's arrays.
                pub fn index(self) -> usize {
                    self.0
                }
            }
        )*

        impl Model {
            $(
                #[doc = concat!("The id of a ", stringify!($get), " by its name.")]
                pub fn $get(&self, name: &str) -> Result<$id, Error> {
                    find(&self.names, Obj::$kind, name).map($id)
                }
                #[doc = concat!("All ids of this kind: ", stringify!($of), ".")]
                pub fn $of(&self) -> impl ExactSizeIterator<Item = $id> + use<> {
                    (0..self.$count).map($id)
                }
            )*
        }
    };
}
ids! {
    /// A body. The world is the first.
    BodyId Body body bodies nbody;
    /// A joint.
    JointId Joint joint joints njnt;
    /// A geom.
    GeomId Geom geom geoms ngeom;
    /// A site.
    SiteId Site site sites nsite;
    /// A tendon.
    TendonId Tendon tendon tendons ntendon;
    /// An actuator.
    ActuatorId Actuator actuator actuators nactuator;
    /// A sensor.
    SensorId Sensor sensor sensors nsensor;
    /// A keyframe.
    KeyId Key key keys nkey;
}

impl SensorId {
    /// The indexes of the sensor's values in `sensordata`.
    pub fn values(self, m: &Model) -> Range<usize> {
        sensor::places(m, self.0)
    }
}

/// The id of a named object.
pub(super) fn find(names: &Names, kind: Obj, name: &str) -> Result<usize, Error> {
    names.id(kind, name).ok_or_else(|| {
        let nearest = nearest(name, names.of_kind(kind).iter().map(String::as_str)).map(String::from);
        Error::NoName { kind, name: name.to_string(), nearest }
    })
}

#[cfg(test)]
#[allow(clippy::unwrap_used)] // a panic is the report of a failed test
mod tests {
    use super::*;
    use crate::api::call::{reset_data, step};
    use crate::api::data::Data;
    use crate::model::reflect::field;

    #[test]
    fn a_field_is_written_without_data() {
        let text = "<mujoco><worldbody><body><joint axis='0 1 0'/><geom size='.1' pos='.5 0 0'/></body></worldbody></mujoco>";
        let mut m = Model::from_xml(text).unwrap();
        let mut d = Data::new(&m);
        step(&m, &mut d).unwrap();
        assert!(d.qacc[0] > 1.0);
        let mut gravity = m.field_mut(field(Object::Option, "gravity").unwrap()).unwrap();
        assert!(gravity.set(2, 0.0));
        // The data take the new value at their next use.
        reset_data(&m, &mut d).unwrap();
        step(&m, &mut d).unwrap();
        assert_eq!(d.qacc[0], 0.0);
        for (object, name) in
            [(Object::Data, "qpos"), (Object::Model, "nq"), (Object::Model, "body_parentid")]
        {
            let refused = m.field_mut(field(object, name).unwrap()).map(|_| ()).unwrap_err();
            assert!(matches!(refused, Error::NotWritable(_)), "{name}: {refused}");
        }
    }
}
