//! Poses, velocities, Jacobians, M and the linearization of a step in the types of the crate `nalgebra` (feature `nalgebra`).
//!
//! The functions have the names of those that return plain arrays, and accept objects by name or typed id. Conventions:
//!
//! * Positions are in metres, in world axes. A rotation maps vectors from the axes of the object to those of the world.
//! * Columns of Jacobians and of M are degrees of freedom, in the order of `qvel`; rows of Jacobians are the world axes x, y, z.
//! * Derived fields belong to the last call that computed them. After [`step`](fn@crate::step), they belong to the state before that
//!   step.
//!   [`forward`](crate::forward) computes them for the current state.
//! * A result that the plan of the data left out is [`Error::LeftOut`](crate::Error::LeftOut), which names the stage.
//!
//! The engine does not compute with nalgebra. All numbers have the same bits with and without the feature.
//!
//! [`Data::field_vector`](crate::Data::field_vector) and [`Data::field_matrix`](crate::Data::field_matrix) are views into the
//! data, without copies.
//!
//! ```
//! # fn main() -> Result<(), labspec_core::Error> {
//! use labspec_core::{Data, Model, forward, nalgebra::{body_velocity, full_m, jac_body}};
//! let model = Model::from_xml(
//!     "<mujoco><worldbody><body name='arm'><joint axis='0 1 0'/><geom size='0.1' pos='1 0 0'/>
//!      <body name='tip' pos='2 0 0'/></body></worldbody></mujoco>",
//! )?;
//! let mut data = Data::new(&model);
//! data.edit().qvel[0] = 3.0;
//! forward(&model, &mut data)?;
//! // The hinge turns the tip, which is at x = 2 m, down.
//! assert_eq!(data.body_pose("tip")?.translation.vector.x, 2.0);
//! let velocity = jac_body(&model, &data, "tip")?.translation * data.field_vector("qvel")?;
//! assert!((velocity[2] + 6.0).abs() < 1e-12);
//! assert!((body_velocity(&model, &data, "tip", false)?.linear.z + 6.0).abs() < 1e-12);
//! assert!(full_m(&model, &data)?.cholesky().is_some());
//! # Ok(())
//! # }
//! ```

mod matrices;
mod poses;
mod transition;
mod views;

pub use matrices::{
    PointJacobian, full_j, full_m, jac, jac_body, jac_body_com, jac_dot, jac_geom, jac_site, jac_subtree_com,
    solve_m,
};
pub use poses::{Velocity, body_velocity, geom_velocity, site_velocity};
pub use transition::{FiniteDifferences, Transition, transition_fd};
pub use views::RowsView;
