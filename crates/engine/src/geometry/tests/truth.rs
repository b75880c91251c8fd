//! Signed distances of convex bodies compared with references that are independent of the algorithms and of MuJoCo.
//!
//! For separate bodies the result proves itself. The witness points belong to the two bodies and have the reported
//! distance. The projections of the bodies onto the line between the witness points are separated by the same
//! distance. For overlapping bodies the support function h(n) of the difference a - b bounds the depth from above for
//! every direction n, and the depth is its minimum. The reference for polyhedra is the minimum over the normals of
//! all faces of both bodies and over all pairs of edges (separating axes). The reference for round bodies is the
//! minimum over directions that cover the sphere, with the best ones refined by descent.
//!
//! `LABSPEC_CASES` sets the number of random configurations of each pair (100,000 for `docs/measured/contacts.md`).

use super::Random;
use crate::geometry::convex::{Convex, ConvexScratch, Nearest, nearest};
use crate::geometry::{HullFaces, Mesh, Shape};
use crate::kinds::geom;
use crate::math::*;

impl Random {
    fn direction(&mut self) -> Vec3 {
        loop {
            let v = [0; 3].map(|_| self.within(-1.0, 1.0));
            let (unit, length) = normalize(v);
            if length > 0.1 && length < 1.0 {
                return unit;
            }
        }
    }

    /// A random rotation, in some cases the identity, a rotation by a multiple of 90°, or a very small rotation.
    fn turn(&mut self) -> Mat3 {
        let quarter = |k: usize| quat_axis_angle([1.0, 0.0, 0.0], k as f64 * std::f64::consts::FRAC_PI_2);
        let q = match self.below(8) {
            0 => IDENTITY,
            1 => quarter(self.below(4)),
            2 => quat_axis_angle(self.direction(), 10f64.powf(self.within(-9.0, -2.0))),
            _ => quat_axis_angle(self.direction(), self.within(0.0, 3.0)),
        };
        quat_to_mat(quat_normalize(q))
    }
}

/// A convex mesh: vertices, triangles, graph of the hull and faces of the hull.
struct Solid {
    vert: Vec<Vec3>,
    face: Vec<[i32; 3]>,
    graph: Vec<i32>,
    hull_faces: HullFaces,
}

pub(super) fn farthest(s: &Shape, dir: Vec3) -> Vec3 {
    let local = mat_t_mul_vec(&s.mat, dir);
    let sign = |x: f64| if x < 0.0 { -1.0 } else { 1.0 };
    let [x, y, z] = s.size;
    s.world(match s.kind {
        geom::SPHERE => scale(local, x),
        geom::CAPSULE => add(scale(local, x), [0.0, 0.0, y * sign(local[2])]),
        geom::ELLIPSOID => {
            let stretched = [x * local[0], y * local[1], z * local[2]];
            let n = norm(stretched);
            [x * stretched[0] / n, y * stretched[1] / n, z * stretched[2] / n]
        }
        geom::CYLINDER => {
            let across = libm::hypot(local[0], local[1]);
            let out = if across > 0.0 { x / across } else { 0.0 };
            [out * local[0], out * local[1], y * sign(local[2])]
        }
        geom::BOX => [x * sign(local[0]), y * sign(local[1]), z * sign(local[2])],
        _ => {
            let height = |v: &Vec3| dot(*v, local);
            s.mesh().vert.iter().copied().max_by(|u, v| height(u).total_cmp(&height(v))).unwrap()
        }
    })
}

/// The extent of a - b along a direction.
fn reach(a: &Shape, b: &Shape, n: Vec3) -> f64 {
    dot(n, farthest(a, n)) - dot(n, farthest(b, scale(n, -1.0)))
}

/// Face normals and edge directions of a polyhedron, world frame.
fn faces_and_edges(s: &Shape) -> (Vec<Vec3>, Vec<Vec3>) {
    if s.kind == geom::BOX {
        let axes = [0, 1, 2].map(|i| s.axis(i)).to_vec();
        return (axes.clone(), axes);
    }
    let point = |v: i32| s.world(s.mesh().vert[v as usize]);
    let (mut normals, mut edges) = (Vec::new(), Vec::new());
    for f in s.mesh().hull.unwrap().face {
        let [p, q, r] = f.map(point);
        normals.push(normalize(cross(sub(q, p), sub(r, p))).0);
        edges.extend([sub(q, p), sub(r, q), sub(p, r)].map(|e| normalize(e).0));
    }
    (normals, edges)
}

/// The penetration depth of two polyhedra: the smallest extent over all separating axes.
fn depth_by_axes(a: &Shape, b: &Shape) -> f64 {
    let ((faces_a, edges_a), (faces_b, edges_b)) = (faces_and_edges(a), faces_and_edges(b));
    let mut least = f64::INFINITY;
    let mut consider = |n: Vec3| {
        for n in [n, scale(n, -1.0)] {
            least = least.min(reach(a, b, n));
        }
    };
    faces_a.into_iter().chain(faces_b).for_each(&mut consider);
    for e in &edges_a {
        for f in &edges_b {
            let (n, length) = normalize(cross(*e, *f));
            if length > 1e-9 {
                consider(n);
            }
        }
    }
    least
}

/// The penetration depth by sampling directions that cover the sphere. The best ones are refined by descent with
/// decreasing steps.
fn depth_by_sampling(a: &Shape, b: &Shape, hint: Vec3) -> f64 {
    const N: usize = 400;
    let golden = std::f64::consts::PI * (3.0 - 5f64.sqrt());
    let spiral = (0..N).map(|i| {
        let z = 1.0 - (2.0 * i as f64 + 1.0) / N as f64;
        let (sin, cos) = libm::sincos(golden * i as f64);
        let r = (1.0 - z * z).sqrt();
        [r * cos, r * sin, z]
    });
    let axes = [a, b].into_iter().flat_map(|s| [0, 1, 2].map(|i| s.axis(i)));
    let axes = axes.flat_map(|n| [n, scale(n, -1.0)]);
    let mut starts: Vec<(f64, Vec3)> = spiral.chain(axes).map(|n| (reach(a, b, n), n)).collect();
    starts.sort_by(|p, q| p.0.total_cmp(&q.0));
    starts.truncate(6);
    starts.push((reach(a, b, hint), hint));
    let mut least = f64::INFINITY;
    for (mut best, mut n) in starts {
        let mut step = 0.1;
        while step > 1e-9 {
            let f = frame(n);
            let mut better = false;
            for k in 0..8 {
                let (sin, cos) = libm::sincos(f64::from(k) * std::f64::consts::FRAC_PI_4);
                let side: Vec3 = std::array::from_fn(|i| cos * f[3 + i] + sin * f[6 + i]);
                let turned = normalize(add_scaled(n, side, step)).0;
                let here = reach(a, b, turned);
                if here < best {
                    (best, n, better) = (here, turned, true);
                }
            }
            step *= if better { 1.5 } else { 0.4 };
        }
        least = least.min(best);
    }
    least
}

fn solids() -> Vec<Solid> {
    let text = include_str!("../golden/pairs.txt");
    let mut out = Vec::new();
    for line in text.lines().take_while(|l| l.starts_with("mesh ")) {
        let parts: Vec<&str> = line.split('|').collect();
        let words: Vec<&str> = parts[0].split_whitespace().skip(2).collect();
        let numbers: Vec<f64> = words.iter().map(|w| w.parse().unwrap()).collect();
        let ints = |text: &str| -> Vec<i32> { text.split_whitespace().map(|w| w.parse().unwrap()).collect() };
        let mut solid = Solid {
            vert: rows::<3>(&numbers).to_vec(),
            face: ints(parts[1]).as_chunks().0.to_vec(),
            graph: ints(parts[2]),
            hull_faces: HullFaces::default(),
        };
        let hull = crate::geometry::Hull::from_graph(&solid.graph).unwrap();
        solid.hull_faces = HullFaces::from_hull(&solid.vert, &hull);
        out.push(solid);
    }
    out
}

impl Solid {
    fn mesh(&self) -> Mesh<'_> {
        let hull = crate::geometry::Hull::from_graph(&self.graph);
        Mesh { vert: &self.vert, face: &self.face, hull, hull_faces: Some(&self.hull_faces) }
    }
}

/// Results of the cases of a pair: numbers of cases, and largest errors.
#[derive(Default)]
struct Tally {
    separated: usize,
    deep: usize,
    /// Largest error of distances, and of depths above and below the reference, m.
    distance: f64,
    above: f64,
    below: f64,
    /// Largest distance of a witness point outside its body, m.
    outside: f64,
    worst: String,
}

fn shape<'a>(kind: i32, r: &mut Random, solids: &'a [Solid]) -> Shape<'a> {
    let flat = r.below(10) == 0;
    let size = [0; 3].map(|_| if flat { 10f64.powf(r.within(-4.0, 0.0)) } else { r.within(0.05, 0.6) });
    let mut s = Shape::new(kind, size, [0.0; 3], r.turn());
    if kind == geom::MESH {
        s.mesh = Some(solids[r.below(solids.len())].mesh());
        s.size = [0.4; 3];
    }
    s
}

/// The distance of a point outside a shape: the largest distance beyond the support planes of the given directions;
/// zero if it is inside all of them.
fn outside(s: &Shape, p: Vec3, directions: &[Vec3]) -> f64 {
    let beyond = |n: &Vec3| dot(*n, sub(p, farthest(s, *n)));
    directions.iter().map(beyond).fold(0.0, f64::max)
}

/// Error of a signed distance, m.
enum DistanceError {
    /// Error of the distance of separate bodies.
    Distance(f64),
    /// Error of the depth of overlapping bodies: positive if it is larger than the reference.
    Penetration(f64),
}

fn error(a: &Shape, b: &Shape, n: &Nearest, tolerance: f64) -> DistanceError {
    if n.dist > tolerance {
        let [p, q] = n.witness;
        let parted = -reach(a, b, n.normal);
        return DistanceError::Distance((norm(sub(q, p)) - n.dist).abs().max((parted - n.dist).abs()));
    }
    let corners = |s: &Shape| matches!(s.kind, geom::BOX | geom::MESH);
    let depth =
        if corners(a) && corners(b) { depth_by_axes(a, b) } else { depth_by_sampling(a, b, n.normal) };
    DistanceError::Penetration(-n.dist - depth)
}

/// Whether the signed distance of two shapes agrees with the reference.
pub(super) fn is_true(a: &Shape, b: &Shape) -> bool {
    let effort = super::precise_settings().effort;
    let found = nearest(&mut Convex::new(a), &mut Convex::new(b), 1e3, effort, &mut ConvexScratch::default());
    found.is_some_and(|n| {
        let (DistanceError::Distance(error) | DistanceError::Penetration(error)) =
            error(a, b, &n, effort.tolerance);
        error.abs() < 1e-9 * (norm(a.size) + norm(b.size))
    })
}

fn check_pair(kind1: i32, kind2: i32, cases: usize) -> Tally {
    let solids = solids();
    let (mut r, mut scratch, mut t) =
        (Random((kind1 * 8 + kind2) as u64), ConvexScratch::default(), Tally::default());
    let settings = super::precise_settings();
    let directions: Vec<Vec3> = (0..40).map(|_| r.direction()).collect();
    for case in 0..cases {
        let (a, mut b) = (shape(kind1, &mut r, &solids), shape(kind2, &mut r, &solids));
        let far = if r.below(50) == 0 { 0.0 } else { r.within(0.0, 1.2) };
        b.pos = scale(r.direction(), far);
        if r.below(4) == 0 {
            // Touching, just separate, or just overlapping: the bodies are separated along a random direction by the
            // extent along it.
            let n = r.direction();
            let gap = if r.below(2) == 0 { 0.0 } else { 10f64.powf(r.within(-9.0, -3.0)) };
            b.pos = scale(n, reach(&a, &b, n) + if r.below(2) == 0 { gap } else { -gap });
        }
        let found = nearest(&mut Convex::new(&a), &mut Convex::new(&b), 1e3, settings.effort, &mut scratch);
        let Some(n) = found else {
            t.worst = format!("case {case}, nothing found: {a:?} {b:?}");
            t.distance = f64::INFINITY;
            continue;
        };
        let most = |t: &mut Tally, slot: fn(&mut Tally) -> &mut f64, x: f64, what: &str| {
            if x.is_nan() || x > *slot(t) {
                *slot(t) = x;
                if x > 2.0 * settings.effort.tolerance {
                    t.worst = format!("{x:e} {what} in case {case}: {a:?} {b:?} {n:?}");
                }
            }
        };
        let [p, q] = n.witness;
        most(
            &mut t,
            |t| &mut t.outside,
            outside(&a, p, &directions).max(outside(&b, q, &directions)),
            "outside",
        );
        match error(&a, &b, &n, settings.effort.tolerance) {
            DistanceError::Distance(error) => {
                most(&mut t, |t| &mut t.distance, error, "distance");
                t.separated += 1;
            }
            DistanceError::Penetration(error) => {
                most(&mut t, |t| &mut t.above, error, "deeper than the reference");
                most(&mut t, |t| &mut t.below, -error, "less deep than the reference");
                t.deep += 1;
            }
        }
    }
    t
}

const PAIRS: [(i32, i32); 15] = [
    (geom::SPHERE, geom::ELLIPSOID),
    (geom::SPHERE, geom::MESH),
    (geom::CAPSULE, geom::ELLIPSOID),
    (geom::CAPSULE, geom::CYLINDER),
    (geom::CAPSULE, geom::MESH),
    (geom::ELLIPSOID, geom::ELLIPSOID),
    (geom::ELLIPSOID, geom::CYLINDER),
    (geom::ELLIPSOID, geom::BOX),
    (geom::ELLIPSOID, geom::MESH),
    (geom::CYLINDER, geom::CYLINDER),
    (geom::CYLINDER, geom::BOX),
    (geom::CYLINDER, geom::MESH),
    (geom::BOX, geom::BOX),
    (geom::BOX, geom::MESH),
    (geom::MESH, geom::MESH),
];

/// The number of random configurations.
fn cases(usual: usize) -> usize {
    std::env::var("LABSPEC_CASES").ok().and_then(|n| n.parse().ok()).unwrap_or(usual)
}

#[test]
fn signed_distances_are_true() {
    let cases = cases(300);
    let mut table = String::new();
    let mut wrong = String::new();
    for (kind1, kind2) in PAIRS {
        let t = check_pair(kind1, kind2, cases);
        table += &format!(
            "| {}-{} | {} | {:.0e} | {} | {:.0e} | {:.0e} | {:.0e} |\n",
            super::KINDS[kind1 as usize],
            super::KINDS[kind2 as usize],
            t.separated,
            t.distance,
            t.deep,
            t.above,
            t.below,
            t.outside
        );
        if t.distance.max(t.above).max(t.below).max(t.outside) > 2e-6 {
            wrong += &format!("{kind1} {kind2}: {}\n", t.worst);
        }
    }
    println!("| pair | apart | distance | overlapping | deeper | less deep | outside |\n{table}\n{wrong}");
    assert!(wrong.is_empty());
}
/// The depth of height field prisms agrees with the separating axes, because prisms are polyhedra too.
#[test]
fn prisms_of_the_ground_are_true() {
    let solids = solids();
    let (mut r, mut scratch) = (Random(77), ConvexScratch::default());
    let mut deep = 0;
    for case in 0..cases(2000) {
        let mut b = shape([geom::BOX, geom::MESH][case % 2], &mut r, &solids);
        let base = [[0.0, 0.0], [0.2, 0.0], [0.0, 0.15]];
        let low = base.map(|[x, y]| [x, y, -0.3]);
        let top = base.map(|[x, y]| [x, y, r.within(0.0, 0.5)]);
        let corners = [low[0], low[1], low[2], top[0], top[1], top[2]];
        b.pos = scale(r.direction(), r.within(0.0, 0.8));
        let mut prism = Convex::prism(corners);
        let found = nearest(&mut prism, &mut Convex::new(&b), 1e3, super::settings().effort, &mut scratch);
        let n = found.unwrap();
        let reach = |n: Vec3| {
            let farthest_corner = corners.iter().map(|c| dot(*c, n)).fold(f64::NEG_INFINITY, f64::max);
            farthest_corner - dot(n, farthest(&b, scale(n, -1.0)))
        };
        if n.dist > 1e-6 {
            let [p, q] = n.witness;
            assert!(
                (norm(sub(q, p)) - n.dist).abs() < 1e-12 && (reach(n.normal) + n.dist).abs() < 1e-9,
                "{case}"
            );
            continue;
        }
        deep += 1;
        let edge = |i: usize, j: usize| normalize(sub(corners[i], corners[j])).0;
        let axes_of_first =
            [edge(0, 1), edge(1, 2), edge(2, 0), edge(3, 4), edge(4, 5), edge(5, 3), [0.0, 0.0, 1.0]];
        // The normal of every side of the prism is perpendicular to two of its edges.
        let (mut axes, others) = faces_and_edges(&b);
        for e in axes_of_first {
            let across = axes_of_first.iter().chain(&others).map(|f| normalize(cross(e, *f)));
            axes.extend(across.filter(|(_, sine)| *sine > 1e-9).map(|(n, _)| n));
        }
        let least =
            axes.iter().flat_map(|&n| [reach(n), reach(scale(n, -1.0))]).fold(f64::INFINITY, f64::min);
        assert!((least + n.dist).abs() < 1e-12, "{case}: {least} {n:?}");
    }
    assert!(deep > 500, "{deep}");
}

/// Contacts of faces: there are at most four, all below both surfaces. None is deeper than the translation along its
/// normal that separates the bodies. If the bodies overlap, there is at least one.
#[test]
fn contacts_of_faces_are_below_both_surfaces() {
    let solids = solids();
    let (mut r, mut work) = (Random(5), crate::geometry::Narrow::default());
    let (mut several, mut one) = (0, 0);
    for case in 0..cases(4000) {
        let kinds =
            [(geom::BOX, geom::MESH), (geom::MESH, geom::MESH), (geom::CYLINDER, geom::BOX)][case % 3];
        let (a, mut b) = (shape(kinds.0, &mut r, &solids), shape(kinds.1, &mut r, &solids));
        if r.below(2) == 0 {
            // The bodies lie almost flat on each other.
            let tilt = quat_to_mat(quat_axis_angle(r.direction(), r.within(0.0, 0.05)));
            b.mat = mat_mul(&tilt, &a.mat);
        }
        let n = if r.below(2) == 0 { a.axis(r.below(3)) } else { r.direction() };
        b.pos = scale(n, reach(&a, &b, n) - r.within(0.0, 0.05));
        work.touches.clear();
        let method = crate::geometry::pair::method(a.kind, b.kind).unwrap();
        let settings = super::settings();
        crate::geometry::pair::contacts(
            method,
            &a,
            &b,
            0.0,
            || settings,
            &mut work.convex,
            &mut work.touches,
        );
        let deep =
            nearest(&mut Convex::new(&a), &mut Convex::new(&b), 0.0, settings.effort, &mut work.convex);
        let depth = deep.map_or(0.0, |n| -n.dist);
        let say = || format!("case {case}: {:?} {depth} {a:?} {b:?}", work.touches);
        assert!(work.touches.len() <= 4 && (depth < 1e-9 || !work.touches.is_empty()), "{}", say());
        for t in &work.touches {
            assert!(t.dist < 0.0 && (norm(t.normal) - 1.0).abs() < 1e-12, "{}", say());
            // The depth is measured along the normal of one face, and the contact normal is that of the other: they
            // differ by at most 5 degrees.
            assert!(-0.99 * t.dist <= reach(&a, &b, t.normal) + 1e-9, "{}", say());
            let (beyond_a, beyond_b) = (
                dot(t.normal, sub(t.pos, farthest(&a, t.normal))),
                dot(t.normal, sub(farthest(&b, scale(t.normal, -1.0)), t.pos)),
            );
            assert!(beyond_a.max(beyond_b) < 1e-9 - 0.01 * t.dist, "{}", say());
        }
        if work.touches.len() > 1 {
            several += 1;
        } else {
            one += usize::from(!work.touches.is_empty());
        }
    }
    assert!(several > 500 && one > 100, "{several} {one}");
}

/// The distance of a height field is that of its nearest or deepest prism.
#[test]
fn distances_of_height_fields_are_those_of_their_prisms() {
    let solids = solids();
    let (mut r, mut work) = (Random(9), crate::geometry::Narrow::default());
    let data: Vec<f64> = (0..35).map(|_| r.within(0.0, 1.0)).collect();
    let settings = super::settings();
    for case in 0..400 {
        let kind =
            [geom::SPHERE, geom::CAPSULE, geom::ELLIPSOID, geom::CYLINDER, geom::BOX, geom::MESH][case % 6];
        let mut ground = Shape::new(geom::HFIELD, [1.2, 0.9, 0.3], r.vector(-0.2, 0.2), r.turn());
        ground.field =
            Some(crate::geometry::HeightField { size: [1.2, 0.9, 0.5, 0.3], nrow: 5, ncol: 7, data: &data });
        let mut b = shape(kind, &mut r, &solids);
        b.pos = r.vector(-2.5, 2.5);
        let most = [0.0, 0.3, 1e3][r.below(3)];
        let found = crate::geometry::shape_distance(&ground, &b, most, &settings, &mut work).unwrap();
        let mut least = f64::INFINITY;
        for row in 0..4 {
            for col in 0..6 {
                let [p, q, s, t] = [(row, col), (row, col + 1), (row + 1, col), (row + 1, col + 1)]
                    .map(|(i, j)| ground.field().point(i, j));
                for top in [[p, s, t], [p, q, t]] {
                    let low = top.map(|[x, y, _]| [x, y, -0.3]);
                    let corners = [low[0], low[1], low[2], top[0], top[1], top[2]].map(|p| ground.world(p));
                    // In the world frame a prism is a mesh without faces.
                    let vert = corners.to_vec();
                    let mut prism = Shape::new(geom::MESH, [1.0; 3], [0.0; 3], EYE);
                    prism.mesh = Some(Mesh { vert: &vert, ..Default::default() });
                    let (mut u, mut v) = (Convex::new(&prism), Convex::new(&b));
                    if let Some(n) = nearest(&mut u, &mut v, 1e3, settings.effort, &mut work.convex) {
                        least = least.min(n.dist);
                    }
                }
            }
        }
        let expected = least.min(most);
        assert!((found.dist - expected).abs() < 2e-6, "case {case}: {} {expected} {b:?}", found.dist);
        let [p, q] = found.fromto;
        if expected < most && expected > 1e-3 {
            assert!((norm(sub(q, p)) - expected).abs() < 1e-6, "case {case}: {found:?} {expected}");
        }
    }
}
