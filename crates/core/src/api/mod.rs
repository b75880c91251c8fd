//! The interface for embedders: models with their data, objects by name, errors instead of panics.

pub(crate) mod addresses;
mod assumed;
pub(crate) mod call;
mod contents;
pub(crate) mod data;
pub(crate) mod error;
#[cfg(test)]
#[allow(clippy::unwrap_used)] // a panic is the report of a failed test
mod idle_actuators;
pub(crate) mod model;
#[cfg(feature = "nalgebra")]
pub mod nalgebra;
#[cfg(test)]
#[allow(clippy::unwrap_used)] // a panic is the report of a failed test
mod planar_chains;
pub(crate) mod planning;
pub mod reading;
#[cfg(test)]
#[allow(clippy::unwrap_used, clippy::panic)] // a panic is the report of a failed test
mod recorded_sensors;
#[cfg(test)]
#[allow(clippy::unwrap_used)] // a panic is the report of a failed test
mod scaled_scenes;
#[cfg(test)]
#[allow(clippy::unwrap_used, clippy::panic)] // a panic is the report of a failed test
mod survival;
pub(crate) mod view;
