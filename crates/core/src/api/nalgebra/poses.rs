//! Poses and velocities of bodies, geoms and sites.

use crate::api::data::{Data, Scope};
use crate::api::error::Error;
use crate::api::model::{BodyId, GeomId, Model, SiteId};
use crate::api::view::ObjectKey;
use crate::dynamics::object;
use crate::math::rows;
use crate::model::Obj;
use crate::model::reflect::data;
use nalgebra::{Isometry3, Matrix3, Quaternion, Rotation3, Translation3, UnitQuaternion, Vector3, Vector6};

/// The tolerance of the squared norm of a quaternion or axis from 1. Rounding errors are about 1e-15. Data that are not yet
/// computed contain zeros.
const UNIT: f64 = 1e-6;

fn not_computed() -> Error {
    Error::Value { what: "a pose", must: "computed before it is read: call `forward` or `kinematics`" }
}

fn position(list: &[f64], id: usize) -> Option<Translation3<f64>> {
    rows::<3>(list).get(id).map(|&p| Translation3::from(Vector3::from(p)))
}

fn by_quaternion(positions: &[f64], quaternions: &[f64], id: usize) -> Result<Isometry3<f64>, Error> {
    let quaternion = rows::<4>(quaternions).get(id).map(|&[w, x, y, z]| Quaternion::new(w, x, y, z));
    let unit = quaternion.filter(|q| (q.norm_squared() - 1.0).abs() < UNIT);
    let parts = position(positions, id).zip(unit.map(UnitQuaternion::new_unchecked));
    parts.map(|(origin, turn)| Isometry3::from_parts(origin, turn)).ok_or_else(not_computed)
}

fn by_matrix(positions: &[f64], matrices: &[f64], id: usize) -> Result<Isometry3<f64>, Error> {
    let matrix = rows::<9>(matrices).get(id).map(|r| Matrix3::from_row_slice(r));
    let rotation = matrix.filter(|r| (r.norm_squared() / 3.0 - 1.0).abs() < UNIT);
    let unit = rotation.map(|r| UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(r)));
    let parts = position(positions, id).zip(unit);
    parts.map(|(origin, turn)| Isometry3::from_parts(origin, turn)).ok_or_else(not_computed)
}

impl<S: Scope> Data<S> {
    /// The pose of a body's frame, m, world: `xpos` and `xquat`. It maps points from the body frame to the world.
    ///
    /// # Errors
    ///
    /// There is no such body, the plan left `xpos` or `xquat` out, or nothing is computed yet.
    pub fn body_pose(&self, which: &(impl ObjectKey<BodyId> + ?Sized)) -> Result<Isometry3<f64>, Error> {
        self.has(&[data::xpos, data::xquat])?;
        let d = self.fields();
        by_quaternion(&d.xpos, &d.xquat, which.find_in(&self.names)?)
    }

    /// The pose of a body's centre of mass and principal axes of inertia, m, world: `xipos` and `ximat`.
    ///
    /// # Errors
    ///
    /// As for [`Data::body_pose`].
    pub fn body_inertial_pose(
        &self,
        which: &(impl ObjectKey<BodyId> + ?Sized),
    ) -> Result<Isometry3<f64>, Error> {
        self.has(&[data::xipos, data::ximat])?;
        let d = self.fields();
        by_matrix(&d.xipos, &d.ximat, which.find_in(&self.names)?)
    }

    /// The pose of a geom, m, world: `geom_xpos` and `geom_xmat`.
    ///
    /// # Errors
    ///
    /// As for [`Data::body_pose`].
    pub fn geom_pose(&self, which: &(impl ObjectKey<GeomId> + ?Sized)) -> Result<Isometry3<f64>, Error> {
        self.has(&[data::geom_xpos, data::geom_xmat])?;
        let d = self.fields();
        by_matrix(&d.geom_xpos, &d.geom_xmat, which.find_in(&self.names)?)
    }

    /// The pose of a site, m, world: `site_xpos` and `site_xmat`.
    ///
    /// # Errors
    ///
    /// As for [`Data::body_pose`].
    pub fn site_pose(&self, which: &(impl ObjectKey<SiteId> + ?Sized)) -> Result<Isometry3<f64>, Error> {
        self.has(&[data::site_xpos, data::site_xmat])?;
        let d = self.fields();
        by_matrix(&d.site_xpos, &d.site_xmat, which.find_in(&self.names)?)
    }
}

/// The velocity of an object: the linear velocity of its origin, and its angular velocity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Velocity {
    /// Angular velocity, rad/s.
    pub angular: Vector3<f64>,
    /// Velocity of the origin of its frame, m/s.
    pub linear: Vector3<f64>,
}

impl Velocity {
    /// Both velocities in one vector, angular first, as in `cvel` and `mj_objectVelocity`.
    pub fn to_vector6(&self) -> Vector6<f64> {
        let (w, v) = (self.angular, self.linear);
        Vector6::new(w.x, w.y, w.z, v.x, v.y, v.z)
    }
}

macro_rules! velocities {
    ($($(#[$doc:meta])* $name:ident $id:ident $kind:ident [$($needs:ident)*];)*) => { $(
        $(#[$doc])*
        ///
        /// The result is in world axes, or in the axes of the object if `local` is set.
        ///
        /// # Errors
        ///
        /// The data belong to another model, there is no such object, or the plan left out the fields from which the velocity is
        /// computed.
        pub fn $name<S: Scope>(
            m: &Model,
            d: &Data<S>,
            which: &(impl ObjectKey<$id> + ?Sized),
            local: bool,
        ) -> Result<Velocity, Error> {
            d.belongs_to(m)?;
            d.has(&[data::cvel, data::subtree_com, $(data::$needs),*])?;
            let id = which.find_in(&d.names)?;
            let [wx, wy, wz, x, y, z] = object::object_velocity(m, &d.fields, Obj::$kind, id, local);
            Ok(Velocity { angular: Vector3::new(wx, wy, wz), linear: Vector3::new(x, y, z) })
        }
    )* };
}
velocities! {
    /// The velocity of a body's frame.
    body_velocity BodyId XBody [xpos xmat];
    /// The velocity of a geom's frame.
    geom_velocity GeomId Geom [geom_xpos geom_xmat];
    /// The velocity of a site's frame.
    site_velocity SiteId Site [site_xpos site_xmat];
}
