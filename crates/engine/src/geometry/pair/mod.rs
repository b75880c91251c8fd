//! Contacts of two shapes: closed forms for some pairs of types, the general convex algorithm for the others.
//!
//! Each function appends its contacts to a list: at most [`MAX_CONTACTS`], only those within `margin`, in MuJoCo's order. The
//! first shape has the smaller type; the normal points from the first shape to the second.

mod box_box;
mod cuboid;
mod field;
mod plane;
mod polygon;
mod round;
mod searched;

pub(crate) use field::field_distance;
pub(crate) use plane::ball_on_plane;
pub(crate) use round::two_balls;

use super::Shape;
use super::convex::{ConvexScratch, Effort, Nearest};
use crate::kinds::geom;
use crate::math::*;

/// Maximum number of contacts of a pair.
pub(crate) const MAX_CONTACTS: usize = 50;

/// A contact point of two shapes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct ContactPoint {
    /// Distance of the surfaces, m; negative if they overlap.
    pub(crate) dist: f64,
    /// Midpoint between the surfaces, m, world frame.
    pub(crate) pos: Vec3,
    /// Unit normal from the first to the second shape, world frame.
    pub(crate) normal: Vec3,
    /// Direction of the first tangent, world frame; zero if it is arbitrary.
    pub(crate) tangent: Vec3,
}

impl ContactPoint {
    /// The midpoint between the nearest or deepest points.
    fn at_midpoint(n: &Nearest) -> ContactPoint {
        let [on_a, on_b] = n.witness;
        ContactPoint { dist: n.dist, pos: scale(add(on_a, on_b), 0.5), normal: n.normal, tangent: [0.0; 3] }
    }
}

/// Settings of the general algorithm.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PairSettings {
    pub(crate) effort: Effort,
    /// Whether flat contacts get several points (`multiccd`).
    pub(crate) several: bool,
}

/// The method that computes the contacts of two types.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Method {
    /// A closed form.
    Direct(fn(&Shape, &Shape, f64, &mut Vec<ContactPoint>)),
    /// The general algorithm for convex shapes.
    Convex,
    /// The general algorithm on every prism of a height field.
    Field,
}

/// Two closed forms count as equal: the types determine the function.
impl PartialEq for Method {
    fn eq(&self, other: &Method) -> bool {
        std::mem::discriminant(self) == std::mem::discriminant(other)
    }
}

/// Whether this build contains the general algorithm. Without it, models that need it are refused when they are
/// loaded (`setup/needs`).
pub const CONVEX: bool = cfg!(feature = "convex");

/// The method for two types, the smaller type first. Returns `None` if such geoms do not collide.
pub(crate) fn method(kind1: i32, kind2: i32) -> Option<Method> {
    use geom::*;
    Some(match (kind1, kind2) {
        (PLANE, SPHERE) => Method::Direct(plane::sphere),
        (PLANE, CAPSULE) => Method::Direct(plane::capsule),
        (PLANE, ELLIPSOID) => Method::Direct(plane::ellipsoid),
        (PLANE, MESH) => Method::Direct(plane::mesh),
        (PLANE, CYLINDER) => Method::Direct(plane::cylinder),
        (PLANE, BOX) => Method::Direct(plane::cuboid),
        (HFIELD, SPHERE..) => Method::Field,
        (SPHERE, SPHERE) => Method::Direct(round::sphere_sphere),
        (SPHERE, CAPSULE) => Method::Direct(round::sphere_capsule),
        (SPHERE, CYLINDER) => Method::Direct(round::sphere_cylinder),
        (SPHERE, BOX) => Method::Direct(cuboid::sphere_box),
        (CAPSULE, CAPSULE) => Method::Direct(round::capsule_capsule),
        (CAPSULE, BOX) => Method::Direct(cuboid::capsule_box),
        (BOX, BOX) => Method::Direct(box_box::box_box),
        (SPHERE.., SPHERE..) => Method::Convex,
        _ => return None,
    })
}

/// Whether the general algorithm computes the contacts of two types (in any order), or their distance if `distance`
/// is set.
pub(crate) fn is_searched(kind1: i32, kind2: i32, distance: bool) -> bool {
    let first = kind1.min(kind2);
    match method(first, kind1.max(kind2)) {
        Some(Method::Convex | Method::Field) => true,
        Some(Method::Direct(_)) => distance && first == geom::BOX,
        None => false,
    }
}

/// Appends the contacts of two shapes within `margin`.
#[cfg_attr(not(feature = "small"), inline(always))]
pub(crate) fn contacts(
    method: Method,
    a: &Shape,
    b: &Shape,
    margin: f64,
    settings: impl FnOnce() -> PairSettings,
    scratch: &mut ConvexScratch,
    out: &mut Vec<ContactPoint>,
) {
    match method {
        Method::Direct(test) => test(a, b, margin, out),
        Method::Convex if CONVEX => searched::convex(a, b, margin, &settings(), scratch, out),
        Method::Field if CONVEX => field::field(a, b, margin, &settings(), scratch, out),
        Method::Convex | Method::Field => {}
    }
}
