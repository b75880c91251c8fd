//! Support points: the point of a convex shape that is farthest in a direction.

use super::list::List;
use super::{Hull, Mesh, Shape};
use crate::kinds::geom;
use crate::math::*;

/// What a convex body is made of.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Form<'a> {
    /// A convex shape; of a mesh, its hull.
    Shape(&'a Shape<'a>),
    /// A triangle prism of a height field: the bottom, then the top above it.
    Prism([Vec3; 6]),
}

/// A convex body as the distance algorithms see it. A sphere is its centre, a capsule its axis: the rest is [`Body::radius`].
#[derive(Clone, Copy, Debug)]
pub(crate) struct Body<'a> {
    pub(crate) form: Form<'a>,
    /// The body stands this far from where its shape is, m, world.
    shift: Vec3,
    /// The corner found last, of what has corners only; else -1.
    pub(super) corner: i32,
    /// The vertex of the hull found last: neighbouring directions have neighbouring answers.
    hull_vertex: usize,
    /// Work that its support points were.
    pub(super) work: u64,
}

/// Work of a support point, besides the vertices of a mesh that it looks at.
const SUPPORT: u64 = 40;
/// Hulls with fewer vertices are searched through.
const CLIMB_FROM: usize = 10;

impl<'a> Body<'a> {
    pub(crate) fn new(shape: &'a Shape<'a>) -> Body<'a> {
        Body::from_form(Form::Shape(shape))
    }

    pub(crate) fn prism(corners: [Vec3; 6]) -> Body<'a> {
        Body::from_form(Form::Prism(corners))
    }

    fn from_form(form: Form<'a>) -> Body<'a> {
        Body { form, shift: [0.0; 3], corner: -1, hull_vertex: 0, work: 0 }
    }

    /// The same body somewhere else.
    pub(super) fn moved(&self, by: Vec3) -> Body<'a> {
        Body { shift: by, ..*self }
    }

    /// The corner found last, -1 when the body has none.
    pub(crate) fn corner(&self) -> i32 {
        self.corner
    }

    /// The type of its geom.
    pub(crate) fn kind(&self) -> i32 {
        match self.form {
            Form::Shape(s) => s.kind,
            Form::Prism(_) => geom::HFIELD,
        }
    }

    /// A point inside.
    pub(super) fn centre(&self) -> Vec3 {
        match self.form {
            Form::Shape(s) => add(s.pos, self.shift),
            Form::Prism(corners) => scale(corners.into_iter().fold([0.0; 3], add), 1.0 / 6.0),
        }
    }

    /// How far the shape reaches around its core, m; zero when it has none.
    pub(super) fn radius(&self) -> f64 {
        match self.form {
            Form::Shape(s) if matches!(s.kind, geom::SPHERE | geom::CAPSULE) => s.size[0],
            _ => 0.0,
        }
    }

    /// Whether the body has finitely many support points.
    pub(super) fn discrete(&self) -> bool {
        !matches!(self.kind(), geom::ELLIPSOID | geom::CYLINDER)
    }

    /// The farthest point of the core in a direction of unit length, world.
    pub(crate) fn support(&mut self, dir: Vec3) -> Vec3 {
        self.work += SUPPORT;
        let point = match self.form {
            Form::Prism(corners) => {
                self.corner = prism(&corners, dir) as i32;
                corners[self.corner as usize]
            }
            Form::Shape(s) => {
                let local = mat_t_mul_vec(&s.mat, dir);
                s.world(self.local_support(s, local))
            }
        };
        add(point, self.shift)
    }

    /// The Hessian of the support function in a direction of unit length, or in the opposite one, between two vectors
    /// (world): ss, st, tt, m. On tangents the radii of curvature where the body is round; zero at corners.
    pub(super) fn bend(&self, dir: Vec3, s: Vec3, t: Vec3) -> Vec3 {
        let Form::Shape(shape) = self.form else { return [0.0; 3] };
        if !matches!(shape.kind, geom::ELLIPSOID | geom::CYLINDER) {
            return [0.0; 3];
        }
        let [n, s, t] = [dir, s, t].map(|v| mat_t_mul_vec(&shape.mat, v));
        let size = shape.size;
        if shape.kind == geom::CYLINDER {
            // h = r ρ with ρ the length across the axis, so H = r / ρ along the rim.
            let rho2 = n[0] * n[0] + n[1] * n[1];
            if rho2 < MINVAL * MINVAL {
                return [0.0; 3];
            }
            let along = |v: Vec3| v[1] * n[0] - v[0] * n[1];
            let (radius, [s, t]) = (size[0] / (rho2 * rho2.sqrt()), [s, t].map(along));
            return [s * s, s * t, t * t].map(|x| radius * x);
        }
        // h = |S n|, so H = S² / h - (S² n)(S² n)ᵀ / h³.
        let stretched = |v: Vec3| [size[0] * v[0], size[1] * v[1], size[2] * v[2]];
        let [n, s, t] = [n, s, t].map(stretched);
        let h2 = dot(n, n);
        let between = |u: Vec3, v: Vec3| (dot(u, v) - dot(u, n) * dot(v, n) / h2) / h2.sqrt();
        [between(s, s), between(s, t), between(t, t)]
    }

    /// Up to two edges that are nearly across a direction (world, unit length): there the support function has a kink.
    /// A flat end of a cylinder counts as two.
    pub(super) fn kinks(&mut self, dir: Vec3, near: f64) -> List<Vec3, 2> {
        // The two that are most across, the flattest first.
        let mut flattest: [(f64, Vec3); 2] = [(near, [0.0; 3]); 2];
        let mut consider = |edge: Vec3| {
            let slope = dot(edge, dir).abs();
            if slope < flattest[0].0 {
                flattest = [(slope, edge), flattest[0]];
            } else if slope < flattest[1].0 {
                flattest[1] = (slope, edge);
            }
        };
        match self.form {
            Form::Prism(corners) => {
                let first = if dir[2] < 0.0 { 0 } else { 3 };
                for k in 0..3 {
                    consider(unit_vector(sub(corners[first + (k + 1) % 3], corners[first + k])).0);
                }
                consider([0.0, 0.0, 1.0]);
            }
            Form::Shape(s) => match s.kind {
                geom::BOX => (0..3).for_each(|i| consider(s.axis(i))),
                geom::CAPSULE => consider(s.axis(2)),
                geom::CYLINDER if norm(cross(s.axis(2), dir)) < near => {
                    (0..2).for_each(|i| consider(s.axis(i)));
                }
                geom::CYLINDER => consider(s.axis(2)),
                geom::MESH => {
                    let vertex = self.mesh_vertex(&s.mesh(), mat_t_mul_vec(&s.mat, dir));
                    let at = |v: usize| s.mesh().vertex(v);
                    let Some(faces) = s.mesh().hull_faces else { return List::new() };
                    for (side, place) in faces.around(vertex) {
                        let list = faces.vertices(side);
                        let other = list[(place + 1) % list.len()] as usize;
                        consider(mat_mul_vec(&s.mat, unit_vector(sub(at(other), at(vertex))).0));
                    }
                }
                _ => {}
            },
        }
        let mut out = List::new();
        flattest.iter().filter(|(slope, _)| *slope < near).for_each(|&(_, edge)| out.push(edge));
        out
    }

    fn local_support(&mut self, s: &Shape, dir: Vec3) -> Vec3 {
        let upwards = |x: f64| if x >= 0.0 { 1.0 } else { -1.0 };
        match s.kind {
            geom::CAPSULE => {
                self.corner = i32::from(dir[2] >= 0.0);
                [0.0, 0.0, upwards(dir[2]) * s.size[1]]
            }
            geom::ELLIPSOID => {
                let on_unit: Vec3 = std::array::from_fn(|i| dir[i] * s.size[i]);
                let n = norm(on_unit);
                if n == 0.0 {
                    [s.size[0], 0.0, 0.0]
                } else {
                    std::array::from_fn(|i| on_unit[i] * (1.0 / n * s.size[i]))
                }
            }
            geom::CYLINDER => {
                let out2 = dir[0] * dir[0] + dir[1] * dir[1];
                let out = if out2 > MINVAL * MINVAL { s.size[0] / out2.sqrt() } else { 0.0 };
                // A direction along the rim has no higher end: the middle.
                let up = if dir[2] == 0.0 { 0.0 } else { dir[2].signum() };
                [dir[0] * out, dir[1] * out, up * s.size[1]]
            }
            geom::BOX => {
                let point: Vec3 = std::array::from_fn(|i| upwards(dir[i]) * s.size[i]);
                self.corner = (0..3).map(|i| i32::from(point[i] > 0.0) << i).sum();
                point
            }
            geom::MESH => {
                let v = self.mesh_vertex(&s.mesh(), dir);
                self.corner = v as i32;
                s.mesh().vertex(v)
            }
            _ => [0.0; 3],
        }
    }

    /// The farthest vertex, starting from the last one.
    fn mesh_vertex(&mut self, mesh: &Mesh, dir: Vec3) -> usize {
        match &mesh.hull {
            Some(hull) if mesh.vert.len() >= CLIMB_FROM => {
                let (vertex, seen) = climb(mesh, hull, dir, self.hull_vertex);
                self.hull_vertex = vertex;
                self.work += seen;
                hull.vertex[vertex] as usize
            }
            _ => {
                self.work += mesh.vert.len() as u64;
                search(mesh, dir, usize::try_from(self.corner).ok())
            }
        }
    }
}

/// The farthest vertex of a hull by steps to a farther neighbour, and how many vertices were looked at.
pub(super) fn climb(mesh: &Mesh, hull: &Hull, dir: Vec3, start: usize) -> (usize, u64) {
    let mut highest = f64::NEG_INFINITY;
    let (mut best, mut seen) = (start, 0);
    loop {
        let from = best;
        for v in hull.neighbours(from) {
            seen += 1;
            let height = dot(dir, mesh.vert[hull.vertex[v] as usize]);
            if height > highest {
                (highest, best) = (height, v);
            }
        }
        if best == from {
            return (best, seen);
        }
    }
}

/// The farthest of all vertices.
pub(super) fn search(mesh: &Mesh, dir: Vec3, start: Option<usize>) -> usize {
    let height = |v: usize| dot(dir, mesh.vert[v]);
    let mut best = start.unwrap_or(0);
    let mut highest = start.map_or(f64::NEG_INFINITY, height);
    for v in 0..mesh.vert.len() {
        if height(v) > highest {
            (highest, best) = (height(v), v);
        }
    }
    best
}

/// The corner of a prism: of the three below for a direction that falls, else of the three on top.
fn prism(corners: &[Vec3; 6], dir: Vec3) -> usize {
    let first = if dir[2] < 0.0 { 0 } else { 3 };
    (first..first + 3)
        .fold(first, |best, k| if dot(corners[k], dir) > dot(corners[best], dir) { k } else { best })
}
