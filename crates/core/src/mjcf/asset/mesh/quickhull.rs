//! Convex hulls by quickhull (Barber, Dobkin, Huhdanpaa 1996, *The quickhull algorithm for convex hulls*, ACM TOMS 22).
//!
//! Heights are computed in integers. Along each axis, points are rounded to a grid of 2^40 steps, which is finer than single
//! precision. A height over a plane then fits into 127 bits. Every decision is therefore exact: coplanar points are coplanar, and
//! the algorithm is correct for every point cloud, however degenerate. (Stretching an axis does not change a hull, so each axis
//! has its own grid.)

use crate::mjcf::gather::listed;
use labspec_finding::order;
use std::collections::{BTreeMap, BinaryHeap};

use crate::math::Vec3;

/// Bits of a grid coordinate. Sums of three products of three differences stay below 2^127.
const BITS: i32 = 40;
/// Limit for the number of tests of a point against a plane. Points on a sphere, the worst realistic case, take 40 tests each.
const MOST_TESTS: usize = 400_000_000;
/// Marks the absence of a face.
const NONE: u32 = u32::MAX;

/// The convex hull of some points.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct ConvexHull {
    /// The indexes of the points at the corners, ascending.
    pub(crate) vertex: Vec<u32>,
    /// The indexes of the points at the corners of each triangle, counterclockwise from outside. Flat faces with more corners are
    /// triangle fans.
    pub(crate) face: Vec<[i32; 3]>,
}

/// The reason why a hull cannot be computed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Flat {
    /// All points coincide.
    Point,
    /// All points lie on a line.
    Line,
    /// All points lie in a plane.
    Plane,
    /// The computation exceeds the limit of tests.
    Endless,
}

impl ConvexHull {
    /// The hull of finite points. If `most` is given, it has at most this many corners: those farthest outside are added first.
    pub(crate) fn from_points(points: &[Vec3], most: Option<usize>) -> Result<ConvexHull, Flat> {
        let mut growing = PartialHull::new(points)?;
        growing.add_farthest_points(most.unwrap_or(usize::MAX))?;
        Ok(growing.finish())
    }

    /// `mesh_graph`: the counts of vertices and triangles; the address of the neighbours of each vertex; the vertices;
    /// the neighbours, each list terminated by -1; the triangles.
    pub(crate) fn graph(&self) -> Vec<i32> {
        let place = |v: i32| self.vertex.partition_point(|&x| (x as i32) < v) as i32;
        let mut edges: Vec<(i32, i32)> =
            listed(self.face.iter().flat_map(|&[a, b, c]| [(a, b), (b, c), (c, a)]));
        order::sort_by(&mut edges, Ord::cmp);
        let mut graph = vec![self.vertex.len() as i32, self.face.len() as i32];
        let (mut starts, mut lists) = (Vec::new(), Vec::with_capacity(self.vertex.len() + edges.len()));
        let mut rest = edges.as_slice();
        for &v in &self.vertex {
            starts.push(lists.len() as i32);
            let (of_vertex, after) = rest.split_at(rest.partition_point(|e| e.0 <= v as i32));
            lists.extend(of_vertex.iter().map(|e| place(e.1)));
            lists.push(-1);
            rest = after;
        }
        graph.extend(starts);
        graph.extend(self.vertex.iter().map(|&v| v as i32));
        graph.extend(lists);
        graph.extend(self.face.as_flattened());
        graph
    }
}

type Point = [i64; 3];

/// A plane through a grid point. Points above it are outside.
#[derive(Clone, Copy, Debug)]
struct HullPlane {
    origin: Point,
    normal: [i128; 3],
    /// The length of the normal, in world units.
    length: f64,
}

#[derive(Debug)]
struct HullFace {
    corner: [u32; 3],
    /// The adjacent faces at the edges from each corner to the next.
    beyond: [u32; 3],
    plane: HullPlane,
    /// The points above this face that are above no earlier face. The highest is the last.
    above: Vec<u32>,
    is_on_hull: bool,
}

struct PartialHull {
    points: Vec<Point>,
    /// Grid steps per unit of the world.
    steps: Vec3,
    faces: Vec<HullFace>,
    corners: usize,
    /// Faces with points above them, ordered by the height of the highest point.
    open: BinaryHeap<(u64, std::cmp::Reverse<u32>)>,
    tests: usize,
    /// For each point, the new face that starts there.
    begins: Vec<u32>,
}

impl PartialHull {
    /// Starts with a tetrahedron of distant points.
    fn new(points: &[Vec3]) -> Result<PartialHull, Flat> {
        let (points, steps) = on_grid(points);
        let indices = || 0..points.len() as u32;
        let mut g = PartialHull {
            steps,
            faces: Vec::new(),
            corners: 4,
            open: BinaryHeap::new(),
            tests: 0,
            begins: vec![NONE; points.len()],
            points: Vec::new(),
        };
        let point_at = |i: u32| points.get(i as usize).copied().unwrap_or_default();
        let (Some(a), Some(b)) =
            (indices().min_by_key(|&i| point_at(i)), indices().max_by_key(|&i| point_at(i)))
        else {
            return Err(Flat::Point);
        };
        if point_at(a) == point_at(b) {
            return Err(Flat::Point);
        }
        let off_line = |i: u32| {
            normal(point_at(a), point_at(b), point_at(i))
                .iter()
                .map(|&x| (x as f64) * (x as f64))
                .sum::<f64>()
        };
        let farthest = indices().map(|i| (off_line(i).to_bits(), std::cmp::Reverse(i))).max();
        let Some(c) = farthest.filter(|&(d, _)| d > 0).map(|(_, i)| i.0) else { return Err(Flat::Line) };
        let base = g.plane_of([point_at(a), point_at(b), point_at(c)]);
        let off_plane = |i: u32| (base.height(point_at(i)).unsigned_abs(), std::cmp::Reverse(i));
        let Some(d) = indices().map(off_plane).max().filter(|x| x.0 > 0).map(|x| x.1.0) else {
            return Err(Flat::Plane);
        };
        // The outer side of the base is opposite to the fourth corner.
        let (b, c) = if base.height(point_at(d)) > 0 { (c, b) } else { (b, c) };
        g.points = points;
        // Each face with its adjacent faces.
        let sides =
            [([a, b, c], [1, 2, 3]), ([b, a, d], [0, 3, 2]), ([c, b, d], [0, 1, 3]), ([a, c, d], [0, 2, 1])];
        for (corner, beyond) in sides {
            g.add(corner, beyond);
        }
        g.assign_to_faces(listed(0..g.points.len() as u32), 0);
        Ok(g)
    }

    fn point(&self, i: u32) -> Point {
        self.points.get(i as usize).copied().unwrap_or_default()
    }

    fn face(&self, i: u32) -> Option<&HullFace> {
        self.faces.get(i as usize)
    }

    fn plane_of(&self, [a, b, c]: [Point; 3]) -> HullPlane {
        let normal = normal(a, b, c);
        let length = (0..3).map(|i| normal[i] as f64 * self.steps[i]).map(|x| x * x).sum::<f64>();
        HullPlane { origin: a, normal, length: libm::sqrt(length) }
    }

    fn add(&mut self, corner: [u32; 3], beyond: [u32; 3]) {
        let plane = self.plane_of(corner.map(|i| self.point(i)));
        self.faces.push(HullFace { corner, beyond, plane, above: Vec::new(), is_on_hull: true });
    }

    /// Assigns each point to the first face, from index `first` on, that it is above. Points above no face are inside.
    fn assign_to_faces(&mut self, points: Vec<u32>, first: usize) {
        let mut highest: Vec<i128> = vec![0; self.faces.len() - first];
        for p in points {
            let position = self.point(p);
            for (face, highest) in self.faces.iter_mut().skip(first).zip(&mut highest) {
                self.tests += 1;
                let height = face.plane.height(position);
                if height > 0 {
                    face.above.push(p);
                    if height > *highest {
                        *highest = height; // the new point is last, as required
                    } else if let [.., second, last] = face.above.as_mut_slice() {
                        std::mem::swap(second, last);
                    }
                    break;
                }
            }
        }
        (first..self.faces.len()).for_each(|i| self.open(i));
    }

    /// Adds a face to the queue if there are points above it.
    fn open(&mut self, i: usize) {
        let Some(face) = self.faces.get(i) else { return };
        if let Some(&highest) = face.above.last() {
            let height = face.plane.height(self.point(highest)) as f64 / face.plane.length;
            self.open.push((height.to_bits(), std::cmp::Reverse(i as u32)));
        }
    }

    /// Removes the faces that are covered.
    fn compact(&mut self) {
        let mut place = 0;
        let places: Vec<u32> = listed(self.faces.iter().map(|f| {
            if f.is_on_hull {
                place += 1;
                place - 1
            } else {
                NONE
            }
        }));
        self.faces.retain(|f| f.is_on_hull);
        for face in &mut self.faces {
            face.beyond = face.beyond.map(|i| places.get(i as usize).copied().unwrap_or(NONE));
        }
        self.open.clear();
        (0..self.faces.len()).for_each(|i| self.open(i));
    }

    /// Adds the point that is farthest outside, until no point is outside or the limit of corners is reached.
    fn add_farthest_points(&mut self, most: usize) -> Result<(), Flat> {
        while self.corners < most
            && let Some((_, std::cmp::Reverse(start))) = self.open.pop()
        {
            let Some(&apex) = self.face(start).filter(|f| f.is_on_hull).and_then(|f| f.above.last()) else {
                continue;
            };
            if self.tests > MOST_TESTS {
                return Err(Flat::Endless);
            }
            self.corners += 1;
            self.replace_visible_faces(start, apex);
            // A closed surface of triangles has twice as many faces as corners, minus four.
            if self.faces.len() > 8 * self.corners + 1000 {
                self.compact();
            }
        }
        Ok(())
    }

    /// Replaces the faces that are visible from a point by a cone from their border to the point.
    fn replace_visible_faces(&mut self, start: u32, apex: u32) {
        let position = self.point(apex);
        let mut border: Vec<(u32, u32, u32)> = Vec::new();
        let mut orphans = Vec::new();
        let mut stack = vec![start];
        if let Some(face) = self.faces.get_mut(start as usize) {
            face.is_on_hull = false;
        }
        while let Some(i) = stack.pop() {
            let Some(face) = self.faces.get_mut(i as usize) else { continue };
            orphans.append(&mut face.above);
            let (corner, beyond) = (face.corner, face.beyond);
            for k in 0..3 {
                let Some(other) = self.faces.get_mut(beyond[k] as usize).filter(|f| f.is_on_hull) else {
                    continue;
                };
                self.tests += 1;
                if other.plane.height(position) > 0 {
                    other.is_on_hull = false;
                    stack.push(beyond[k]);
                }
            }
            for k in 0..3 {
                border.push((corner[k], corner[(k + 1) % 3], beyond[k]));
            }
        }
        border.retain(|&(_, _, outer)| self.face(outer).is_some_and(|f| f.is_on_hull));
        let first = self.faces.len();
        for (i, &(a, _, _)) in border.iter().enumerate() {
            if let Some(begins) = self.begins.get_mut(a as usize) {
                *begins = (first + i) as u32;
            }
        }
        for (i, &(a, b, outer)) in border.iter().enumerate() {
            let new = (first + i) as u32;
            let follows = self.begins.get(b as usize).copied().unwrap_or(NONE);
            // The preceding face is set when that face is linked.
            self.add([a, b, apex], [outer, follows, NONE]);
            if let Some(outer) = self.faces.get_mut(outer as usize)
                && let Some(k) = (0..3).find(|&k| outer.corner[k] == b && outer.corner[(k + 1) % 3] == a)
            {
                outer.beyond[k] = new;
            }
        }
        for new in first..self.faces.len() {
            let follows = self.faces.get(new).map_or(NONE, |f| f.beyond[1]);
            if let Some(next) = self.faces.get_mut(follows as usize) {
                next.beyond[2] = new as u32;
            }
        }
        orphans.retain(|&p| p != apex);
        self.assign_to_faces(orphans, first);
    }

    /// Merges coplanar triangles into one flat face. A corner is a point where three or more flat faces meet.
    fn finish(self) -> ConvexHull {
        // The flat face to which each triangle belongs.
        let mut side: Vec<u32> = vec![NONE; self.faces.len()];
        let mut sides = 0;
        for start in 0..self.faces.len() {
            if side[start] != NONE || !self.faces[start].is_on_hull {
                continue;
            }
            let plane = self.faces[start].plane;
            side[start] = sides;
            let mut stack = vec![start];
            while let Some(i) = stack.pop() {
                for next in self.faces[i].beyond.map(|b| b as usize) {
                    let flat = |f: &HullFace| f.corner.iter().all(|&c| plane.height(self.point(c)) == 0);
                    if side.get(next) == Some(&NONE) && self.faces.get(next).is_some_and(flat) {
                        side[next] = sides;
                        stack.push(next);
                    }
                }
            }
            sides += 1;
        }
        // Maps each corner of a flat face to the next.
        let mut borders: BTreeMap<(u32, u32), u32> = BTreeMap::new();
        // The number of flat faces that meet at each point.
        let mut meet = vec![0_u32; self.points.len()];
        for (face, &this_side) in self.faces.iter().zip(&side).filter(|(f, _)| f.is_on_hull) {
            for k in 0..3 {
                if side.get(face.beyond[k] as usize) != Some(&this_side) {
                    borders.insert((this_side, face.corner[k]), face.corner[(k + 1) % 3]);
                    meet[face.corner[k] as usize] += 1;
                }
            }
        }
        let is_corner = |v: u32| meet.get(v as usize).is_some_and(|&n| n > 2);
        let mut face = Vec::new();
        for side in 0..sides {
            let corners = || borders.range((side, 0)..=(side, NONE)).map(|(&(_, v), _)| v);
            let Some(first) = corners().find(|&v| is_corner(v)) else { continue };
            let mut last = None;
            let mut current = first;
            for _ in 0..corners().count() {
                current = borders.get(&(side, current)).copied().unwrap_or(first);
                if current == first {
                    break;
                }
                if is_corner(current) {
                    face.extend(last.map(|last: u32| [first as i32, last as i32, current as i32]));
                    last = Some(current);
                }
            }
        }
        order::sort_by(&mut face, Ord::cmp);
        let vertex = listed((0..meet.len() as u32).filter(|&v| is_corner(v)));
        ConvexHull { vertex, face }
    }
}

impl HullPlane {
    /// The height of a point above the plane, multiplied by the length of the normal, in grid units.
    fn height(&self, p: Point) -> i128 {
        (0..3).map(|i| self.normal[i] * i128::from(p[i] - self.origin[i])).sum()
    }
}

/// (b - a) × (c - a)
fn normal(a: Point, b: Point, c: Point) -> [i128; 3] {
    let [u, v]: [[i128; 3]; 2] = [b, c].map(|p| std::array::from_fn(|i| i128::from(p[i] - a[i])));
    [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]
}

/// The points on the grid, and the grid steps per unit.
fn on_grid(points: &[Vec3]) -> (Vec<Point>, Vec3) {
    let lower: Vec3 = std::array::from_fn(|i| points.iter().fold(f64::INFINITY, |x, p| x.min(p[i])));
    let upper: Vec3 = std::array::from_fn(|i| points.iter().fold(f64::NEG_INFINITY, |x, p| x.max(p[i])));
    // A power of two, so that scaling is exact.
    let steps = [0, 1, 2].map(|i| libm::ldexp(1.0, BITS - libm::frexp(upper[i] - lower[i]).1));
    let grid = |p: &Vec3| std::array::from_fn(|i| libm::round((p[i] - lower[i]) * steps[i]) as i64);
    (listed(points.iter().map(grid)), steps)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{cross, dot, sub};
    use proptest::prelude::*;

    /// Checks that a hull is closed, convex and contains all points, and has the number of triangles of Euler's formula.
    fn check_hull(points: &[Vec3], hull: &ConvexHull, whole: bool) {
        let (v, f) = (hull.vertex.len(), hull.face.len());
        assert_eq!(f, 2 * v - 4);
        let mut edges: Vec<(i32, i32)> =
            hull.face.iter().flat_map(|&[a, b, c]| [(a, b), (b, c), (c, a)]).collect();
        edges.sort_unstable();
        for &(a, b) in &edges {
            assert!(edges.binary_search(&(b, a)).is_ok());
        }
        edges.dedup();
        assert_eq!(edges.len(), 3 * f);
        let size = points.iter().flatten().fold(0.0_f64, |s, x| s.max(x.abs()));
        for face in &hull.face {
            let [a, b, c] = face.map(|i| points[i as usize]);
            let n = cross(sub(b, a), sub(c, a));
            for p in points.iter().filter(|_| whole) {
                assert!(dot(n, sub(*p, a)) <= 1e-11 * size * size * size, "{face:?} {p:?}");
            }
        }
    }

    fn cube(n: i32) -> Vec<Vec3> {
        let range = || (0..=n).map(f64::from);
        range().flat_map(|x| range().flat_map(move |y| range().map(move |z| [x, 2.0 * y, 3.0 * z]))).collect()
    }

    #[test]
    fn points_on_sides_and_edges_are_no_corners() {
        for n in 1..6 {
            let points = cube(n);
            let hull = ConvexHull::from_points(&points, None).unwrap();
            assert_eq!((hull.vertex.len(), hull.face.len()), (8, 12), "{n}");
            check_hull(&points, &hull, true);
        }
    }

    #[test]
    fn flat_clouds_are_reported() {
        assert_eq!(ConvexHull::from_points(&[], None), Err(Flat::Point));
        assert_eq!(ConvexHull::from_points(&[[1.0; 3]; 9], None), Err(Flat::Point));
        assert_eq!(ConvexHull::from_points(&[[0.0; 3], [1.0; 3], [2.0; 3], [0.5; 3]], None), Err(Flat::Line));
        let flat: Vec<Vec3> = cube(3).into_iter().map(|[x, y, _]| [x, y, x + 0.5 * y]).collect();
        assert_eq!(ConvexHull::from_points(&flat, None), Err(Flat::Plane));
    }

    #[test]
    fn a_limited_hull_has_no_more_corners() {
        let points: Vec<Vec3> = (0..500)
            .map(|i| {
                let (h, a) = (1.0 - 2.0 * (f64::from(i) + 0.5) / 500.0, 2.4 * f64::from(i));
                let r = (1.0 - h * h).sqrt();
                [r * a.cos(), r * a.sin(), h]
            })
            .collect();
        let whole = ConvexHull::from_points(&points, None).unwrap();
        assert_eq!(whole.vertex.len(), 500);
        check_hull(&points, &whole, true);
        for most in [4, 5, 20, 100] {
            let hull = ConvexHull::from_points(&points, Some(most)).unwrap();
            assert_eq!(hull.vertex.len(), most);
            check_hull(&points, &hull, false);
        }
    }

    #[test]
    fn graphs_list_neighbours() {
        let hull = ConvexHull::from_points(
            &[[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.1; 3]],
            None,
        )
        .unwrap();
        assert_eq!(
            hull.graph(),
            [
                4, 4, 0, 4, 8, 12, 0, 1, 2, 3, 1, 2, 3, -1, 0, 2, 3, -1, 0, 1, 3, -1, 0, 1, 2, -1, 0, 1, 3,
                0, 2, 1, 0, 3, 2, 1, 2, 3
            ]
        );
    }

    proptest! {
        #![proptest_config(ProptestConfig { cases: 200, failure_persistence: None, ..ProptestConfig::default() })]
        /// A small set of coordinates causes many coincidences.
        #[test]
        fn degenerate_clouds_have_hulls(points in prop::collection::vec(prop::array::uniform3(-3..4_i32), 4..60)) {
            let points: Vec<Vec3> = points.into_iter().map(|p| p.map(|x| f64::from(x) * 0.1)).collect();
            if let Ok(hull) = ConvexHull::from_points(&points, None) {
                check_hull(&points, &hull, true);
                prop_assert_eq!(&ConvexHull::from_points(&points, None).unwrap(), &hull);
            }
        }

        #[test]
        fn clouds_of_single_precision_have_hulls(
            points in prop::collection::vec(prop::array::uniform3(-1.0_f32..1.0), 4..100),
            stretch in prop::array::uniform3(-20..20_i32),
        ) {
            let points: Vec<Vec3> =
                points.into_iter().map(|p| [0, 1, 2].map(|i| f64::from(p[i]) * 2f64.powi(stretch[i]))).collect();
            if let Ok(hull) = ConvexHull::from_points(&points, None) {
                prop_assert_eq!(hull.face.len(), 2 * hull.vertex.len() - 4);
            }
        }
    }
}
