//! What is asked of a model with its data and leaves them as they are: rays, distances, what is inside of a site.
//!
//! The geometry itself is in [`crate::geometry`] and knows neither.

mod apart;
mod ray_hits;
mod shape_of;
mod within;

pub use apart::geom_distance;
pub use ray_hits::{RayFilter, RayHit};
pub use ray_hits::{counted_ray, ray};
pub use within::inside_site;
