//! A rigid-body engine with the semantics of MuJoCo 3.14.0. It does not depend on labs or expressions.
//!
//! ```
//! # fn main() -> Result<(), labspec_core::Error> {
//! use labspec_core::{Data, Model, step};
//! let model = Model::from_xml(
//!     "<mujoco><worldbody><body name='ball' pos='0 0 1'><freejoint/><geom size='0.05'/></body></worldbody></mujoco>",
//! )?;
//! let mut data = Data::new(&model);
//! for _ in 0..100 {
//!     step(&model, &mut data)?;
//! }
//! assert!((data.time - 0.2).abs() < 1e-12 && data.body("ball")?.xpos()[2] < 1.0);
//! # Ok(())
//! # }
//! ```
//!
//! [`Model`] contains the data that do not change during a simulation, [`Data`] those that do. Functions have MuJoCo's names. No
//! call panics: an inconsistent argument causes an [`Error`], whose message names the next step. A [`Plan`] leaves out the stages
//! that a scene and its readers do not need, without changing a number.
//!
//! With `default-features = false`, models are read from the bytes of [`Model::to_bytes`] only: every MJCF text is refused by a
//! finding.
#![forbid(unsafe_code)]
// Some items are used by the MJCF reader only.
#![cfg_attr(not(feature = "mjcf"), allow(dead_code, unused_imports))]
#![recursion_limit = "256"]

mod api;
#[cfg(feature = "mjcf")]
mod mjcf;
#[cfg(not(feature = "mjcf"))]
#[path = "no_mjcf.rs"]
mod mjcf;
mod setup;
mod source;

use labspec_engine::{collision, constraint, dynamics, forces, geometry, kinds, model, query, sensor, step};

pub use labspec_engine::math;

pub use api::call::*;
pub use api::data::{Data, Edit, Full, Planned, Scope};
pub use api::error::Error;
pub use api::model::{
    ActuatorId, BodyId, Cone, GeomId, Integrator, JointId, KeyId, Model, ModelEdit, OptionsEdit, SensorId,
    SiteId, Solver, StatisticEdit, TendonId,
};
#[cfg(feature = "nalgebra")]
pub use api::nalgebra;
pub use api::planning::Plan;
pub use api::reading as xml;
pub use api::view::{Actuator, Body, Geom, Joint, ObjectKey, Rows3, Sensor, Site, Tendon};
pub use collision::PairFilterReason;
pub use geometry::Distance;
pub use kinds::{
    biastype, disable, dyntype, enable, eqtype, gaintype, geom, integrator, joint, solver, trntype, wraptype,
};
#[doc(hidden)]
pub use model::Fields;
pub use model::reflect;
pub use model::stopwatch::{StageTime, StageTimes};
pub use model::texture::Texture;
pub use model::tree_algorithm::{TreeAlgorithm, TreeAlgorithms};
pub use model::{Contact, Decision, Names, Obj, Options, Statistic, Warning, WarningStat};
pub use query::{RayFilter, RayHit};
pub use sensor::unit as sensor_unit;
pub use step::analysis::AccessSet;
pub use step::balance::Energy;
pub use step::inverse::InverseError;
