//! Pure geometry of shapes: rays, containment, support points, distance and penetration.
//!
//! A [`Shape`] is a type, sizes and a pose; nothing here changes a model or knows of dynamics. The functions of
//! a [`Model`](crate::Model) with its data are at the edge: [`ray`], [`inside_site`], [`geom_distance`].

mod cast;
pub(crate) mod convex;
mod distance;
mod epa;
mod gjk;
mod inside;
pub(crate) mod pair;
mod polish;
mod ray;
mod shape;
mod sides;
mod simplex;
mod support;
mod surface;

pub use cast::{RayFilter, RayHit, ray};
pub(crate) use distance::Narrow;
pub use distance::{Distance, geom_distance};
pub use inside::{inside_shape, inside_site};
pub use ray::{Hit, ray_shape};
pub use shape::{Field, Hull, Mesh, Shape};
pub use sides::Sides;

#[cfg(test)]
pub(crate) mod tests;
