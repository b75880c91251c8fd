//! Read-only queries of a model and its data: rays, distances, points inside sites.
//!
//! The geometry itself is in [`crate::geometry`], which does not depend on models and data.

mod geom_distance;
mod ray_hits;
mod shape_of;
mod within;

pub use geom_distance::geom_distance;
pub use ray_hits::{RayFilter, RayHit};
pub use ray_hits::{counted_ray, ray};
pub use within::inside_site;
