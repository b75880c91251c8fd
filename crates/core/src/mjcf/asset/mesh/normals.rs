//! Vertex normals: the mean of the normals of the adjacent triangles, weighted by area. Unless the mesh is smooth, triangles at a
//! large angle to that mean are excluded.
//!
//! Sums are in single precision, as in MuJoCo. If all triangles at a vertex are excluded, the sum consists of rounding errors,
//! and its direction is the normal.

use crate::math::{MINVAL, Vec3, cross, dot, normalize, scale, sub};
use crate::mjcf::gather::listed;

/// The cosine of the largest angle between an included triangle and the mean.
const SHARP: f64 = 0.8;

type Single = [f32; 3];

pub(super) fn of_vertices(vert: &[Vec3], face: &[[i32; 3]], smooth: bool) -> Vec<Vec3> {
    let corner = |v: i32| vert.get(v as usize).copied().unwrap_or_default();
    // The normal of each triangle, and twice its area.
    let side = |[a, b, c]: [Vec3; 3]| normalize(cross(sub(b, a), sub(c, a)));
    let sides: Vec<(Vec3, f64)> = listed(face.iter().map(|f| side(f.map(corner))));
    let corners = || face.iter().zip(&sides).flat_map(|(f, &side)| f.map(|v| (v as usize, side)));
    let mut sums: Vec<Single> = vec![[0.0; 3]; vert.len()];
    for (v, (normal, area)) in corners() {
        add(&mut sums, v, scale(normal, area));
    }
    if !smooth {
        let mut sharp: Vec<Single> = vec![[0.0; 3]; vert.len()];
        for (v, (normal, area)) in corners() {
            let mean = normalize(sums.get(v).copied().unwrap_or_default().map(f64::from)).0;
            if dot(normal, mean) < SHARP {
                add(&mut sharp, v, scale(normal, area));
            }
        }
        for (sum, sharp) in sums.as_flattened_mut().iter_mut().zip(sharp.as_flattened()) {
            *sum -= sharp;
        }
    }
    listed(sums.into_iter().map(|s| unit(s.map(f64::from))))
}

fn add(sums: &mut [Single], v: usize, part: Vec3) {
    for (sum, part) in sums.get_mut(v).into_iter().flatten().zip(part) {
        *sum = (f64::from(*sum) + part) as f32;
    }
}

/// The direction of a normal, or +z if its length is zero.
pub(super) fn unit(normal: Vec3) -> Vec3 {
    let (unit, length) = normalize(normal);
    if length < MINVAL { [0.0, 0.0, 1.0] } else { unit }
}
