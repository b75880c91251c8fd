//! Support points: the farthest point of a convex shape in a direction.

use super::list::List;
use super::{Hull, Mesh, Shape};
use crate::kinds::geom;
use crate::math::*;

/// The geometry of a convex body.
#[derive(Clone, Copy, Debug)]
pub(crate) enum ConvexForm<'a> {
    /// A convex shape, or the convex hull of a mesh.
    Shape(&'a Shape<'a>),
    /// A triangular prism of a height field: the three bottom corners, then the three top corners above them.
    Prism([Vec3; 6]),
}

/// A convex body for the distance algorithms. The core of a sphere is its centre, that of a capsule its axis; the
/// remaining thickness is [`ConvexBody::radius`].
#[derive(Clone, Copy, Debug)]
pub(crate) struct ConvexBody<'a> {
    pub(crate) form: ConvexForm<'a>,
    /// Translation of the body from the position of its shape, m, world frame.
    shift: Vec3,
    /// The last corner found, for bodies with corners; -1 for others.
    pub(super) corner: i32,
    /// The last hull vertex found, as the start of the next search: similar directions have nearby support points.
    hull_vertex: usize,
    /// Work units of its support points.
    pub(super) work: u64,
}

/// Work units of a support point, without the mesh vertices that it examines.
const SUPPORT: u64 = 40;
/// Hulls with fewer vertices are searched exhaustively.
const CLIMB_FROM: usize = 10;

impl<'a> ConvexBody<'a> {
    pub(crate) fn new(shape: &'a Shape<'a>) -> ConvexBody<'a> {
        ConvexBody::from_form(ConvexForm::Shape(shape))
    }

    pub(crate) fn prism(corners: [Vec3; 6]) -> ConvexBody<'a> {
        ConvexBody::from_form(ConvexForm::Prism(corners))
    }

    fn from_form(form: ConvexForm<'a>) -> ConvexBody<'a> {
        ConvexBody { form, shift: [0.0; 3], corner: -1, hull_vertex: 0, work: 0 }
    }

    /// The same body, translated.
    pub(super) fn moved(&self, by: Vec3) -> ConvexBody<'a> {
        ConvexBody { shift: by, ..*self }
    }

    /// The last corner found; -1 if the body has no corners.
    pub(crate) fn corner(&self) -> i32 {
        self.corner
    }

    /// The type of its geom.
    pub(crate) fn kind(&self) -> i32 {
        match self.form {
            ConvexForm::Shape(s) => s.kind,
            ConvexForm::Prism(_) => geom::HFIELD,
        }
    }

    /// A point inside the body.
    pub(super) fn centre(&self) -> Vec3 {
        match self.form {
            ConvexForm::Shape(s) => add(s.pos, self.shift),
            ConvexForm::Prism(corners) => scale(corners.into_iter().fold([0.0; 3], add), 1.0 / 6.0),
        }
    }

    /// The radius of the body around its core, m; zero for types without a core.
    pub(super) fn radius(&self) -> f64 {
        match self.form {
            ConvexForm::Shape(s) if matches!(s.kind, geom::SPHERE | geom::CAPSULE) => s.size[0],
            _ => 0.0,
        }
    }

    /// Whether the body has finitely many support points.
    pub(super) fn discrete(&self) -> bool {
        !matches!(self.kind(), geom::ELLIPSOID | geom::CYLINDER)
    }

    /// The farthest point of the core in the direction of a unit vector, m, world frame.
    pub(crate) fn support(&mut self, dir: Vec3) -> Vec3 {
        self.work += SUPPORT;
        let point = match self.form {
            ConvexForm::Prism(corners) => {
                self.corner = prism(&corners, dir) as i32;
                corners[self.corner as usize]
            }
            ConvexForm::Shape(s) => {
                let local = mat_t_mul_vec(&s.mat, dir);
                s.world(self.local_support(s, local))
            }
        };
        add(point, self.shift)
    }

    /// The Hessian of the support function for a unit direction or its opposite, applied to two vectors (world
    /// frame): ss, st, tt, m. On tangents it contains the radii of curvature where the body is round; it is zero at
    /// corners.
    pub(super) fn support_hessian(&self, dir: Vec3, s: Vec3, t: Vec3) -> Vec3 {
        let ConvexForm::Shape(shape) = self.form else { return [0.0; 3] };
        if !matches!(shape.kind, geom::ELLIPSOID | geom::CYLINDER) {
            return [0.0; 3];
        }
        let [n, s, t] = [dir, s, t].map(|v| mat_t_mul_vec(&shape.mat, v));
        let size = shape.size;
        if shape.kind == geom::CYLINDER {
            // h = r ρ, where ρ is the length of n across the axis, so H = r / ρ along the rim.
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

    /// Up to two edges that are nearly normal to a direction (world frame, unit length). The support function has a
    /// kink there. A flat end of a cylinder counts as two edges.
    pub(super) fn kinks(&mut self, dir: Vec3, near: f64) -> List<Vec3, 2> {
        // The two edges closest to normal, the closest first.
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
            ConvexForm::Prism(corners) => {
                let first = if dir[2] < 0.0 { 0 } else { 3 };
                for k in 0..3 {
                    consider(unit_vector(sub(corners[first + (k + 1) % 3], corners[first + k])).0);
                }
                consider([0.0, 0.0, 1.0]);
            }
            ConvexForm::Shape(s) => match s.kind {
                geom::BOX => (0..3).for_each(|i| consider(s.axis(i))),
                geom::CAPSULE => consider(s.axis(2)),
                geom::CYLINDER if norm(cross(s.axis(2), dir)) < near => {
                    (0..2).for_each(|i| consider(s.axis(i)));
                }
                geom::CYLINDER => consider(s.axis(2)),
                geom::MESH => {
                    let vertex = self.mesh_vertex(&s.mesh(), mat_t_mul_vec(&s.mat, dir));
                    let vertex_at = |v: usize| s.mesh().vertex(v);
                    let Some(faces) = s.mesh().hull_faces else { return List::new() };
                    for (side, place) in faces.around(vertex) {
                        let list = faces.vertices(side);
                        let other = list[(place + 1) % list.len()] as usize;
                        consider(mat_mul_vec(
                            &s.mat,
                            unit_vector(sub(vertex_at(other), vertex_at(vertex))).0,
                        ));
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
                // For a direction normal to the axis, both ends are equally high: the middle is taken.
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

    /// The farthest vertex. The search starts from the last vertex found.
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

/// The farthest vertex of a hull, found by hill climbing over neighbours, and the number of vertices examined.
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

/// The farthest of all vertices of a mesh.
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

/// The farthest corner of a prism: one of the bottom corners for a downward direction, else one of the top corners.
fn prism(corners: &[Vec3; 6], dir: Vec3) -> usize {
    let first = if dir[2] < 0.0 { 0 } else { 3 };
    (first..first + 3)
        .fold(first, |best, k| if dot(corners[k], dir) > dot(corners[best], dir) { k } else { best })
}
