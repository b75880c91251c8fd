//! Objects by name: their positions, velocities and values.

use super::data::{Data, Full};
use super::error::Error;
use super::model::{ActuatorId, BodyId, GeomId, JointId, Model, SensorId, SiteId, TendonId, find};
use crate::math::rows;
use crate::model::{Names, Obj};

/// The name of an object, or its typed id.
pub trait ObjectKey<I> {
    /// The index of the object. An unknown name is an error.
    fn find_in(&self, names: &Names) -> Result<usize, Error>;
}

/// A matrix of three rows and three columns, such as a rotation matrix.
pub type Rows3 = [[f64; 3]; 3];

fn three_rows(m: &[f64; 9]) -> Rows3 {
    std::array::from_fn(|r| std::array::from_fn(|c| m[3 * r + c]))
}

macro_rules! objects {
    ($($(#[$doc:meta])* $view:ident $id:ident $kind:ident $get:ident $list:ident $noun:literal {
        $($(#[$fdoc:meta])* $field:ident -> $ret:ty = |$s:ident| $value:expr;)*
    })*) => { $(
        impl ObjectKey<$id> for str {
            fn find_in(&self, names: &Names) -> Result<usize, Error> {
                find(names, Obj::$kind, self)
            }
        }
        impl ObjectKey<$id> for $id {
            fn find_in(&self, names: &Names) -> Result<usize, Error> {
                let count = names.of_kind(Obj::$kind).len();
                if self.0 < count { Ok(self.0) } else { Err(Error::NoId { kind: $noun, id: self.0, count }) }
            }
        }

        $(#[$doc])*
        #[derive(Clone, Copy, Debug)]
        pub struct $view<'a> {
            data: &'a Data<Full>,
            id: usize,
        }

        impl<'a> $view<'a> {
            /// The id of the object.
            pub fn id(&self) -> $id {
                $id(self.id)
            }

            /// The name of the object, empty if it has none.
            pub fn name(&self) -> &'a str {
                self.data.names.of_kind(Obj::$kind).get(self.id).map_or("", |n| n.as_str())
            }

            $($(#[$fdoc])* pub fn $field(&self) -> $ret {
                let $s = self;
                $value
            })*
        }

        impl Data<Full> {
            #[doc = concat!("A ", $noun, " by its name or id.")]
            pub fn $get(&self, which: &(impl ObjectKey<$id> + ?Sized)) -> Result<$view<'_>, Error> {
                Ok($view { data: self, id: which.find_in(&self.names)? })
            }
        }
    )* };
}

/// Row `id` of an array of the data, or zeros if there is no such row.
fn row<const N: usize>(list: &[f64], id: usize) -> [f64; N] {
    rows::<N>(list).get(id).copied().unwrap_or([0.0; N])
}

fn mat(list: &[f64], id: usize) -> Rows3 {
    three_rows(&row::<9>(list, id))
}

objects! {
    /// A body of a simulation.
    Body BodyId Body body bodies "body" {
        /// Position of its frame, m, world.
        xpos -> [f64; 3] = |s| row(&s.data.xpos, s.id);
        /// Orientation of its frame as a quaternion w x y z, world.
        xquat -> [f64; 4] = |s| row(&s.data.xquat, s.id);
        /// Orientation of its frame, world.
        xmat -> Rows3 = |s| mat(&s.data.xmat, s.id);
        /// Its centre of mass, m, world.
        xipos -> [f64; 3] = |s| row(&s.data.xipos, s.id);
        /// Orientation of its principal axes of inertia, world.
        ximat -> Rows3 = |s| mat(&s.data.ximat, s.id);
        /// Centre of mass of the body and all its descendants, m, world.
        subtree_com -> [f64; 3] = |s| row(&s.data.subtree_com, s.id);
        /// External force and torque that are applied to the body, N and N m, world.
        xfrc_applied -> [f64; 6] = |s| row(&s.data.xfrc_applied, s.id);
    }
    /// A joint of a simulation.
    Joint JointId Joint joint joints "joint" {
        /// Its anchor, m, world.
        xanchor -> [f64; 3] = |s| row(&s.data.xanchor, s.id);
        /// Its axis, world.
        xaxis -> [f64; 3] = |s| row(&s.data.xaxis, s.id);
    }
    /// A geom of a simulation.
    Geom GeomId Geom geom geoms "geom" {
        /// Its position, m, world.
        xpos -> [f64; 3] = |s| row(&s.data.geom_xpos, s.id);
        /// Its orientation, world.
        xmat -> Rows3 = |s| mat(&s.data.geom_xmat, s.id);
    }
    /// A site of a simulation.
    Site SiteId Site site sites "site" {
        /// Its position, m, world.
        xpos -> [f64; 3] = |s| row(&s.data.site_xpos, s.id);
        /// Its orientation, world.
        xmat -> Rows3 = |s| mat(&s.data.site_xmat, s.id);
    }
    /// A tendon of a simulation.
    Tendon TendonId Tendon tendon tendons "tendon" {
        /// Its length, m.
        length -> f64 = |s| s.data.ten_length.get(s.id).copied().unwrap_or(0.0);
        /// The rate of change of the length, m/s.
        velocity -> f64 = |s| s.data.ten_velocity.get(s.id).copied().unwrap_or(0.0);
    }
    /// An actuator of a simulation.
    Actuator ActuatorId Actuator actuator actuators "actuator" {
        /// The force of its first output, N or N m.
        force -> f64 = |s| s.data.actuator_force.get(s.output()).copied().unwrap_or(0.0);
        /// The length of its first output, m or rad.
        length -> f64 = |s| s.data.actuator_length.get(s.output()).copied().unwrap_or(0.0);
        /// The rate of change of that length, m/s or rad/s.
        velocity -> f64 = |s| s.data.actuator_velocity.get(s.output()).copied().unwrap_or(0.0);
    }
    /// A sensor of a simulation.
    Sensor SensorId Sensor sensor sensors "sensor" {
        /// The values of the sensor, in its own unit.
        values -> &'a [f64] = |s| {
            let [first, n] = s.data.addresses.sensor.get(s.id).copied().unwrap_or_default();
            s.data.sensordata.get(first..first + n).unwrap_or_default()
        };
    }
}

impl Actuator<'_> {
    fn output(&self) -> usize {
        self.data.addresses.output.get(self.id).copied().unwrap_or(usize::MAX)
    }

    /// The controls of the actuator.
    pub fn ctrl(&self) -> &[f64] {
        let [first, n] = self.data.addresses.ctrl.get(self.id).copied().unwrap_or_default();
        self.data.ctrl.get(first..first + n).unwrap_or_default()
    }
}

impl<'a> Joint<'a> {
    /// The coordinates of the joint. A free joint has x y z qw qx qy qz, a ball joint a quaternion, a slide or hinge one number.
    pub fn qpos(&self) -> &'a [f64] {
        let [first, n] = self.data.addresses.qpos.get(self.id).copied().unwrap_or_default();
        self.data.qpos.get(first..first + n).unwrap_or_default()
    }

    /// The velocities of the joint. A free joint has three of translation and three of rotation.
    pub fn qvel(&self) -> &'a [f64] {
        let [first, n] = self.data.addresses.qvel.get(self.id).copied().unwrap_or_default();
        self.data.qvel.get(first..first + n).unwrap_or_default()
    }
}

fn set(to: Option<&mut [f64]>, values: &[f64], what: &'static str) -> Result<(), Error> {
    let to = to.unwrap_or_default();
    if to.len() != values.len() {
        return Err(Error::Length { what, expected: to.len(), found: values.len() });
    }
    to.copy_from_slice(values);
    Ok(())
}

impl<S: super::data::Scope> Data<S> {
    /// Sets the coordinates of a joint.
    pub fn set_joint_qpos(
        &mut self,
        which: &(impl ObjectKey<JointId> + ?Sized),
        qpos: &[f64],
    ) -> Result<(), Error> {
        let [first, n] = self.addresses.qpos.get(which.find_in(&self.names)?).copied().unwrap_or_default();
        set(self.fields.qpos.get_mut(first..first + n), qpos, "the position of this joint")
    }

    /// Sets the velocities of a joint.
    pub fn set_joint_qvel(
        &mut self,
        which: &(impl ObjectKey<JointId> + ?Sized),
        qvel: &[f64],
    ) -> Result<(), Error> {
        let [first, n] = self.addresses.qvel.get(which.find_in(&self.names)?).copied().unwrap_or_default();
        set(self.fields.qvel.get_mut(first..first + n), qvel, "the velocity of this joint")
    }

    /// Sets the controls of an actuator. Most actuators have one.
    pub fn set_ctrl(
        &mut self,
        which: &(impl ObjectKey<ActuatorId> + ?Sized),
        ctrl: &[f64],
    ) -> Result<(), Error> {
        let [first, n] = self.addresses.ctrl.get(which.find_in(&self.names)?).copied().unwrap_or_default();
        set(self.fields.ctrl.get_mut(first..first + n), ctrl, "the control of this actuator")
    }

    /// Applies a force and a torque at the centre of mass of a body, N and N m, world. They act until they are set again.
    pub fn set_xfrc(
        &mut self,
        which: &(impl ObjectKey<BodyId> + ?Sized),
        force: [f64; 6],
    ) -> Result<(), Error> {
        let first = 6 * which.find_in(&self.names)?;
        let fields = self.edit();
        set(fields.xfrc_applied.get_mut(first..first + 6), &force, "a force and a torque")
    }
}

impl Model {
    /// The name of an object of a kind, or `None` if there is no such object.
    pub fn name_of(&self, kind: Obj, id: usize) -> Option<&str> {
        self.names.of_kind(kind).get(id).map(String::as_str)
    }
}
