//! MuJoCo's functions for embedders. Each call checks its arguments once, and no call panics.
//!
//! A call is an error, and changes nothing, if the data belong to another model, if an id or a length does not fit, or if it
//! needs results that the plan left out.

mod mass_matrix;
mod saved_data;
mod spatial_queries;
mod state_vectors;
mod work;

use super::data::{Data, Scope};
use super::error::Error;
use super::model::{KeyId, Model};
use super::planning::Plan;
use crate::constraint;
use crate::dynamics::{self, jacobian, object, rne as newton_euler, subtree, tree_algorithms};
use crate::forces::{actuation, energy};
use crate::kinds::integrator;
use crate::math::{Spatial, Vec3};
use crate::model::plan::PlanFlag;
use crate::model::reflect::{self, FieldId, Object, View, ViewMut, data};
use crate::model::{Contact, Obj};
use crate::sensor::body_force;
use crate::setup::setconst;
use crate::step::balance::{self, Energy};
use crate::step::{self, deciding, integrate, reset};

pub use crate::dynamics::jacobian::Jacobian;
pub use mass_matrix::*;
pub use spatial_queries::*;
pub use work::*;

fn check_length(what: &'static str, expected: usize, found: usize) -> Result<(), Error> {
    if expected == found { Ok(()) } else { Err(Error::Length { what, expected, found }) }
}

fn exists(kind: &'static str, id: usize, count: usize) -> Result<(), Error> {
    if id < count { Ok(()) } else { Err(Error::NoId { kind, id, count }) }
}

/// Functions that take the model and all of the data. Some compute everything, others a part.
macro_rules! passes {
    ($($(#[$doc:meta])* $name:ident $engine:ident [$($needs:ident)*] |$m:ident, $d:ident, $s:tt| $call:expr;)*) => { $(
        $(#[$doc])*
        pub fn $name<S: Scope>(m: &Model, d: &mut Data<S>) -> Result<(), Error> {
            d.has(&[$(data::$needs),*])?;
            let ($m, ($d, $s)) = (m, d.$engine(m)?);
            $call;
            Ok(())
        }
    )* };
}
passes! {
    /// Advances the simulation by one step (`mj_step`).
    ///
    /// A bad number in the state resets the data before the step. A bad number in the acceleration resets the data, and the same
    /// step then starts from the reset state. `warning` records the kind of bad number and when it occurred.
    ///
    /// ```
    /// # fn main() -> Result<(), labspec_core::Error> {
    /// use labspec_core::{Data, Model, step};
    /// let model = Model::from_xml(
    ///     "<mujoco><worldbody><body><joint name='swing' axis='0 1 0'/><geom name='bob' pos='1 0 0' size='0.1'/></body></worldbody></mujoco>",
    /// )?;
    /// let mut data = Data::new(&model);
    /// while data.time < 1.0 {
    ///     step(&model, &mut data)?;
    /// }
    /// assert!(data.joint("swing")?.qpos()[0] > 0.0 && data.geom("bob")?.xpos()[2] < 0.0);
    /// # Ok(())
    /// # }
    /// ```
    step engine_for_pass [] |m, d, s| step::step(m, d, s);
    /// The first part of a step (`mj_step1`): everything that does not depend on inputs. Controls and applied forces may be set
    /// between the two parts.
    ///
    /// A user's controller reads the state after the first part and sets controls before the second:
    ///
    /// ```
    /// # fn main() -> Result<(), labspec_core::Error> {
    /// use labspec_core::{Data, Model, step1, step2};
    /// let model = Model::from_xml(
    ///     "<mujoco><worldbody><body><joint name='j' type='slide'/><geom size='0.1'/></body></worldbody>
    ///      <option gravity='0 0 0'/><actuator><motor name='push' joint='j'/></actuator></mujoco>",
    /// )?;
    /// let mut data = Data::new(&model);
    /// data.set_joint_qpos("j", &[0.1])?;
    /// for _ in 0..5000 {
    ///     step1(&model, &mut data)?;
    ///     let (x, v) = (data.qpos[0], data.qvel[0]);
    ///     data.set_ctrl("push", &[-40.0 * x - 20.0 * v])?;
    ///     step2(&model, &mut data)?;
    /// }
    /// assert!(data.qpos[0].abs() < 1e-6);
    /// # Ok(())
    /// # }
    /// ```
    step1 engine [] |m, d, s| step::step1(m, d, s);
    /// The second part of a step (`mj_step2`): forces, accelerations, the next state. Runge–Kutta methods need forces at other
    /// states; if the options name one, this function makes a semi-implicit Euler step.
    step2 engine [] |m, d, s| step::step2(m, d, s);
    /// Computes all results for the current state, without advancing time (`mj_forward`).
    forward engine_for_pass [] |m, d, s| step::forward::forward(m, d, s);
    /// Resets state, inputs, results and warnings to the default configuration (`mj_resetData`). Edits of the model stay.
    reset_data engine_for_pass [] |m, d, s| reset::reset_data(m, d, s);
    /// Poses of bodies, joints, geoms and sites (`mj_kinematics`).
    kinematics engine [] |m, d, s| dynamics::kinematics(m, d, &mut s.dynamics);
    /// Computes all results that depend on positions: poses, M, contacts, the sensors of the first stage (`mj_fwdPosition`).
    fwd_position engine [] |m, d, s| step::forward::position(m, d, s);
    /// Computes all results that depend on velocities (`mj_fwdVelocity`). The results that depend on positions must be computed
    /// already.
    fwd_velocity engine [] |m, d, s| step::forward::velocity(m, d, s);
    /// Computes the contacts of the geoms at their current poses (`mj_collision`).
    collision engine [] |m, d, s| step::forward::contacts(m, d, s);
    /// `energy[0]`: the potential energy of gravity and springs, J (`mj_energyPos`). That of gravity is zero if every centre of
    /// mass is at the origin.
    energy_pos engine [xipos] |m, d, _| energy::potential(m, d);
    /// `energy[1]` = ½ vᵀ M v, J (`mj_energyVel`).
    energy_vel engine [M] |m, d, _| energy::kinetic(m, d);
    /// Momentum of subtrees (`mj_subtreeVel`): `subtree_linvel`, `subtree_angmom`.
    subtree_vel engine [cvel] |m, d, _| subtree::subtree_vel(m, d);
    /// `cacc`, `cfrc_ext`, `cfrc_int`; needs `qacc` and the forces of constraints (`mj_rnePostConstraint`).
    rne_post_constraint engine [cvel cinert] |m, d, _| body_force::rne_post_constraint(m, d);
}

/// Resets the data to a keyframe (`mj_resetDataKeyframe`).
///
/// ```
/// # fn main() -> Result<(), labspec_core::Error> {
/// use labspec_core::{Data, Model, reset_data_keyframe};
/// let model = Model::from_xml(
///     "<mujoco><worldbody><body><joint name='j'/><geom size='0.1'/></body></worldbody>
///      <keyframe><key name='up' qpos='1.5'/></keyframe></mujoco>",
/// )?;
/// let mut data = Data::new(&model);
/// reset_data_keyframe(&model, &mut data, model.key("up")?)?;
/// assert_eq!(data.qpos[0], 1.5);
/// # Ok(())
/// # }
/// ```
pub fn reset_data_keyframe<S: Scope>(m: &Model, d: &mut Data<S>, key: KeyId) -> Result<(), Error> {
    exists("keyframe", key.index(), m.nkey)?;
    let (fields, scratch) = d.engine_for_pass(m)?;
    reset::reset_data_keyframe(m, fields, scratch, key.index());
    // A keyframe contains controls.
    d.touched = !S::FULL;
    Ok(())
}

/// Stores the time, the state and the inputs in a keyframe (`mj_setKeyframe`).
pub fn set_keyframe<S: Scope>(m: &mut Model, d: &Data<S>, key: KeyId) -> Result<(), Error> {
    d.belongs_to(m)?;
    exists("keyframe", key.index(), m.nkey)?;
    reset::set_keyframe(m.engine(), &d.fields, key.index());
    Ok(())
}

/// Computes constants that depend on masses, inertias and poses (`mj_setConst`), in the default configuration. Sets `qpos` to
/// that configuration; velocities and time do not change.
pub fn set_const<S: Scope>(m: &mut Model, d: &mut Data<S>) -> Result<(), Error> {
    d.engine(m)?;
    let before = deciding::constants(m).map(<[i32]>::to_vec);
    setconst::set_const(m.engine(), &mut d.fields, &mut d.scratch);
    m.touch_constants();
    d.mark_synced(m);
    // If M was constant when the plan was made, the plan does not compute it again. Other plans assumed the constants that have
    // now changed.
    let plan = &d.fields.plan;
    let constant = plan.has(PlanFlag::General) || tree_algorithms::are_constant(m.engine(), plan.algorithms);
    if !constant || d.assumes_values() && deciding::constants(m) != before.each_ref().map(Vec::as_slice) {
        d.plan_again(m);
    }
    Ok(())
}

/// Replaces the plan, which determines what the next forward pass computes.
pub fn set_plan(m: &Model, d: &mut Data<super::data::Planned>, plan: Plan) -> Result<(), Error> {
    d.replan(m, plan)
}

/// Computes `qfrc_inverse` from `qpos`, `qvel` and `qacc` (`mj_inverse`): the force that actuators or external forces must apply
/// to cause this acceleration. With the flag `invdiscrete`, `qacc` is (v⁺ - v)/h of a step instead.
///
/// All fields of position and velocity, the constraint forces and the sensors are computed, whatever the plan contains.
///
/// ```
/// # fn main() -> Result<(), labspec_core::Error> {
/// use labspec_core::{Data, Model, inverse};
/// let model = Model::from_xml(
///     "<mujoco><worldbody><body><joint type='slide' axis='0 0 1'/><geom mass='2' size='0.1'/></body></worldbody></mujoco>",
/// )?;
/// let mut data = Data::new(&model);
/// data.set_qacc(&[1.0])?;
/// inverse(&model, &mut data)?;
/// assert!((data.qfrc_inverse[0] - 2.0 * (9.81 + 1.0)).abs() < 1e-12);
/// # Ok(())
/// # }
/// ```
pub fn inverse<S: Scope>(m: &Model, d: &mut Data<S>) -> Result<(), Error> {
    let (d, s) = d.engine(m)?;
    Ok(step::inverse::inverse(m, d, s)?)
}

/// The generalized force (nv) that causes the acceleration `qacc` (nv). Without `qacc`, the sum of gravity, Coriolis and
/// centrifugal forces (`mj_rne`). The armature of joints is not included.
///
/// The position and velocity stages must be computed before.
pub fn rne<S: Scope>(m: &Model, d: &mut Data<S>, qacc: Option<&[f64]>) -> Result<Vec<f64>, Error> {
    d.has(&[data::cdof, data::cdof_dot, data::cinert, data::cvel])?;
    if let Some(a) = qacc {
        check_length("an acceleration", m.nv, a.len())?;
    }
    let mut out = vec![0.0; m.nv];
    let (d, s) = d.engine(m)?;
    newton_euler::rne(m, d, &mut s.dynamics, qacc, &mut out);
    Ok(out)
}

/// Force and torque of a contact in the contact frame, N and N m: normal, two tangents, then three torques (`mj_contactForce`).
/// Zero if the contact has no constraint rows.
///
/// ```
/// # fn main() -> Result<(), labspec_core::Error> {
/// use labspec_core::{Data, Model, contact_force, step};
/// let model = Model::from_xml(
///     "<mujoco><worldbody><geom type='plane' size='1 1 1'/>
///      <body pos='0 0 0.1'><freejoint/><geom size='0.1' mass='3'/></body></worldbody></mujoco>",
/// )?;
/// let mut data = Data::new(&model);
/// for _ in 0..1000 {
///     step(&model, &mut data)?;
/// }
/// let [normal, ..] = contact_force(&model, &data, &data.contact[0])?;
/// assert!((normal - 3.0 * 9.81).abs() < 1e-6);
/// # Ok(())
/// # }
/// ```
pub fn contact_force<S: Scope>(m: &Model, d: &Data<S>, contact: &Contact) -> Result<[f64; 6], Error> {
    d.belongs_to(m)?;
    d.has(&[data::efc_force])?;
    Ok(constraint::contact_force(m, &d.fields, contact))
}

/// The fields of the data from which the Jacobian of a point is computed.
pub const JACOBIAN_READS: [FieldId; 4] = [data::xanchor, data::xaxis, data::xmat, data::xpos];

/// Functions that return a Jacobian, one for each kind of object.
macro_rules! jacobians {
    ($($(#[$doc:meta])* $name:ident($($arg:ident: $ty:ty),*) $id:ident $noun:literal $count:ident [$($needs:ident)*] -> $ret:ty = $call:path;)*) => { $(
        $(#[$doc])*
        pub fn $name<S: Scope>(m: &Model, d: &Data<S>, $($arg: $ty,)* $id: usize) -> Result<$ret, Error> {
            d.belongs_to(m)?;
            d.has(&JACOBIAN_READS)?;
            d.has(&[$(data::$needs),*])?;
            exists($noun, $id, m.$count)?;
            $call(m, &d.fields, $($arg,)* $id).ok_or(Error::NoId { kind: $noun, id: $id, count: m.$count })
        }
    )* };
}
jacobians! {
    /// The Jacobian of a point of a body, given in world coordinates, m (`mj_jac`).
    jac(point: Vec3) body "body" nbody [] -> Jacobian = jacobian::jac;
    /// The Jacobian of the frame of a body (`mj_jacBody`).
    jac_body() body "body" nbody [] -> Jacobian = jacobian::jac_body;
    /// The Jacobian of a body's centre of mass (`mj_jacBodyCom`).
    jac_body_com() body "body" nbody [xipos] -> Jacobian = jacobian::jac_body_com;
    /// The Jacobian of the frame of a geom (`mj_jacGeom`).
    jac_geom() geom "geom" ngeom [geom_xpos] -> Jacobian = jacobian::jac_geom;
    /// The Jacobian of the frame of a site (`mj_jacSite`).
    jac_site() site "site" nsite [site_xpos] -> Jacobian = jacobian::jac_site;
    /// `[3, nv]`: the Jacobian of the centre of mass of a body and all its descendants (`mj_jacSubtreeCom`).
    jac_subtree_com() body "body" nbody [xipos] -> Vec<f64> = jacobian::jac_subtree_com;
    /// The time derivative of the Jacobian of a point that moves with a body (`mj_jacDot`): the acceleration of the point is
    /// J q̈ + J̇ q̇.
    jac_dot(point: Vec3) body "body" nbody [cvel cdof cdof_dot] -> Jacobian = jacobian::jac_dot;
}

/// Adds to `qfrc` (nv) the generalized force of a force, N, at a point of a body, and of a torque, N m, all in world axes
/// (`mj_applyFT`).
pub fn apply_ft<S: Scope>(
    m: &Model,
    d: &Data<S>,
    [force, torque]: [Vec3; 2],
    point: Vec3,
    body: usize,
    qfrc: &mut [f64],
) -> Result<(), Error> {
    d.belongs_to(m)?;
    d.has(&JACOBIAN_READS)?;
    exists("body", body, m.nbody)?;
    check_length("the force", m.nv, qfrc.len())?;
    jacobian::apply_ft(m, &d.fields, force, torque, point, body, qfrc).ok_or(Error::NoId {
        kind: "body",
        id: body,
        count: m.nbody,
    })
}

/// Angular and linear velocity of an object (`mj_objectVelocity`), rad/s and m/s, in world axes, or in the axes of the object if
/// `local` is set. Zero if there is no such object.
pub fn object_velocity<S: Scope>(
    m: &Model,
    d: &Data<S>,
    kind: Obj,
    id: usize,
    local: bool,
) -> Result<Spatial, Error> {
    d.belongs_to(m)?;
    d.has(&[data::cvel])?;
    Ok(object::object_velocity(m, &d.fields, kind, id, local))
}

/// Angular and linear acceleration of an object (`mj_objectAcceleration`), rad/s² and m/s². As measured by an accelerometer: at
/// rest, the linear part points up and has the magnitude of gravity. Axes as for [`object_velocity`]. Call
/// [`rne_post_constraint`] before. Zero for objects that cannot move.
pub fn object_acceleration<S: Scope>(
    m: &Model,
    d: &Data<S>,
    kind: Obj,
    id: usize,
    local: bool,
) -> Result<Spatial, Error> {
    d.belongs_to(m)?;
    d.has(&[data::cacc, data::cvel])?;
    Ok(object::object_acceleration(m, &d.fields, kind, id, local))
}

/// qpos (nq) ← qpos advanced for a time `h`, s, with the velocity `v` (nv) (`mj_integratePos`).
pub fn integrate_pos(m: &Model, qpos: &mut [f64], v: &[f64], h: f64) -> Result<(), Error> {
    check_length("the position", m.nq, qpos.len())?;
    check_length("the velocity", m.nv, v.len())?;
    integrate::integrate_pos(m, qpos, v, h);
    Ok(())
}

/// The velocity (nv) that leads from `from` to `to` (nq each) in a time `h`, s (`mj_differentiatePos`), by the shorter rotation.
pub fn differentiate_pos(m: &Model, h: f64, from: &[f64], to: &[f64]) -> Result<Vec<f64>, Error> {
    check_length("a position", m.nq, from.len())?;
    check_length("a position", m.nq, to.len())?;
    let mut v = vec![0.0; m.nv];
    integrate::differentiate_pos(m, &mut v, h, from, to);
    Ok(v)
}

/// `kp` and `kv` of an actuator, with respect to its own length. `None` if they depend on more than its parameters, or if there
/// is no such actuator.
pub fn servo_gains(m: &Model, actuator: usize) -> Option<[f64; 2]> {
    actuation::servo_gains(m, actuator)
}

/// The energy, J, at `qpos` and `qvel`, for the current controls. `None` if an actuator has no potential: it may add energy.
/// Computes poses and lengths only.
///
/// # Errors
///
/// When the data belongs to another model, or its plan leaves out poses or inertias of bodies.
pub fn mechanical_energy<S: Scope>(m: &Model, d: &mut Data<S>) -> Result<Option<Energy>, Error> {
    d.has(&[data::ximat, data::cinert])?;
    let (d, s) = d.engine(m)?;
    Ok(balance::mechanical_energy(m, d, s))
}

/// The energy, J, of the current poses and lengths, for the current `qpos`, `qvel` and controls; see [`mechanical_energy`]. They
/// come from an earlier computation, or from [`copy_poses`].
///
/// # Errors
///
/// When the data belongs to another model, or its plan leaves out poses or inertias of bodies.
pub fn energy_of_poses<S: Scope>(m: &Model, d: &mut Data<S>) -> Result<Option<Energy>, Error> {
    d.has(&[data::ximat, data::cinert])?;
    let (d, s) = d.engine(m)?;
    Ok(balance::energy_of_poses(m, d, s))
}

/// What [`copy_poses`] copies.
const POSES: [FieldId; 8] = [
    data::xmat,
    data::xipos,
    data::ximat,
    data::xanchor,
    data::xaxis,
    data::ten_length,
    data::actuator_length,
    data::M,
];

/// Whether each step computes all that [`copy_poses`] copies and [`energy_of_poses`] needs, for the state from which the step
/// starts. The last evaluation of an integrator of several stages is at another state; the inertia of tendons needs their Jacobian.
pub fn steps_compute_poses<S: Scope>(m: &Model, d: &Data<S>) -> bool {
    !integrator::many_stages(m.opt.integrator)
        && m.tendon_armature.iter().all(|&a| a == 0.0)
        && d.has(&POSES).is_ok()
}

/// Copies the poses of bodies and joints, the lengths of tendons and actuators, and `M`, of the last evaluation of `from`.
///
/// # Errors
///
/// When one of the data belongs to another model, or a plan leaves out one of these fields.
pub fn copy_poses<S: Scope, T: Scope>(m: &Model, to: &mut Data<S>, from: &Data<T>) -> Result<(), Error> {
    from.belongs_to(m)?;
    from.has(&POSES)?;
    to.has(&POSES)?;
    let (to, _) = to.engine(m)?;
    let from = &from.fields;
    to.xmat.copy_from_slice(&from.xmat);
    to.xipos.copy_from_slice(&from.xipos);
    to.ximat.copy_from_slice(&from.ximat);
    to.xanchor.copy_from_slice(&from.xanchor);
    to.xaxis.copy_from_slice(&from.xaxis);
    to.ten_length.copy_from_slice(&from.ten_length);
    to.actuator_length.copy_from_slice(&from.actuator_length);
    to.M.copy_from_slice(&from.M);
    Ok(())
}

/// The numbers of any field.
pub fn view<'a, S: Scope>(m: &'a Model, d: &'a Data<S>, field: FieldId) -> Result<View<'a>, Error> {
    match m.field(field) {
        Some(view) => Ok(view),
        None => d.read(field),
    }
}

/// Element `i` of any field, computed or not, for hosts that know which fields they requested. `None` if `i` is past its end.
#[doc(hidden)]
#[inline]
pub fn element<S: Scope>(m: &Model, d: &Data<S>, field: FieldId, i: usize) -> Option<f64> {
    reflect::element(m, &d.fields, field, i)
}

/// The current number of elements of a field.
pub fn length<S: Scope>(m: &Model, d: &Data<S>, field: FieldId) -> usize {
    m.field(field).map_or_else(|| reflect::view_data(&d.fields, field).len(), |view| view.len())
}

/// The numbers of any field, for writing. Fields that the engine computes or uses as indexes cannot be written.
pub fn view_mut<'a, S: Scope>(
    m: &'a mut Model,
    d: &'a mut Data<S>,
    field: FieldId,
) -> Result<ViewMut<'a>, Error> {
    if field.info().object == Object::Data {
        return d.write(field);
    }
    m.field_mut(field)
}

/// Saved simulations: state, inputs and all results, including contacts and warnings.
///
/// ```
/// # fn main() -> Result<(), labspec_core::Error> {
/// use labspec_core::{Data, Model, save, step};
/// let model = Model::from_xml(
///     "<mujoco><worldbody><body><joint/><geom size='0.1' pos='0 1 0'/></body></worldbody></mujoco>",
/// )?;
/// let mut data = Data::new(&model);
/// step(&model, &mut data)?;
/// let saved = save::save(&model, &data)?;
/// let then = data.qpos.clone();
/// step(&model, &mut data)?;
/// save::restore(&model, &mut data, &saved)?;
/// assert_eq!(data.qpos, then);
/// # Ok(())
/// # }
/// ```
pub mod save {
    pub use super::saved_data::*;
}

/// States as lists of numbers (`mj_getState` and related functions). A signature selects the parts of the state.
///
/// ```
/// # fn main() -> Result<(), labspec_core::Error> {
/// use labspec_core::{Data, Model, state, step};
/// let model = Model::from_xml(
///     "<mujoco><worldbody><body><joint/><geom size='0.1' pos='0 1 0'/></body></worldbody></mujoco>",
/// )?;
/// let mut data = Data::new(&model);
/// let mut start = vec![0.0; state::size(&model, state::PHYSICS)?];
/// state::get(&model, &data, &mut start, state::PHYSICS)?;
/// step(&model, &mut data)?;
/// state::set(&model, &mut data, &start, state::PHYSICS)?;
/// assert_eq!(data.qpos[0], 0.0);
/// # Ok(())
/// # }
/// ```
pub mod state {
    pub use super::state_vectors::*;
}
