//! Penetration depth of two convex bodies: the boundary point of their Minkowski difference a - b nearest to the
//! origin, found with an expanding polytope (van den Bergen, *Proximity queries and penetration depth computation on
//! 3D game objects*, Game Developers Conference 2001).
//!
//! The polytope is the hull of support points. The offset of each face is a lower bound of the depth along its
//! normal. The support point along this normal gives an upper bound of the depth over all directions. The face with
//! the lowest bound is expanded to its support point until both bounds agree. For round bodies Newton's method
//! (`polish`) refines the result. Offsets of faces are signed: the algorithm also works if the origin is on the
//! boundary of the polytope or slightly outside. A negative upper bound means that the bodies are separate.

use super::difference::{Limits, ROUNDING, Vertex, support};
use super::polish::{Reach, minimize_reach};
use super::simplex::{Corral, barycentric};
use super::support::ConvexBody;
use crate::math::*;

/// A triangle is degenerate if the sine of the angle between two edges is smaller than this; a flatter solid has no
/// volume.
const SLIVER: f64 = 1e-10;
/// Faces belong to the same flat side if their normals differ by less than this, and their offsets by less than this
/// fraction of the size.
const SAME_SIDE: f64 = 1e-9;

/// A plane: unit normal and signed offset from the origin, m.
#[derive(Clone, Copy, Debug, PartialEq)]
struct FacePlane {
    normal: Vec3,
    offset: f64,
}

/// A triangle of the polytope. Its three half-edges run counterclockwise as seen from outside; half-edge k of face f is
/// number 4 f + k.
#[derive(Clone, Copy, Debug, PartialEq)]
struct PolytopeFace {
    plane: FacePlane,
    /// Start vertex of each half-edge.
    from: [u32; 3],
    /// The half-edge of the neighbouring face in the opposite direction.
    twin: [u32; 3],
    /// Whether the face is on the surface of the polytope.
    is_on_surface: bool,
}

/// The polytope. Its memory is reused, so that calls do not allocate.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct ConvexScratch {
    vertices: Vec<Vertex>,
    faces: Vec<PolytopeFace>,
    /// Candidates for the face with the lowest bound.
    low: Vec<u32>,
    /// For each vertex, the new face whose outer edge starts there.
    fan: Vec<u32>,
    /// Half-edges still to be crossed in the search for visible faces, and the half-edges on the border of these faces.
    pending: Vec<u32>,
    border: Vec<u32>,
    /// Work units done so far.
    pub(crate) cost: u64,
    /// Limit of work units: the search in a height field stops when it is reached.
    pub(crate) most: Option<u64>,
}

/// The depth of round bodies is computed to `ccd_tolerance`, but at least to this fraction of the depth. Otherwise
/// the direction would be arbitrary for bodies that barely touch.
const MIN_RELATIVE_ACCURACY: f64 = 0.01;

const NONE: u32 = u32::MAX;

/// Face and position in the face of a half-edge.
fn place(edge: u32) -> (usize, usize) {
    ((edge >> 2) as usize, (edge & 3) as usize)
}

/// The penetration depth of two bodies. The hull of the corral contains the origin, or almost contains it. Returns
/// `None` if the difference has no volume.
pub(super) fn depth(
    corral: &Corral,
    a: &mut ConvexBody,
    b: &mut ConvexBody,
    limits: Limits,
    p: &mut ConvexScratch,
) -> Option<Reach> {
    p.vertices.clear();
    p.vertices.extend_from_slice(corral.vertices());
    let size = p.span_space(a, b)?;
    p.tetrahedron();
    let rounding = ROUNDING * size;
    let mut left = limits.iterations.max(1);
    let corners = a.discrete() && b.discrete();
    let mut tolerance = if corners { 0.0 } else { limits.tolerance };
    let (face, plane) = p.expand(a, b, [rounding, tolerance], f64::INFINITY, &mut left)?;
    if corners {
        return Some(Reach { normal: plane.normal, height: plane.offset, witness: p.witness(face, size) });
    }
    let mut least = minimize_reach(a, b, plane.normal, limits);
    while left > 0 && least.height > 0.0 && MIN_RELATIVE_ACCURACY * least.height < tolerance {
        tolerance = MIN_RELATIVE_ACCURACY * least.height;
        // This support point is a vertex of the expanded polytope, so no nearby face has a bound much below its
        // height.
        p.vertices.push(support(a, b, least.normal));
        let seen = p.facing(rounding);
        if seen.is_some_and(|face| !p.grow(face, rounding)) {
            break;
        }
        match p.expand(a, b, [rounding, tolerance], least.height, &mut left) {
            Some((_, lower)) => least = minimize_reach(a, b, lower.normal, limits),
            None => break,
        }
    }
    Some(least)
}

impl ConvexScratch {
    fn point(&self, v: u32) -> Vec3 {
        self.vertices[v as usize].point
    }

    fn corners(&self, face: u32) -> [Vec3; 3] {
        self.faces[face as usize].from.map(|v| self.point(v))
    }

    /// Adds support points until four vertices span a tetrahedron. Returns the largest distance of a vertex from the
    /// origin; `None` if the difference has no volume.
    fn span_space(&mut self, a: &mut ConvexBody, b: &mut ConvexBody) -> Option<f64> {
        let mut size = self.vertices.iter().fold(0.0_f64, |s, v| s.max(norm(v.point)));
        while !self.spans() {
            self.vertices.pop();
        }
        if self.vertices.len() == 4 {
            return Some(size);
        }
        while self.vertices.len() < 4 {
            let base = self.point(0);
            let edges = [1, 2].map(|k| self.vertices.get(k).map_or([0.0; 3], |v| sub(v.point, base)));
            let directions: &[Vec3] = match self.vertices.len() {
                1 => &[[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
                2 => {
                    let along = unit_vector(edges[0]).0;
                    let f = frame(along);
                    &[[f[3], f[4], f[5]], [f[6], f[7], f[8]]]
                }
                _ => &[unit_vector(cross(edges[0], edges[1])).0],
            };
            let mut farthest = (0.0, None);
            for &dir in directions {
                for side in [1.0, -1.0] {
                    let new = support(a, b, scale(dir, side));
                    size = size.max(norm(new.point));
                    let height = dot(dir, sub(new.point, base)).abs();
                    if height > farthest.0 {
                        farthest = (height, Some(new));
                    }
                }
            }
            self.vertices.push(farthest.1.filter(|_| farthest.0 > SLIVER * size)?);
        }
        Some(size)
    }

    /// Whether the vertices form a simplex that is not almost degenerate.
    fn spans(&self) -> bool {
        let Some((first, rest)) = self.vertices.split_first() else { return true };
        let edges = rest.iter().map(|v| sub(v.point, first.point));
        let size: f64 = edges.clone().map(norm).product();
        let [u, v, w] = std::array::from_fn(|k| edges.clone().nth(k).unwrap_or_default());
        let content = match rest.len() {
            0 => return true,
            1 => norm(u),
            2 => norm(cross(u, v)),
            _ => dot(u, cross(v, w)).abs(),
        };
        content > SLIVER * size
    }

    /// Creates the tetrahedron of the first four vertices.
    fn tetrahedron(&mut self) {
        let [p, q, r, s] = [0, 1, 2, 3].map(|v| self.point(v));
        if dot(cross(sub(q, p), sub(r, p)), sub(s, p)) > 0.0 {
            self.vertices.swap(0, 1);
        }
        self.faces.clear();
        self.low.clear();
        // Seen from the fourth vertex, the first three are in clockwise order.
        let faces = [
            ([0, 1, 2], [6, 10, 14]),
            ([0, 3, 1], [13, 8, 0]),
            ([1, 3, 2], [5, 12, 1]),
            ([2, 3, 0], [9, 4, 2]),
        ];
        for (from, twin) in faces {
            let plane = self.plane(from).unwrap_or(FacePlane { normal: [0.0; 3], offset: f64::INFINITY });
            self.add(PolytopeFace { plane, from, twin, is_on_surface: true });
        }
    }

    fn add(&mut self, face: PolytopeFace) {
        self.low.push(self.faces.len() as u32);
        self.faces.push(face);
    }

    /// The plane of a triangle; `None` if the triangle is degenerate.
    fn plane(&self, vertices: [u32; 3]) -> Option<FacePlane> {
        let [a, b, c] = vertices.map(|v| self.point(v));
        let (u, v) = (sub(b, a), sub(c, a));
        let normal = cross(u, v);
        let area2 = dot(normal, normal);
        let normal = scale(normal, 1.0 / area2.sqrt());
        (area2 > SLIVER * SLIVER * dot(u, u) * dot(v, v))
            .then(|| FacePlane { normal, offset: dot(normal, a) })
    }

    /// Expands the polytope until the lowest lower and upper bound differ by at most `tolerance`. Returns the face
    /// and the plane of the lowest upper bound, `None` if no bound is below `upper`.
    fn expand(
        &mut self,
        a: &mut ConvexBody,
        b: &mut ConvexBody,
        [rounding, tolerance]: [f64; 2],
        mut upper: f64,
        left: &mut usize,
    ) -> Option<(u32, FacePlane)> {
        let corners = a.discrete() && b.discrete();
        let mut best = None;
        while *left > 0 {
            *left -= 1;
            self.cost += 200 + self.low.len() as u64;
            let Some(face) = self.lowest(upper) else { break };
            let FacePlane { normal, offset } = self.faces[face as usize].plane;
            let new = support(a, b, normal);
            let reach = dot(normal, new.point);
            if reach < upper {
                upper = reach;
                best = Some((face, FacePlane { normal, offset: reach }));
            }
            let has_corners = |v: &Vertex| v.corners == new.corners;
            if upper - offset <= tolerance.max(rounding) || corners && self.vertices.iter().any(has_corners) {
                break;
            }
            self.vertices.push(new);
            if !self.grow(face, rounding) {
                break;
            }
        }
        best
    }

    /// The face with the lowest offset. Faces that are no longer on the surface, or whose offset is above an upper
    /// bound, are removed from the list.
    fn lowest(&mut self, upper: f64) -> Option<u32> {
        let mut lowest = (f64::INFINITY, None);
        let mut k = 0;
        while let Some(&f) = self.low.get(k) {
            let face = &self.faces[f as usize];
            if !face.is_on_surface || face.plane.offset > upper {
                self.low.swap_remove(k);
                continue;
            }
            if face.plane.offset < lowest.0 {
                lowest = (face.plane.offset, Some(f));
            }
            k += 1;
        }
        lowest.1
    }

    /// A face that is visible from the last vertex.
    fn facing(&self, rounding: f64) -> Option<u32> {
        let w = self.vertices.last()?.point;
        let height = |plane: &FacePlane| dot(plane.normal, w) - plane.offset;
        self.faces.iter().position(|f| f.is_on_surface && height(&f.plane) > rounding).map(|f| f as u32)
    }

    /// Replaces all faces that are visible from the last vertex, including `seen`, by a fan around this vertex.
    /// Returns `false` if rounding errors leave no valid border for the fan.
    fn grow(&mut self, seen: u32, rounding: f64) -> bool {
        let apex = self.vertices.len() as u32 - 1;
        let w = self.point(apex);
        self.border.clear();
        self.pending.clear();
        self.faces[seen as usize].is_on_surface = false;
        self.pending.extend_from_slice(&self.faces[seen as usize].twin);
        while let Some(edge) = self.pending.pop() {
            let (f, k) = place(edge);
            let face = &mut self.faces[f];
            if !face.is_on_surface {
                continue;
            }
            if dot(face.plane.normal, w) - face.plane.offset > rounding {
                face.is_on_surface = false;
                let [after, before] = [face.twin[(k + 1) % 3], face.twin[(k + 2) % 3]];
                self.pending.extend_from_slice(&[after, before]);
            } else {
                self.border.push(edge);
            }
        }
        self.fan.clear();
        self.fan.resize(self.vertices.len(), NONE);
        let first = self.faces.len();
        for i in 0..self.border.len() {
            let outer = self.border[i];
            let (f, k) = place(outer);
            let PolytopeFace { plane, from, .. } = self.faces[f];
            let (start, end) = (from[(k + 1) % 3], from[k]);
            let face = self.faces.len() as u32;
            if self.fan[start as usize] != NONE {
                return false;
            }
            self.fan[start as usize] = face;
            self.faces[f].twin[k] = 4 * face;
            let from = [start, end, apex];
            // For a degenerate triangle the new vertex is on the line of the outer edge, so the triangle takes the
            // plane of its neighbour.
            let plane = self.plane(from).unwrap_or(plane);
            self.add(PolytopeFace { plane, from, twin: [outer, NONE, NONE], is_on_surface: true });
        }
        for f in first..self.faces.len() {
            let after = self.fan[self.faces[f].from[1] as usize];
            if after == NONE {
                return false;
            }
            self.faces[f].twin[1] = 4 * after + 2;
            self.faces[after as usize].twin[2] = 4 * f as u32 + 1;
        }
        self.border.len() > 2
    }

    /// The points of both bodies at the projection of the origin onto the flat side that contains the face.
    fn witness(&self, face: u32, size: f64) -> [Vec3; 2] {
        let plane = self.faces[face as usize].plane;
        let foot = scale(plane.normal, plane.offset);
        let mut best = (f64::NEG_INFINITY, face, [1.0, 0.0, 0.0]);
        let mut consider = |face: u32| {
            let Some(weights) = barycentric(self.corners(face), foot) else { return };
            let least = weights.into_iter().fold(f64::INFINITY, f64::min);
            if least > best.0 {
                best = (least, face, weights);
            }
        };
        consider(face);
        for (f, PolytopeFace { plane: other, .. }) in self.faces.iter().enumerate() {
            let same = dot(other.normal, plane.normal) > 1.0 - SAME_SIDE
                && (other.offset - plane.offset).abs() < SAME_SIDE * size;
            if same && f as u32 != face {
                consider(f as u32);
            }
        }
        let (_, face, weights) = best;
        // The foot of the perpendicular is in one of the faces. Rounding may place it slightly outside; it is then
        // moved to the border.
        let weights = weights.map(|w| w.max(0.0));
        let sum: f64 = weights.iter().sum();
        let vertices = self.faces[face as usize].from.map(|v| &self.vertices[v as usize]);
        let mean = |point: fn(&Vertex) -> Vec3| {
            vertices.iter().zip(weights).fold([0.0; 3], |m, (v, w)| add_scaled(m, point(v), w / sum))
        };
        [mean(|v| v.on_a), mean(|v| v.on_b)]
    }
}
