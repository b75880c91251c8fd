//! Pure geometry of shapes: rays, containment, support points, distance and penetration.
//!
//! A [`Shape`] consists of a type, sizes and a pose. This module does not depend on models, data or dynamics. Queries
//! of a model use it through [`crate::query`].

mod cast;
mod clip;
pub(crate) mod convex;
mod difference;
mod distance;
mod epa;
mod gjk;
mod hull;
mod hull_faces;
mod inside;
mod list;
pub mod pair;
mod polish;
mod ray;
mod segments;
mod shape;
mod simplex;
mod support;
mod surface;

pub(crate) use cast::ray_shape;
pub use distance::Distance;
pub(crate) use distance::{Narrow, shape_distance};
pub use hull::Hull;
pub(crate) use inside::inside_shape;

pub use hull_faces::HullFaces;
pub(crate) use shape::{HeightField, Mesh, Shape};

#[cfg(test)]
pub(crate) mod tests;
