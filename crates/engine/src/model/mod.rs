//! `Model`: the data that do not change during a simulation. The structs are generated from the field table.

pub mod asleep;
pub(crate) mod bytes;
pub(crate) mod data_fields;
pub mod extents;
pub mod fields;
pub mod index;
pub(crate) mod meter;
pub mod plan;
pub mod reflect;
pub(crate) mod sensed;
pub mod stage;
pub mod state;
pub mod stopwatch;
pub mod texture;
pub mod tree_algorithm;

pub use data_fields::Fields;
pub use data_fields::{Contact, Warning, WarningStat};
pub use plan::Decision;
pub(crate) use plan::PlanTable;

use crate::kinds::{cone, integrator, jacobian, solver};
use crate::model::fields::{model_fields, option_fields, statistic_fields};
use std::ops::Range;

macro_rules! define {
    ($(#[$meta:meta])* $struct:ident { $($extra:tt)* }
     $($name:ident: $ty:ty, [$($dim:tt),*], $kind:ident, $stage:ident, $unit:literal, $doc:literal;)*) => {
        $(#[$meta])*
        #[derive(Clone, Debug, PartialEq)]
        pub struct $struct {
            $(#[doc = $doc] pub $name: $ty,)*
            $($extra)*
        }
    };
}
pub(crate) use define;

/// A struct of the table with every number zero.
macro_rules! zero {
    ($struct:ident $($name:ident: $ty:ty, [$($dim:tt),*], $kind:ident, $stage:ident, $unit:literal, $doc:literal;)*) => {
        $struct { $($name: Default::default(),)* }
    };
}

macro_rules! define_model {
    ($($rows:tt)*) => { define! {
        #[derive(Default)]
        /// A compiled model: sizes, constants, options and names, field by field as MuJoCo's `mjModel`.
        #[allow(non_snake_case)] // MuJoCo's names: dof_M0, M_rowadr, nC
        Model {
            /// Options of the simulation.
            pub opt: Options,
            /// Statistics.
            pub stat: Statistic,
            /// Names of the objects.
            pub names: Names,
            /// Declarations of the textures, in the order of `names.texture`.
            pub textures: Vec<texture::Texture>,
            /// Custom texts, in the order of `names.text`.
            pub texts: Vec<String>,
            /// The bodies of each exclusion, the smaller first, in ascending order. Needed because signatures are ambiguous for
            /// large ids.
            pub exclude_bodies: Vec<[i32; 2]>,
            /// The geoms without contact bits when the model was compiled, in ascending order. The tree of bounding volumes of
            /// their body is built without them and does not change later.
            pub visual_geoms: Vec<i32>,
            /// The trees that were long planar chains of hinges when the model was compiled, in ascending order.
            pub planar_trees: Vec<i32>,
            /// Flat faces of the hull of each mesh. Their normals are more accurate than the vertices.
            pub mesh_sides: Vec<crate::geometry::HullFaces>,
        }
        $($rows)*
    } };
}
macro_rules! define_options {
    ($($rows:tt)*) => { define! {
        /// Options of the simulation, `model.opt`. The default is that of MuJoCo 3.14.0.
        Options {}
        $($rows)*
    }
    impl Options {
        /// Options with every number zero.
        fn zero() -> Options {
            zero! { Options $($rows)* }
        }
    } };
}
macro_rules! define_statistic {
    ($($rows:tt)*) => { define! {
        #[derive(Default)]
        /// Statistics of the model, `model.stat`.
        Statistic {}
        $($rows)*
    } };
}
model_fields!(define_model);
option_fields!(define_options);
statistic_fields!(define_statistic);

impl Default for Options {
    fn default() -> Options {
        Options {
            timestep: 0.002,
            impratio: 1.0,
            tolerance: 1e-8,
            ls_tolerance: 0.01,
            noslip_tolerance: 1e-6,
            ccd_tolerance: 1e-6,
            sleep_tolerance: 1e-3,
            gravity: [0.0, 0.0, -9.81],
            magnetic: [0.0, -0.5, 0.0],
            o_solref: [0.02, 1.0],
            o_solimp: [0.9, 0.95, 0.001, 0.5, 2.0],
            o_friction: [1.0, 1.0, 0.005, 0.0001, 0.0001],
            integrator: integrator::EULER,
            cone: cone::PYRAMIDAL,
            jacobian: jacobian::AUTO,
            solver: solver::NEWTON,
            iterations: 100,
            ls_iterations: 50,
            ccd_iterations: 35,
            sdf_initpoints: 40,
            sdf_iterations: 10,
            // The other options are zero: no wind, a vacuum, no flags.
            ..Options::zero()
        }
    }
}

impl Options {
    /// Whether a part of the simulation is disabled; `bit` is one of `disable`.
    pub fn disabled(&self, bit: i32) -> bool {
        self.disableflags & bit != 0
    }

    /// Whether an optional part is enabled; `bit` is one of `enable`.
    pub fn enabled(&self, bit: i32) -> bool {
        self.enableflags & bit != 0
    }
}

impl Model {
    /// The degrees of freedom of a tree.
    #[cfg_attr(not(feature = "small"), inline(always))]
    pub(crate) fn tree_dofs(&self, tree: usize) -> Range<usize> {
        let first = self.tree_dofadr[tree] as usize;
        first..first + self.tree_dofnum[tree] as usize
    }
}

/// Object kinds with named objects: kind, MuJoCo's number, the list of names, MuJoCo's prefix (`jnt` of `njnt`).
macro_rules! objects {
    ($($kind:ident = $number:literal, $list:ident, $prefix:literal;)*) => {
        /// Kinds of named objects, with MuJoCo's numbers (mjtObj).
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
        #[allow(missing_docs)] // the object kinds
        pub enum Obj {
            Body = 1,
            /// A body's own frame, whereas `Body` is its inertial frame.
            XBody = 2,
            /// A degree of freedom. It has no name.
            Dof = 4,
            $($kind = $number,)*
        }

        impl Obj {
            /// The kinds whose objects can have names, with MuJoCo's prefixes (`jnt` of `njnt` and `jnt_type`).
            pub const PREFIXES: &[(&str, Obj)] = &[("body", Obj::Body), $(($prefix, Obj::$kind)),*];

            /// The kind with a prefix, if there is one.
            pub fn from_prefix(prefix: &str) -> Option<Obj> {
                Obj::PREFIXES.iter().find(|(name, _)| *name == prefix).map(|(_, kind)| *kind)
            }
        }

        /// Names by object kind, in id order; an object without a name has the empty string.
        #[derive(Clone, Debug, Default, PartialEq)]
        #[allow(missing_docs)] // one list per object kind
        pub struct Names {
            pub model: String,
            pub body: Vec<String>,
            $(pub $list: Vec<String>,)*
        }

        impl Names {
            /// The lists of names, one for each kind.
            pub(crate) fn lists(&self) -> impl Iterator<Item = &Vec<String>> {
                [&self.body, $(&self.$list),*].into_iter()
            }

            /// Like [`Names::lists`], for writing.
            pub(crate) fn lists_mut(&mut self) -> impl Iterator<Item = &mut Vec<String>> {
                [&mut self.body, $(&mut self.$list),*].into_iter()
            }

            /// All names of one kind.
            pub fn of_kind(&self, kind: Obj) -> &[String] {
                match kind {
                    Obj::Body | Obj::XBody => &self.body,
                    Obj::Dof => &[],
                    $(Obj::$kind => &self.$list,)*
                }
            }
        }
    };
}
objects! {
    Joint = 3, joint, "jnt";
    Geom = 5, geom, "geom";
    Site = 6, site, "site";
    Camera = 7, camera, "cam";
    Light = 8, light, "light";
    Mesh = 10, mesh, "mesh";
    Skin = 11, skin, "skin";
    HField = 12, hfield, "hfield";
    Texture = 13, texture, "tex";
    Material = 14, material, "mat";
    Pair = 15, pair, "pair";
    Exclude = 16, exclude, "exclude";
    Equality = 17, equality, "eq";
    Tendon = 18, tendon, "tendon";
    Actuator = 19, actuator, "actuator";
    Sensor = 20, sensor, "sensor";
    Numeric = 21, numeric, "numeric";
    Text = 22, text, "text";
    Tuple = 23, tuple, "tuple";
    Key = 24, key, "key";
}

impl Names {
    /// The id of a named object (`mj_name2id`), or `None` if there is no such name.
    pub fn id(&self, kind: Obj, name: &str) -> Option<usize> {
        if name.is_empty() {
            return None;
        }
        self.of_kind(kind).iter().position(|n| n == name)
    }
}
