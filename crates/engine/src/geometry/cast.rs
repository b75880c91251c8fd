//! Intersection of a ray with a shape of any type.

use super::ray::{self, Hit, Ray};
use super::{Shape, surface};
use crate::kinds::geom;
use crate::math::*;

/// Work units of a ray against a shape, without the triangles that it tests.
const SHAPE_COST: u64 = 20;

/// The nearest intersection of the ray `from` + x `along` (x ≥ 0; world frame) with the surface of a shape. A plane
/// is hit from its front side only, inside its rendered rectangle. The work done is added to `work`.
pub(crate) fn ray_shape(shape: &Shape, from: Vec3, along: Vec3, work: &mut u64) -> Option<Hit> {
    *work += SHAPE_COST;
    if shape.kind == geom::SPHERE {
        return ray::sphere(shape.size[0], &Ray { from: sub(from, shape.pos), along });
    }
    let r = Ray { from: shape.local(from), along: mat_t_mul_vec(&shape.mat, along) };
    let hit = match shape.kind {
        geom::PLANE => ray::plane(shape.size, &r),
        geom::CAPSULE => ray::capsule(shape.size, &r),
        geom::ELLIPSOID => ray::ellipsoid(shape.size, &r),
        geom::CYLINDER => ray::cylinder(shape.size, &r),
        geom::BOX => ray::cuboid(shape.size, &r),
        geom::MESH => surface::mesh(&shape.mesh(), shape.size, &r, work),
        geom::HFIELD => surface::field(&shape.field(), &r, work),
        _ => None,
    }?;
    Some(Hit { normal: mat_mul_vec(&shape.mat, hit.normal), ..hit })
}
