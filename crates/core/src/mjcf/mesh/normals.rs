//! Normals of vertices: the mean of the triangles around, by area. Unless a mesh is to look smooth, triangles at a
//! large angle from that mean do not count.

use crate::math::{MINVAL, Vec3, add, cross, dot, normalize, sub};

/// Cosine of the largest angle of a triangle that counts.
const SHARP: f64 = 0.8;

pub(super) fn of_vertices(vert: &[Vec3], face: &[[i32; 3]], smooth: bool) -> Vec<Vec3> {
    let corner = |v: i32| vert.get(v as usize).copied().unwrap_or_default();
    // Twice the area of each triangle along its normal.
    let sides: Vec<Vec3> =
        face.iter().map(|f| f.map(corner)).map(|[a, b, c]| cross(sub(b, a), sub(c, a))).collect();
    let mut sums = vec![[0.0; 3]; vert.len()];
    let corners = || face.iter().zip(&sides).flat_map(|(f, &side)| f.map(|v| (v as usize, side)));
    for (v, side) in corners() {
        if let Some(sum) = sums.get_mut(v) {
            *sum = add(*sum, side);
        }
    }
    if !smooth {
        let means: Vec<Vec3> = sums.iter().map(|s| normalize(*s).0).collect();
        for (v, side) in corners() {
            if let (Some(sum), Some(mean)) = (sums.get_mut(v), means.get(v))
                && dot(normalize(side).0, *mean) < SHARP
            {
                *sum = sub(*sum, side);
            }
        }
    }
    sums.into_iter().map(unit).collect()
}

/// The direction of a normal; up where there is none.
pub(super) fn unit(normal: Vec3) -> Vec3 {
    let (unit, length) = normalize(normal);
    if length < MINVAL { [0.0, 0.0, 1.0] } else { unit }
}
