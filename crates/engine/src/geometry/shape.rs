//! A shape in the world: type, sizes, pose; for meshes and height fields a view of their data.

use super::hull::vertex;
use super::{Hull, HullFaces};
use crate::kinds::geom;
use crate::math::*;

/// A geom or site as geometry sees it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Shape<'a> {
    /// `geom_type`.
    pub kind: i32,
    /// Sizes as in `geom_size`, m.
    pub size: Vec3,
    /// Position of its frame, m, world.
    pub pos: Vec3,
    /// Orientation of its frame, world.
    pub mat: Mat3,
    /// Its vertices, when it is a mesh.
    pub mesh: Option<Mesh<'a>>,
    /// Its samples, when it is a height field.
    pub field: Option<Field<'a>>,
}

/// The data of a mesh, in the frame of the geom.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Mesh<'a> {
    /// Vertices, m.
    pub vert: &'a [Vec3],
    /// Vertices of each triangle; outside is where they run counterclockwise.
    pub face: &'a [[i32; 3]],
    /// The convex hull, when it is known.
    pub hull: Option<Hull<'a>>,
    /// The flat sides of the hull, when contacts may lie on them.
    pub hull_faces: Option<&'a HullFaces>,
}

impl Mesh<'_> {
    /// A vertex.
    #[cfg_attr(not(feature = "small"), inline(always))]
    pub(crate) fn vertex(&self, v: usize) -> Vec3 {
        vertex(self.vert, v)
    }
}

/// The data of a height field, a grid over its base.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Field<'a> {
    /// Half lengths in x and y, height of the top, depth of the base, m.
    pub size: [f64; 4],
    /// Number of samples in y and in x.
    pub nrow: usize,
    /// Number of samples in x.
    pub ncol: usize,
    /// Elevations from 0 to 1, row by row.
    pub data: &'a [f64],
}

impl Field<'_> {
    /// Distance of neighbouring samples in x and y, m.
    pub(crate) fn step(&self) -> [f64; 2] {
        [2.0 * self.size[0] / (self.ncol as f64 - 1.0), 2.0 * self.size[1] / (self.nrow as f64 - 1.0)]
    }

    /// The sample at a row and column, in the frame of the geom, m.
    pub(crate) fn point(&self, row: usize, col: usize) -> Vec3 {
        let [dx, dy] = self.step();
        [
            dx * col as f64 - self.size[0],
            dy * row as f64 - self.size[1],
            self.data[row * self.ncol + col] * self.size[2],
        ]
    }
}

impl<'a> Shape<'a> {
    /// A primitive shape.
    pub(crate) fn new(kind: i32, size: Vec3, pos: Vec3, mat: Mat3) -> Shape<'a> {
        Shape { kind, size, pos, mat, mesh: None, field: None }
    }

    /// Its vertices; none when it is no mesh.
    pub(crate) fn mesh(&self) -> Mesh<'a> {
        self.mesh.unwrap_or_default()
    }

    /// Its samples; none when it is no height field.
    pub(crate) fn field(&self) -> Field<'a> {
        self.field.unwrap_or_default()
    }

    /// The axis `i` of its frame, world.
    #[cfg_attr(not(feature = "small"), inline(always))]
    pub(crate) fn axis(&self, i: usize) -> Vec3 {
        column(&self.mat, i)
    }

    /// The radius of a sphere about its frame that holds it, m; of a plane and a height field there is none that is asked for.
    pub(crate) fn bounding_radius(&self) -> f64 {
        let [x, y, _] = self.size;
        match self.kind {
            geom::SPHERE => x,
            geom::CAPSULE => x + y,
            geom::CYLINDER => (x * x + y * y).sqrt(),
            geom::ELLIPSOID => self.size.into_iter().fold(0.0, f64::max),
            _ => norm(self.size),
        }
    }

    /// A point of the world in its frame.
    #[cfg_attr(not(feature = "small"), inline(always))]
    pub(crate) fn local(&self, point: Vec3) -> Vec3 {
        mat_t_mul_vec(&self.mat, sub(point, self.pos))
    }

    /// A point of its frame in the world.
    #[cfg_attr(not(feature = "small"), inline(always))]
    pub(crate) fn world(&self, point: Vec3) -> Vec3 {
        add(mat_mul_vec(&self.mat, point), self.pos)
    }
}
