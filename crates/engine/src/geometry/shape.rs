//! A shape in the world: type, sizes and pose. Meshes and height fields also have a view of their data.

use super::hull::vertex;
use super::{Hull, HullFaces};
use crate::kinds::geom;
use crate::math::*;

/// The geometry of a geom or site.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Shape<'a> {
    /// `geom_type`.
    pub kind: i32,
    /// Sizes as in `geom_size`, m.
    pub size: Vec3,
    /// Position of its frame, m, world frame.
    pub pos: Vec3,
    /// Orientation of its frame, world frame.
    pub mat: Mat3,
    /// Data of a mesh; `None` for other types.
    pub mesh: Option<Mesh<'a>>,
    /// Data of a height field; `None` for other types.
    pub field: Option<HeightField<'a>>,
}

/// The data of a mesh, in the frame of the geom.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Mesh<'a> {
    /// Vertices, m.
    pub vert: &'a [Vec3],
    /// Vertices of each triangle, counterclockwise as seen from outside.
    pub face: &'a [[i32; 3]],
    /// The convex hull, if it is known.
    pub hull: Option<Hull<'a>>,
    /// The flat faces of the hull, if contacts can have several points on them.
    pub hull_faces: Option<&'a HullFaces>,
}

impl Mesh<'_> {
    /// The position of vertex `v`, m.
    #[cfg_attr(not(feature = "small"), inline(always))]
    pub(crate) fn vertex(&self, v: usize) -> Vec3 {
        vertex(self.vert, v)
    }
}

/// The data of a height field: a grid of elevations above its base.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct HeightField<'a> {
    /// Half lengths in x and y, height of the top, depth of the base, m.
    pub size: [f64; 4],
    /// Number of samples in y.
    pub nrow: usize,
    /// Number of samples in x.
    pub ncol: usize,
    /// Elevations from 0 to 1, row-major.
    pub data: &'a [f64],
}

impl HeightField<'_> {
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

    /// Its mesh data; empty for other types.
    pub(crate) fn mesh(&self) -> Mesh<'a> {
        self.mesh.unwrap_or_default()
    }

    /// Its height field data; empty for other types.
    pub(crate) fn field(&self) -> HeightField<'a> {
        self.field.unwrap_or_default()
    }

    /// Axis `i` of its frame, world frame.
    #[cfg_attr(not(feature = "small"), inline(always))]
    pub(crate) fn axis(&self, i: usize) -> Vec3 {
        column(&self.mat, i)
    }

    /// The radius of a bounding sphere about the origin of its frame, m. It is not used for planes and height fields.
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

    /// Transforms a point from the world frame to the frame of the shape.
    #[cfg_attr(not(feature = "small"), inline(always))]
    pub(crate) fn local(&self, point: Vec3) -> Vec3 {
        mat_t_mul_vec(&self.mat, sub(point, self.pos))
    }

    /// Transforms a point from the frame of the shape to the world frame.
    #[cfg_attr(not(feature = "small"), inline(always))]
    pub(crate) fn world(&self, point: Vec3) -> Vec3 {
        add(mat_mul_vec(&self.mat, point), self.pos)
    }
}
