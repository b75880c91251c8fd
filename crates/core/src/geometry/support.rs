//! Support points: the point of a convex shape that is farthest in a direction.

use super::{Hull, Mesh, Shape};
use crate::geom;
use crate::math::*;

/// What a convex body is made of.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Form<'a> {
    /// A convex shape; of a mesh, its hull.
    Shape(&'a Shape<'a>),
    /// A triangle prism of a height field: the bottom, then the top above it.
    Prism([Vec3; 6]),
}

/// A convex body as the distance algorithms see it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Body<'a> {
    pub(crate) form: Form<'a>,
    /// The body is thicker by half of this, m.
    pub(crate) margin: f64,
    /// Only the centre of a sphere, or the axis of a capsule, stands for the shape.
    pub(super) core: bool,
    /// The corner found last, of a box or mesh.
    pub(super) corner: i32,
    /// The vertex of the hull found last: neighbouring directions have neighbouring answers.
    hull_vertex: usize,
}

/// Hulls with fewer vertices are searched through.
const CLIMB_FROM: usize = 10;

impl<'a> Body<'a> {
    pub(crate) fn new(shape: &'a Shape<'a>, margin: f64) -> Body<'a> {
        Body { form: Form::Shape(shape), margin, core: false, corner: -1, hull_vertex: 0 }
    }

    pub(crate) fn prism(corners: [Vec3; 6]) -> Body<'a> {
        Body { form: Form::Prism(corners), margin: 0.0, core: false, corner: -1, hull_vertex: 0 }
    }

    /// What a support point costs.
    pub(super) fn price(&self) -> u64 {
        match self.form {
            Form::Shape(s) if s.kind == geom::MESH && s.mesh.hull.is_none() => 20 + s.mesh.vert.len() as u64,
            _ => 40,
        }
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
            Form::Shape(s) => s.pos,
            Form::Prism(corners) => scale(corners.into_iter().fold([0.0; 3], add), 1.0 / 6.0),
        }
    }

    /// How far the shape reaches around its core, m; zero when it has none.
    pub(super) fn radius(&self) -> f64 {
        match self.form {
            Form::Shape(s) if has_core(s.kind) => s.size[0] + 0.5 * self.margin,
            _ => 0.0,
        }
    }

    /// Whether the body is a point or a segment with a radius.
    pub(super) fn round(&self) -> bool {
        has_core(self.kind())
    }

    /// Whether the body has finitely many support points.
    pub(super) fn discrete(&self) -> bool {
        self.margin == 0.0 && matches!(self.kind(), geom::MESH | geom::BOX | geom::HFIELD)
    }

    /// The farthest point in a direction of unit length, world.
    pub(crate) fn support(&mut self, dir: Vec3) -> Vec3 {
        let point = match self.form {
            Form::Prism(corners) => prism(&corners, dir),
            Form::Shape(s) => {
                let local = mat_t_mul_vec(&s.mat, dir);
                s.world(self.local_support(s, local))
            }
        };
        if self.margin > 0.0 && !self.core { add_scaled(point, dir, 0.5 * self.margin) } else { point }
    }

    fn local_support(&mut self, s: &Shape, dir: Vec3) -> Vec3 {
        let upwards = |x: f64| if x >= 0.0 { 1.0 } else { -1.0 };
        match s.kind {
            geom::SPHERE if self.core => [0.0; 3],
            geom::SPHERE => scale(dir, s.size[0]),
            geom::CAPSULE => {
                let end = [0.0, 0.0, upwards(dir[2]) * s.size[1]];
                if self.core { end } else { add(scale(dir, s.size[0]), end) }
            }
            geom::ELLIPSOID => {
                let on_unit: Vec3 = std::array::from_fn(|i| dir[i] * s.size[i]);
                let n = norm(on_unit);
                if n < MINVAL {
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
                let v = self.mesh_vertex(&s.mesh, dir);
                self.corner = v as i32;
                s.mesh.vert.get(v).copied().unwrap_or_default()
            }
            _ => [0.0; 3],
        }
    }

    /// The farthest vertex, starting from the last one.
    fn mesh_vertex(&mut self, mesh: &Mesh, dir: Vec3) -> usize {
        match &mesh.hull {
            Some(hull) if mesh.vert.len() >= CLIMB_FROM => {
                self.hull_vertex = climb(mesh, hull, dir, self.hull_vertex);
                hull.vertex[self.hull_vertex] as usize
            }
            _ => search(mesh, dir, usize::try_from(self.corner).ok()),
        }
    }
}

/// The farthest vertex of a hull by steps to a farther neighbour.
pub(super) fn climb(mesh: &Mesh, hull: &Hull, dir: Vec3, start: usize) -> usize {
    let mut highest = f64::NEG_INFINITY;
    let mut best = start;
    loop {
        let from = best;
        for v in hull.neighbours(from) {
            let height = dot(dir, mesh.vert[hull.vertex[v] as usize]);
            if height > highest {
                (highest, best) = (height, v);
            }
        }
        if best == from {
            return best;
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

fn has_core(kind: i32) -> bool {
    matches!(kind, geom::SPHERE | geom::CAPSULE)
}

fn prism(corners: &[Vec3; 6], dir: Vec3) -> Vec3 {
    let side = if dir[2] < 0.0 { &corners[..3] } else { &corners[3..] };
    let mut best = side[0];
    for &corner in &side[1..] {
        if dot(corner, dir) > dot(best, dir) {
            best = corner;
        }
    }
    best
}
