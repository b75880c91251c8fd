//! The convex hull of a mesh, as the model stores it.

use crate::math::{Vec3, broken_invariant};

/// The graph of a convex hull (`mesh_graph`).
#[derive(Clone, Copy, Debug)]
pub struct Hull<'a> {
    /// For each vertex of the hull, the start of its list of neighbours in `edges`.
    pub first_edge: &'a [i32],
    /// For each vertex of the hull, its index among the vertices of the mesh.
    pub vertex: &'a [i32],
    /// Lists of neighbours, as vertices of the hull. Each list ends with -1.
    pub edges: &'a [i32],
    /// For each triangle of the hull, the mesh vertices at its corners.
    pub face: &'a [[i32; 3]],
}

impl Hull<'_> {
    /// The neighbours of a vertex of the hull.
    pub fn neighbours(&self, vertex: usize) -> impl Iterator<Item = usize> + '_ {
        let list = self.edges.get(self.first_edge[vertex] as usize..).unwrap_or(&[]);
        list.iter().take_while(|&&e| e >= 0).map(|&e| e as usize)
    }
}

impl<'a> Hull<'a> {
    /// Parses `mesh_graph`. Its layout: number of vertices, number of triangles, start of the neighbour list of each
    /// vertex, mesh index of each vertex, neighbour lists (six entries for each pair of triangles, and an end marker
    /// for each vertex), triangles. Returns `None` if the array is too short or has no vertices.
    pub fn from_graph(graph: &'a [i32]) -> Option<Hull<'a>> {
        let [vertices, faces, rest @ ..] = graph else { return None };
        let (n, f) = (usize::try_from(*vertices).ok()?, usize::try_from(*faces).ok()?);
        let (first_edge, rest) = rest.split_at_checked(n)?;
        let (vertex, rest) = rest.split_at_checked(n)?;
        let (edges, rest) = rest.split_at_checked(n + 3 * f)?;
        let (face, _) = rest.split_at_checked(3 * f)?;
        (n > 0).then_some(Hull { first_edge, vertex, edges, face: face.as_chunks().0 })
    }
}

/// The vertex with index `v` of a mesh.
#[cfg_attr(not(feature = "small"), inline(always))]
pub(crate) fn vertex(vert: &[Vec3], v: usize) -> Vec3 {
    vert.get(v).copied().unwrap_or_else(|| broken_invariant("a mesh has the vertices that its faces name"))
}
