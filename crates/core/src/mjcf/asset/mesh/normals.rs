//! Normals of vertices: the mean of the triangles around, by area. Unless a mesh is to look smooth, triangles at a
//! large angle from that mean do not count.
//!
//! Sums are in single precision, as MuJoCo's are: where all triangles around a vertex are taken away again, what is
//! left is rounding, and it becomes a normal.

use crate::math::{MINVAL, Vec3, cross, dot, normalize, scale, sub};
use crate::mjcf::gather::listed;

/// Cosine of the largest angle of a triangle that counts.
const SHARP: f64 = 0.8;

type Single = [f32; 3];

pub(super) fn of_vertices(vert: &[Vec3], face: &[[i32; 3]], smooth: bool) -> Vec<Vec3> {
    let corner = |v: i32| vert.get(v as usize).copied().unwrap_or_default();
    // Direction and twice the area of each triangle.
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

/// The direction of a normal; up where there is none.
pub(super) fn unit(normal: Vec3) -> Vec3 {
    let (unit, length) = normalize(normal);
    if length < MINVAL { [0.0, 0.0, 1.0] } else { unit }
}
