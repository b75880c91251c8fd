//! Volume, centre of mass and inertia of what a surface of triangles encloses, or of the surface itself: sums over
//! tetrahedra with a common corner, or over triangles (Tonon 2004, *Explicit exact formulas for the 3-D tetrahedron
//! inertia tensor*; for triangles the same with another denominator).

use super::triangle;
use crate::math::{Vec3, add_scaled, dot, sub};

/// What is taken for the body of a mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Body {
    /// The convex hull.
    Convex,
    /// What the triangles enclose, with their sense.
    Exact,
    /// The same with every tetrahedron counted as positive: too much where the mesh is not convex.
    Legacy,
    /// The surface.
    Shell,
}

/// Mass properties for a density of one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Mass {
    /// m^3; of a shell m^2.
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

/// Area and centre of area.
pub(super) fn surface(triangles: impl Iterator<Item = Triangle>) -> (f64, Vec3) {
    let (mut total, mut moment) = (0.0, [0.0; 3]);
    for t in triangles {
        let (area, centre, _) = triangle(t);
        moment = add_scaled(moment, centre, area);
        total += area;
    }
    (total, moment.map(|x| x / total))
}

/// Volume and centre of volume, by tetrahedra from `apex`; of a shell, area and centre of area.
pub(super) fn bulk(triangles: impl Iterator<Item = Triangle>, body: Body, apex: Vec3) -> (f64, Vec3) {
    let (mut total, mut moment) = (0.0, [0.0; 3]);
    for t in triangles {
        let (area, centre, normal) = triangle(t);
        let amount = portion(body, area, sub(centre, apex), normal);
        total += amount;
        for i in 0..3 {
            moment[i] += amount * (centre[i] * 3.0 / 4.0 + apex[i] / 4.0);
        }
    }
    (total, moment.map(|x| x / total))
}

/// The part of a triangle with its normal and its centre seen from the common corner.
fn portion(body: Body, area: f64, centre: Vec3, normal: Vec3) -> f64 {
    let volume = || dot(centre, normal) * area / 3.0;
    match body {
        Body::Shell => area,
        Body::Legacy => volume().abs(),
        Body::Exact | Body::Convex => volume(),
    }
}

/// Amount and inertia about `centre`, by tetrahedra from there.
pub(super) fn about(triangles: impl Iterator<Item = Triangle>, body: Body, centre: Vec3) -> Mass {
    const AXES: [(usize, usize); 6] = [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)];
    let denominator = if body == Body::Shell { 12.0 } else { 20.0 };
    let (mut total, mut products) = (0.0, [0.0; 6]);
    for t in triangles {
        let t = t.map(|p| sub(p, centre));
        let (area, middle, normal) = triangle(t);
        let amount = portion(body, area, middle, normal);
        total += amount;
        let [d, e, f] = t;
        for (sum, (i, j)) in products.iter_mut().zip(AXES) {
            *sum += amount / denominator
                * (2.0 * (d[i] * d[j] + e[i] * e[j] + f[i] * f[j])
                    + d[i] * e[j]
                    + d[j] * e[i]
                    + d[i] * f[j]
                    + d[j] * f[i]
                    + e[i] * f[j]
                    + e[j] * f[i]);
        }
    }
    let [xx, yy, zz, xy, xz, yz] = products;
    Mass { amount: total, centre, inertia: [yy + zz, xx + zz, xx + yy, -xy, -xz, -yz] }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// A box about a point, as triangles.
    fn cuboid(half: Vec3, at: Vec3) -> Vec<Triangle> {
        let corner =
            |i: usize| std::array::from_fn(|k| at[k] + if i >> k & 1 == 1 { half[k] } else { -half[k] });
        let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).map(|t| t.map(corner)).collect()
    }

    proptest! {
        #![proptest_config(ProptestConfig { cases: 100, failure_persistence: None, ..ProptestConfig::default() })]
        #[test]
        fn boxes_have_the_inertia_of_boxes(
            half in prop::array::uniform3(0.1..2.0),
            at in prop::array::uniform3(-3.0..3.0),
            apex in prop::array::uniform3(-3.0..3.0),
        ) {
            let [x, y, z] = half.map(|h: f64| h * h / 3.0);
            let volume: f64 = 8.0 * half.iter().product::<f64>();
            let triangles = || cuboid(half, at).into_iter();
            let (found, centre) = bulk(triangles(), Body::Exact, apex);
            let mass = about(triangles(), Body::Exact, centre);
            let want = [y + z, x + z, x + y, 0.0, 0.0, 0.0].map(|m| m * volume);
            prop_assert!((found / volume - 1.0).abs() < 1e-9 && (mass.amount / volume - 1.0).abs() < 1e-12);
            for i in 0..3 {
                prop_assert!((centre[i] - at[i]).abs() < 1e-9);
            }
            for i in 0..6 {
                prop_assert!((mass.inertia[i] - want[i]).abs() < 1e-9 * volume, "{:?} {:?}", mass.inertia, want);
            }
        }
    }
}
