//! What is asked of a model with its data and leaves them as they are: rays, distances, what is inside of a site.
//!
//! The geometry itself is in [`crate::geometry`] and knows neither.

mod distance;
mod inside;
mod ray;
mod shape;

pub(crate) use distance::geom_distance;
pub(crate) use inside::inside_site;
pub(crate) use ray::ray;
pub use ray::{RayFilter, RayHit};
