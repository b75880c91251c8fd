//! Volume, centre of mass and inertia of the solid that a surface of triangles encloses, or of the surface itself.
//!
//! By the divergence theorem, an integral over the interior is a sum over the tetrahedra between the triangles and a common apex,
//! each with the sign of its volume. For a simplex of the volume or area V with the n corners vᵢ, n = 4 or 3, and their sum s:
//!
//! > ∫ x = V s / n,  ∫ x xᵀ = V / (n (n + 1)) (Σ vᵢ vᵢᵀ + s sᵀ)
//!
//! (Hammer, Marlowe and Stroud, *Numerical integration over simplexes and cones*, 1956). An apex at the origin contributes
//! nothing to the sums of corners.

use super::triangle;
use crate::math::{Vec3, add, add_scaled, cross, dot, sub};

/// The body that a mesh represents.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum MeshBody {
    /// The convex hull.
    Convex,
    /// The solid that the triangles enclose; their orientation determines the sign.
    Exact,
    /// The same solid with every tetrahedron counted as positive. The result is too large if the mesh is not convex.
    Legacy,
    /// The surface.
    Shell,
}

/// Mass properties for a density of one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Mass {
    /// Volume, m^3, or area of a shell, m^2.
    pub(super) amount: f64,
    pub(super) centre: Vec3,
    /// About the centre: xx yy zz xy xz yz.
    pub(super) inertia: [f64; 6],
}

type Triangle = [Vec3; 3];

/// The corners of triangles.
pub(super) fn triangles<'m>(vert: &'m [Vec3], face: &'m [[i32; 3]]) -> impl Iterator<Item = Triangle> + 'm {
    face.iter().map(|f| f.map(|v| vert.get(v as usize).copied().unwrap_or_default()))
}

impl MeshBody {
    /// V of the simplex of a triangle. A tetrahedron has its apex at the origin.
    fn measure(self, t: Triangle) -> f64 {
        let [a, b, c] = t;
        let volume = dot(a, cross(b, c)) / 6.0;
        match self {
            MeshBody::Shell => triangle(t).0,
            MeshBody::Legacy => volume.abs(),
            MeshBody::Exact | MeshBody::Convex => volume,
        }
    }

    /// n: the number of corners of a simplex.
    fn corners(self) -> f64 {
        if self == MeshBody::Shell { 3.0 } else { 4.0 }
    }
}

/// Area and centre of area.
pub(super) fn surface(triangles: impl Iterator<Item = Triangle>) -> (f64, Vec3) {
    volume_and_centre(triangles, MeshBody::Shell, [0.0; 3])
}

/// Volume or area, and centre of mass, from simplexes with the apex `apex`.
pub(super) fn volume_and_centre(
    triangles: impl Iterator<Item = Triangle>,
    body: MeshBody,
    apex: Vec3,
) -> (f64, Vec3) {
    let (mut total, mut first) = (0.0, [0.0; 3]);
    for t in triangles {
        let [a, b, c] = t.map(|p| sub(p, apex));
        let measure = body.measure([a, b, c]);
        total += measure;
        first = add_scaled(first, add(add(a, b), c), measure / body.corners());
    }
    (total, add_scaled(apex, first, 1.0 / total))
}

/// Volume or area, and inertia about `centre`, from simplexes with this apex.
pub(super) fn inertia_about(triangles: impl Iterator<Item = Triangle>, body: MeshBody, centre: Vec3) -> Mass {
    let corners = body.corners();
    let (mut amount, mut second) = (0.0, [[0.0; 3]; 3]);
    for t in triangles {
        let [a, b, c] = t.map(|p| sub(p, centre));
        let measure = body.measure([a, b, c]);
        amount += measure;
        for v in [a, b, c, add(add(a, b), c)] {
            for (row, x) in second.iter_mut().zip(v) {
                *row = add_scaled(*row, v, measure * x / (corners * (corners + 1.0)));
            }
        }
    }
    // ∫ (x·x 1 - x xᵀ)
    let [[xx, xy, xz], [_, yy, yz], [_, _, zz]] = second;
    Mass { amount, centre, inertia: [yy + zz, zz + xx, xx + yy, -xy, -xz, -yz] }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// A box about a point, as triangles.
    fn cuboid(half: Vec3, position: Vec3) -> Vec<Triangle> {
        let corner = |i: usize| {
            std::array::from_fn(|k| position[k] + if i >> k & 1 == 1 { half[k] } else { -half[k] })
        };
        let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        faces.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).map(|t| t.map(corner)).collect()
    }

    proptest! {
        #![proptest_config(ProptestConfig { cases: 100, failure_persistence: None, ..ProptestConfig::default() })]
        #[test]
        fn boxes_have_the_inertia_of_boxes(
            half in prop::array::uniform3(0.1..2.0),
            position in prop::array::uniform3(-3.0..3.0),
            apex in prop::array::uniform3(-3.0..3.0),
        ) {
            let [x, y, z] = half.map(|h: f64| h * h / 3.0);
            let volume: f64 = 8.0 * half.iter().product::<f64>();
            let triangles = || cuboid(half, position).into_iter();
            let (found, centre) = volume_and_centre(triangles(), MeshBody::Exact, apex);
            let mass = inertia_about(triangles(), MeshBody::Exact, centre);
            let expected = [y + z, x + z, x + y, 0.0, 0.0, 0.0].map(|m| m * volume);
            prop_assert!((found / volume - 1.0).abs() < 1e-9 && (mass.amount / volume - 1.0).abs() < 1e-12);
            for i in 0..3 {
                prop_assert!((centre[i] - position[i]).abs() < 1e-9);
            }
            for i in 0..6 {
                prop_assert!((mass.inertia[i] - expected[i]).abs() < 1e-9 * volume, "{:?} {:?}", mass.inertia, expected);
            }
        }
    }
}
