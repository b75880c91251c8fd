//! Contacts of two shapes: closed forms where there are some, the general convex algorithm elsewhere.
//!
//! Every function appends its contacts to a list: at most `MOST`, only those within `margin`, in an order that is
//! MuJoCo's. The first shape has the smaller type; the normal points from it to the second.

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

/// Most contacts of a pair.
pub(crate) const MOST: usize = 50;

/// A place where two shapes touch.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct ContactPoint {
    /// Distance of the surfaces, negative when they overlap, m.
    pub(crate) dist: f64,
    /// Midpoint between the surfaces, m, world.
    pub(crate) pos: Vec3,
    /// Unit normal from the first to the second, world.
    pub(crate) normal: Vec3,
    /// The first tangent's direction; zero when any will do.
    pub(crate) tangent: Vec3,
}

impl ContactPoint {
    /// Half way between the nearest or deepest points.
    fn between(n: &Nearest) -> ContactPoint {
        let [on_a, on_b] = n.witness;
        ContactPoint { dist: n.dist, pos: scale(add(on_a, on_b), 0.5), normal: n.normal, tangent: [0.0; 3] }
    }
}

/// What the general algorithm needs besides the shapes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PairSettings {
    pub(crate) effort: Effort,
    /// Whether flat contacts get several points.
    pub(crate) several: bool,
}

/// How a pair of types is tested.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Method {
    /// A closed form.
    Direct(fn(&Shape, &Shape, f64, &mut Vec<ContactPoint>)),
    /// The general algorithm for convex shapes.
    Convex,
    /// The general algorithm on every prism of a height field.
    Field,
}

/// Which closed form it is follows from the types.
impl PartialEq for Method {
    fn eq(&self, other: &Method) -> bool {
        std::mem::discriminant(self) == std::mem::discriminant(other)
    }
}

/// Whether this build has the general algorithm. Without it a model that needs it is refused when it is loaded
/// (`setup/needs`).
pub const CONVEX: bool = cfg!(feature = "convex");

/// The method of two types, the smaller first; `None` when such geoms pass through each other.
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

/// Whether the contacts of two types, or their distance, are searched for by the general algorithm, in either order.
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
