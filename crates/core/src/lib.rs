//! A rigid-body engine with MuJoCo 3.14.0's semantics. It knows nothing of labs or expressions.
//!
//! ```
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let model = labspec_core::mjcf::compile(
//!     "<mujoco><worldbody><body pos='0 0 1'><freejoint/><geom size='0.05'/></body></worldbody></mujoco>",
//! )
//! .map_err(|errors| errors[0].message.clone())?;
//! let mut data = labspec_core::Data::new(&model);
//! for _ in 0..100 {
//!     labspec_core::step(&model, &mut data);
//! }
//! assert!((data.time - 0.2).abs() < 1e-12);
//! # Ok(())
//! # }
//! ```
//!
//! Where things live: `mjcf` reads models, `fields` is the one table of what exists, `pipeline` is the order
//! of the stages, and every stage is a module of its own.
#![forbid(unsafe_code)]

mod collision;
mod constraint;
mod dynamics;
mod forces;
pub mod geometry;
pub(crate) mod kinds;
pub mod math;
pub mod mjcf;
mod model;
pub mod query;
pub mod sensor;
mod setup;
mod step;

pub use collision::can_collide;
pub use constraint::contact_force;
pub use dynamics::jacobian::{
    Jacobian, apply_ft, jac, jac_body, jac_body_com, jac_dot, jac_geom, jac_site, jac_subtree_com,
};
pub use dynamics::mass::{full_m, mul_m, solve_m, solve_m2};
pub use dynamics::object::{object_acceleration, object_velocity};
pub use dynamics::subtree::subtree_vel;
pub use forces::actuation::servo_gains;
pub use forces::energy::{kinetic as energy_vel, potential as energy_pos};
pub use kinds::{
    biastype, disable, dyntype, enable, eqtype, gaintype, geom, integrator, joint, solver, trntype, wraptype,
};

pub use model::{
    Contact, Decision, Fields, Model, Names, Obj, Options, Plan, Statistic, Warning, WarningStat, reflect,
    state,
};
pub use sensor::body_force::rne_post_constraint;
pub use setup::setconst::set_const;
pub use step::balance::{Energy, mechanical_energy};
pub use step::data::Data;
pub use step::forward::forward;
pub use step::functions::{
    charge, cost, cost_of_pass, exhausted, full_j, geom_distance, kinematics, limit, rne, work_left,
};
pub use step::integrate::{differentiate_pos, integrate_pos};
pub use step::inverse::{InverseError, inverse};
pub use step::reset::{reset_data, reset_data_keyframe, set_keyframe, set_plan};
pub use step::scene::Demand;
pub use step::{save, step, step1, step2};
