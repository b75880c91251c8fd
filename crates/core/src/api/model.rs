//! `Model` as everybody but the engine sees it: its fields can be read, its parameters edited, its structure not.

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
    /// Which model it is, whatever its parameters, and which contents it has now.
    pub(super) contents: Contents,
}

impl std::fmt::Debug for Model {
    /// Its name and sizes: all of it would be thousands of numbers.
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

    /// Compiles a model from its text. It can name no files: [`Model::from_xml_with`] and [`Model::from_file`] let it.
    ///
    /// # Errors
    ///
    /// All mistakes that were found: [`Error::diagnostics`].
    #[cfg(feature = "mjcf")]
    pub fn from_xml(xml: &str) -> Result<Model, Error> {
        crate::mjcf::compile(xml).map(Model::new).map_err(Error::Model)
    }

    /// Compiles a model from its text, and what it includes or names from `files`: a folder, a map in memory, or whatever
    /// answers for a path.
    ///
    /// # Errors
    ///
    /// All mistakes that were found: [`Error::diagnostics`].
    #[cfg(feature = "mjcf")]
    pub fn from_xml_with(xml: &str, files: &dyn crate::mjcf::Files) -> Result<Model, Error> {
        crate::mjcf::compile_with(xml, files, None).map(Model::new).map_err(Error::Model)
    }

    /// Compiles a model from a file, with what it names in the folder of that file and below.
    ///
    /// # Errors
    ///
    /// The file cannot be read, is too large, is not UTF-8, or the model has mistakes.
    #[cfg(feature = "mjcf")]
    pub fn from_file(path: impl AsRef<std::path::Path>) -> Result<Model, Error> {
        crate::mjcf::compile_file(path.as_ref()).map(Model::new).map_err(Error::File)
    }

    /// The model as bytes, for [`Model::from_bytes`]: frontends ship models, not parsers.
    pub fn to_bytes(&self) -> Vec<u8> {
        crate::step::store::write(&self.inner)
    }

    /// A model from the bytes of [`Model::to_bytes`].
    ///
    /// # Errors
    ///
    /// They were written by another version of the engine, cut off or changed: [`Error::NotAModel`]. The build has no general
    /// algorithm for convex shapes, and the model needs it: [`Error::NoConvex`].
    pub fn from_bytes(bytes: &[u8]) -> Result<Model, Error> {
        let inner = crate::step::store::read(bytes).ok_or(Error::NotAModel)?;
        if !CONVEX && let Some([geom1, geom2]) = setup::search(&inner) {
            return Err(Error::NoConvex { geom1, geom2 });
        }
        Ok(Model::new(inner))
    }

    /// Which model this is: its clones answer the same, whatever is edited in them, and no other model of this program does.
    pub fn identity(&self) -> u64 {
        self.contents.model
    }

    /// What can be written of the model. Data that were planned for other parameters are planned again at their next use.
    pub fn edit(&mut self) -> ModelEdit<'_> {
        self.contents.touch_all();
        ModelEdit::from_model(&mut self.inner)
    }

    /// The numbers of a field of the model; `None` for a field of the data.
    pub fn field(&self, field: FieldId) -> Option<reflect::View<'_>> {
        (field.info().object != Object::Data).then(|| reflect::view_model(&self.inner, field))
    }

    pub(super) fn engine(&mut self) -> &mut inner::Model {
        &mut self.inner
    }

    /// Notes that fields of the model have been written.
    pub(super) fn touch(&mut self, field: FieldId) {
        self.contents.touch(field);
    }

    /// Notes that what `mj_setConst` computes has been written.
    pub(super) fn touch_constants(&mut self) {
        self.contents.touch_constants();
    }
}

/// How a type of the field table is shown and edited.
pub trait Cell {
    /// To read.
    type Read<'a>
    where
        Self: 'a;
    /// To write: lists keep their length.
    type Edit<'a>
    where
        Self: 'a;
    /// What may be read.
    fn read(&mut self) -> Self::Read<'_>;
    /// What may be written.
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

/// The type of a field in an edit, and the field itself: what the engine indexes by or computes is shown, not given.
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
        /// The fields of a model to write, by MuJoCo's names: parameters can be changed, structure can be read.
        #[allow(non_snake_case, missing_debug_implementations)] // MuJoCo's names; references into a model, which prints itself
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
        #[allow(missing_debug_implementations)] // references into a model, which prints itself
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

/// Names that are options' numbers in MJCF, with MuJoCo's numbers.
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
    /// How a state is advanced (mjtIntegrator).
    Integrator, integrator, integrator, set_integrator {
        /// Semi-implicit, with implicit damping of joints.
        Euler = 0,
        /// Runge and Kutta's of fourth order.
        RK4 = 1,
        /// Implicit in velocity.
        Implicit = 2,
        /// Implicit in velocity, without the derivatives of Coriolis and centrifugal forces.
        ImplicitFast = 3,
        /// All forces at the end of the step.
        Discrete = 4,
        /// Runge and Kutta's, of fourth order for rotations too (not MuJoCo's).
        Rkmk4 = 104,
        /// The same of eighth order (not MuJoCo's).
        Rkmk8 = 108,
        /// Collocation of sixth order, symmetric in time (not MuJoCo's).
        Gauss = 106,
        /// As exact as rounding allows where forces are smooth, in up to 4096 parts of a step (not MuJoCo's).
        Adaptive = 100,
    }
}
words! {
    /// How contacts resist sliding (mjtCone).
    Cone, cone, cone, set_cone {
        /// By the edges of a pyramid.
        Pyramidal = 0,
        /// In a cone.
        Elliptic = 1,
    }
}
words! {
    /// How constraint forces are found (mjtSolver).
    Solver, solver, solver, set_solver {
        /// Projected Gauss–Seidel, in the dual problem.
        PGS = 0,
        /// Conjugate gradients.
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
    /// It is not above zero, or no number.
    pub fn set_timestep(&mut self, seconds: f64) -> Result<(), Error> {
        if !(seconds > 0.0 && seconds.is_finite()) {
            return Err(Error::Value { what: "the timestep", must: "above zero" });
        }
        *self.edit().opt.timestep = seconds;
        Ok(())
    }

    /// Whether a part of the simulation is switched off: one of [`crate::disable`].
    pub fn is_disabled(&self, bit: i32) -> bool {
        self.opt.disabled(bit)
    }

    /// Switches a part of the simulation off or on: one of [`disable`].
    pub fn set_disabled(&mut self, bit: i32, off: bool) {
        let supported = bit & (2 * disable::MULTICCD - 1);
        let flags = self.edit().opt.disableflags;
        *flags = if off { *flags | supported } else { *flags & !supported };
    }

    /// Whether an optional part is on: one of [`enable`].
    pub fn is_enabled(&self, bit: i32) -> bool {
        self.opt.enabled(bit)
    }

    /// Switches an optional part on or off: one of [`enable`].
    pub fn set_enabled(&mut self, bit: i32, on: bool) {
        let supported = bit & (2 * enable::IPC - 1);
        let flags = self.edit().opt.enableflags;
        *flags = if on { *flags | supported } else { *flags & !supported };
    }
}

/// An id that a name led to.
macro_rules! ids {
    ($($(#[$doc:meta])* $id:ident $kind:ident $get:ident $of:ident $count:ident;)*) => {
        $(
            $(#[$doc])*
            #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
            pub struct $id(pub(super) usize);

            impl $id {
                /// The number that MuJoCo's arrays are indexed by.
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
    /// A body; the world is the first.
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
    /// The places of its values in `sensordata`.
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
