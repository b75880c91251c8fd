//! A shape in the world: type, sizes, pose; for meshes and height fields a view of their data.

use super::Sides;
use crate::math::*;
use crate::{Data, Model, geom};

/// A geom or site as geometry sees it.
#[derive(Clone, Copy, Debug)]
pub struct Shape<'a> {
    /// `geom_type`.
    pub kind: i32,
    /// Sizes as in `geom_size`, m.
    pub size: Vec3,
    /// Position of its frame, m, world.
    pub pos: Vec3,
    /// Orientation of its frame, world.
    pub mat: Mat3,
    /// Its vertices, when it is a mesh.
    pub mesh: Mesh<'a>,
    /// Its samples, when it is a height field.
    pub field: Field<'a>,
}

/// The data of a mesh, in the frame of the geom.
#[derive(Clone, Copy, Debug, Default)]
pub struct Mesh<'a> {
    /// Vertices, m.
    pub vert: &'a [Vec3],
    /// Vertices of each triangle; outside is where they run counterclockwise.
    pub face: &'a [[i32; 3]],
    /// The convex hull, when it is known.
    pub hull: Option<Hull<'a>>,
    /// The flat sides of the hull, when contacts may lie on them.
    pub sides: Option<&'a Sides>,
}

/// The graph of a convex hull (`mesh_graph`).
#[derive(Clone, Copy, Debug)]
pub struct Hull<'a> {
    /// For each vertex of the hull where its neighbours begin in `edges`.
    pub first_edge: &'a [i32],
    /// For each vertex of the hull its index among the mesh's vertices.
    pub vertex: &'a [i32],
    /// Lists of neighbours, as vertices of the hull; each list ends with -1.
    pub edges: &'a [i32],
    /// Vertices of the mesh at the corners of each triangle of the hull.
    pub face: &'a [[i32; 3]],
}

impl Hull<'_> {
    /// The neighbours of a vertex of the hull.
    #[inline]
    pub fn neighbours(&self, vertex: usize) -> impl Iterator<Item = usize> + '_ {
        let list = self.edges.get(self.first_edge[vertex] as usize..).unwrap_or(&[]);
        list.iter().take_while(|&&e| e >= 0).map(|&e| e as usize)
    }
}

/// The data of a height field, a grid over its base.
#[derive(Clone, Copy, Debug, Default)]
pub struct Field<'a> {
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
    #[inline]
    pub(crate) fn step(&self) -> [f64; 2] {
        [2.0 * self.size[0] / (self.ncol as f64 - 1.0), 2.0 * self.size[1] / (self.nrow as f64 - 1.0)]
    }

    /// The sample at a row and column, in the frame of the geom, m.
    #[inline]
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
    pub fn new(kind: i32, size: Vec3, pos: Vec3, mat: Mat3) -> Shape<'a> {
        Shape { kind, size, pos, mat, mesh: Mesh::default(), field: Field::default() }
    }

    /// A geom where the data have it.
    #[inline]
    pub fn geom(m: &'a Model, d: &Data, g: usize) -> Shape<'a> {
        let (size, pos, mat) =
            (rows::<3>(&m.geom_size)[g], rows::<3>(&d.geom_xpos)[g], rows::<9>(&d.geom_xmat)[g]);
        let mut shape = Shape::new(m.geom_type[g], size, pos, mat);
        if let Ok(id) = usize::try_from(m.geom_dataid[g]) {
            match shape.kind {
                geom::MESH => shape.mesh = Mesh::of(m, id),
                geom::HFIELD => shape.field = Field::of(m, id),
                _ => {}
            }
        }
        shape
    }

    /// A site where the data have it.
    #[inline]
    pub fn site(m: &'a Model, d: &Data, s: usize) -> Shape<'a> {
        let (size, pos, mat) =
            (rows::<3>(&m.site_size)[s], rows::<3>(&d.site_xpos)[s], rows::<9>(&d.site_xmat)[s]);
        let mut shape = Shape::new(m.site_type[s], size, pos, mat);
        if let Ok(id) = usize::try_from(m.site_dataid[s]) {
            shape.mesh = Mesh::of(m, id);
        }
        shape
    }

    /// The axis `i` of its frame, world.
    #[inline(always)]
    pub(crate) fn axis(&self, i: usize) -> Vec3 {
        column(&self.mat, i)
    }

    /// A point of the world in its frame.
    #[inline(always)]
    pub(crate) fn local(&self, point: Vec3) -> Vec3 {
        mat_t_mul_vec(&self.mat, sub(point, self.pos))
    }

    /// A point of its frame in the world.
    #[inline(always)]
    pub(crate) fn world(&self, point: Vec3) -> Vec3 {
        add(mat_mul_vec(&self.mat, point), self.pos)
    }
}

impl<'a> Mesh<'a> {
    /// Mesh `id` of a model.
    pub fn of(m: &'a Model, id: usize) -> Mesh<'a> {
        let range = |adr: &[i32], num: &[i32]| {
            let first = adr[id].max(0) as usize;
            first..first + num[id].max(0) as usize
        };
        Mesh {
            vert: &rows::<3>(&m.mesh_vert)[range(&m.mesh_vertadr, &m.mesh_vertnum)],
            face: &m.mesh_face.as_chunks().0[range(&m.mesh_faceadr, &m.mesh_facenum)],
            hull: usize::try_from(m.mesh_graphadr[id]).ok().and_then(|adr| Hull::of(&m.mesh_graph[adr..])),
            sides: m.mesh_sides.get(id),
        }
    }
}

impl<'a> Hull<'a> {
    /// Layout: numbers of vertices and triangles, where each vertex's neighbours begin, the vertices, the lists of
    /// neighbours (six for each pair of triangles, and an end for each vertex), the triangles.
    pub(crate) fn of(graph: &'a [i32]) -> Option<Hull<'a>> {
        let [vertices, faces, rest @ ..] = graph else { return None };
        let (n, f) = (usize::try_from(*vertices).ok()?, usize::try_from(*faces).ok()?);
        let (first_edge, rest) = rest.split_at_checked(n)?;
        let (vertex, rest) = rest.split_at_checked(n)?;
        let (edges, rest) = rest.split_at_checked(n + 3 * f)?;
        let (face, _) = rest.split_at_checked(3 * f)?;
        (n > 0).then_some(Hull { first_edge, vertex, edges, face: face.as_chunks().0 })
    }
}

impl<'a> Field<'a> {
    /// Height field `id` of a model.
    pub fn of(m: &'a Model, id: usize) -> Field<'a> {
        let (nrow, ncol) = (m.hfield_nrow[id].max(0) as usize, m.hfield_ncol[id].max(0) as usize);
        let first = m.hfield_adr[id].max(0) as usize;
        let data = &m.hfield_data[first..first + nrow * ncol];
        Field { size: rows::<4>(&m.hfield_size)[id], nrow, ncol, data }
    }
}
