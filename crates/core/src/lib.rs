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

mod actuation;
mod articulated;
mod bytes;
mod camera;
mod chain;
mod collision;
mod com;
mod constraint;
mod data;
mod derivative;
mod energy;
mod equality;
mod fields;
pub mod geometry;
pub mod growth;
mod history;
mod integrate;
mod inverse;
mod jacobian;
pub(crate) mod kinds;
mod kinematics;
mod lanes;
mod lengthrange;
mod mass;
pub mod math;
pub mod mjcf;
mod model;
mod object;
mod passive;
mod path;
mod pipeline;
pub mod plan;
pub mod query;
pub mod reflect;
mod reset;
mod rne;
mod rne_post;
pub mod save;
pub mod sensor;
mod serial;
mod setconst;
mod sleep;
pub mod stability;
pub mod state;
mod subtree;
mod tendon;
mod transmission;
mod work;

pub use collision::{can_collide, contact_force};
pub use constraint::full_j;
pub use data::{Contact, Data, Warning, WarningStat};
pub use energy::{kinetic as energy_vel, potential as energy_pos};
pub use integrate::{differentiate_pos, integrate_pos};
pub use inverse::{InverseError, inverse};
pub use jacobian::{
    Jacobian, apply_ft, jac, jac_body, jac_body_com, jac_dot, jac_geom, jac_site, jac_subtree_com,
};
pub use kinds::{
    biastype, disable, dyntype, enable, eqtype, gaintype, geom, integrator, joint, solver, trntype, wraptype,
};
pub use kinematics::kinematics;
pub use mass::{full_m, mul_m, solve_m, solve_m2};
pub use model::{Model, Names, Obj, Options, Statistic};

pub use object::{object_acceleration, object_velocity};
pub use pipeline::{forward, set_plan, step, step1, step2};
pub use plan::{Demand, Plan};
pub use reset::{reset_data, reset_data_keyframe, set_keyframe};
pub use rne::rne;
pub use rne_post::rne_post_constraint;
pub use setconst::set_const;
pub use subtree::subtree_vel;
pub use work::{charge, cost, cost_of_pass, exhausted, limit};
