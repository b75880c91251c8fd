//! The flat faces of a convex hull: triangles in one plane are merged.

use super::Hull;
use super::hull::vertex;
use crate::math::*;
use labspec_finding::order;

/// Triangles belong to one face if the cosine of the angle between their normals is above this.
const FLAT: f64 = 1.0 - 1e-7;

/// The faces of a hull.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct HullFaces {
    faces: Vec<FlatFace>,
    vertices: Vec<u32>,
    /// For each vertex, the start of its list of faces in `around`; one more entry marks the end.
    first: Vec<u32>,
    around: Vec<u32>,
}

/// A flat face: its unit normal, and its range in `vertices`.
#[derive(Clone, Debug, PartialEq)]
struct FlatFace {
    normal: Vec3,
    first: u32,
    count: u32,
}

impl HullFaces {
    /// The faces of the hull of a mesh with the vertices `vert`.
    pub fn from_hull(vert: &[Vec3], hull: &Hull) -> HullFaces {
        let mut faces = merge(vert, hull);
        faces.index(vert.len());
        faces
    }

    /// Serializes the faces to integers and floats.
    pub(crate) fn numbers(&self) -> (Vec<u32>, Vec<f64>) {
        let head = [&self.vertices, &self.first, &self.around].map(|list| list.len() as u32);
        let places = self.faces.iter().flat_map(|s| [s.first, s.count]);
        let lists = [&self.vertices, &self.first, &self.around].into_iter().flatten().copied();
        let floats = self.faces.iter().flat_map(|s| s.normal);
        (head.into_iter().chain(places).chain(lists).collect(), floats.collect())
    }

    /// Deserializes the output of [`HullFaces::numbers`] for a mesh with the given number of vertices. Returns `None`
    /// if the numbers are inconsistent.
    pub(crate) fn from_numbers(integers: &[u32], floats: &[f64], vertices: usize) -> Option<HullFaces> {
        let (&[a, b, c], mut rest) = integers.split_first_chunk::<3>()?;
        let count = floats.len() / 3;
        let mut take = |n: usize| {
            let (list, after) = rest.split_at_checked(n)?;
            rest = after;
            Some(list.to_vec())
        };
        let places = take(2 * count)?;
        let (corners, first, around) = (take(a as usize)?, take(b as usize)?, take(c as usize)?);
        let faces = places.as_chunks::<2>().0.iter().zip(floats.as_chunks::<3>().0);
        let faces = faces.map(|(&[first, count], &normal)| FlatFace { normal, first, count });
        let out = HullFaces { faces: faces.collect(), vertices: corners, first, around };
        let corners = out.vertices.len() as u64;
        let good = rest.is_empty()
            && floats.len().is_multiple_of(3)
            && out.faces.iter().all(|s| u64::from(s.first) + u64::from(s.count) <= corners)
            && out.vertices.iter().all(|&v| (v as usize) < vertices)
            && out.around.iter().all(|&s| (s as usize) < out.faces.len())
            && out.first.is_sorted()
            && out.first.iter().all(|&start| start as usize <= out.around.len())
            && (out.faces.is_empty() || out.first.len() == vertices + 1);
        good.then_some(out)
    }

    /// Number of faces.
    pub fn len(&self) -> usize {
        self.faces.len()
    }

    /// Whether there are no faces: the hull is not known.
    pub fn is_empty(&self) -> bool {
        self.faces.is_empty()
    }

    /// Outward unit normal of a face, in the frame of the mesh.
    pub fn normal(&self, side: usize) -> Vec3 {
        self.faces[side].normal
    }

    /// Vertices of a face, counterclockwise as seen from outside.
    pub fn vertices(&self, side: usize) -> &[u32] {
        let s = &self.faces[side];
        &self.vertices[s.first as usize..(s.first + s.count) as usize]
    }

    /// The faces that meet at a vertex, each with the position of the vertex in the list of that face.
    pub(crate) fn around(&self, vertex: usize) -> impl Iterator<Item = (usize, usize)> + '_ {
        let range = match (self.first.get(vertex), self.first.get(vertex + 1)) {
            (Some(&from), Some(&to)) => from as usize..to as usize,
            _ => 0..0,
        };
        self.around[range].iter().filter_map(move |&side| {
            let side = side as usize;
            Some((side, self.vertices(side).iter().position(|&v| v as usize == vertex)?))
        })
    }

    /// Builds the lists of faces for each of `n` vertices.
    fn index(&mut self, n: usize) {
        let mut pairs: Vec<(u32, u32)> = Vec::with_capacity(self.vertices.len());
        for side in 0..self.len() {
            pairs.extend(self.vertices(side).iter().map(|&v| (v, side as u32)));
        }
        order::sort_by(&mut pairs, Ord::cmp);
        self.first = (0..=n).map(|v| pairs.partition_point(|p| (p.0 as usize) < v) as u32).collect();
        self.around = pairs.into_iter().map(|p| p.1).collect();
    }
}

fn merge(vert: &[Vec3], hull: &Hull) -> HullFaces {
    let corner = |v: i32| vertex(vert, v as usize);
    let normals: Vec<Vec3> = hull
        .face
        .iter()
        .map(|&[a, b, c]| unit_vector(cross(sub(corner(b), corner(a)), sub(corner(c), corner(a)))).0)
        .collect();
    // Half-edges of all triangles, sorted so that they can be found by their two ends.
    let mut edges: Vec<(i32, i32, usize)> = Vec::new();
    for (t, f) in hull.face.iter().enumerate() {
        edges.extend((0..3).map(|k| (f[k], f[(k + 1) % 3], t)));
    }
    order::sort_by(&mut edges, Ord::cmp);
    let across = |a: i32, b: i32| {
        let index = edges.partition_point(|&(x, y, _)| (x, y) < (b, a));
        edges.get(index).filter(|&&(x, y, _)| (x, y) == (b, a)).map(|e| e.2)
    };
    let mut out = HullFaces::default();
    let mut side_of = vec![usize::MAX; hull.face.len()];
    for start in 0..hull.face.len() {
        if side_of[start] != usize::MAX {
            continue;
        }
        let side = out.faces.len();
        side_of[start] = side;
        let mut group = vec![start];
        let mut next = 0;
        while let Some(&t) = group.get(next) {
            next += 1;
            for k in 0..3 {
                let f = hull.face[t];
                if let Some(n) = across(f[k], f[(k + 1) % 3])
                    && side_of[n] == usize::MAX
                    && dot(normals[n], normals[start]) > FLAT
                {
                    side_of[n] = side;
                    group.push(n);
                }
            }
        }
        // The border consists of the edges whose other triangle belongs to another face.
        let edges =
            group.iter().flat_map(|&t| (0..3).map(move |k| (hull.face[t][k], hull.face[t][(k + 1) % 3])));
        let mut border: Vec<(i32, i32)> =
            edges.filter(|&(a, b)| across(a, b).is_none_or(|n| side_of[n] != side)).collect();
        order::sort_by(&mut border, Ord::cmp);
        let first = out.vertices.len() as u32;
        if border.is_empty() {
            continue;
        }
        walk_around(&border, &mut out.vertices);
        let count = out.vertices.len() as u32 - first;
        out.faces.push(FlatFace { normal: normals[start], first, count });
    }
    out
}

/// Appends the vertices of a border in order, starting with the first edge. The edges are sorted by their first
/// vertex.
fn walk_around(border: &[(i32, i32)], vertices: &mut Vec<u32>) {
    let Some(&(mut vertex, _)) = border.first() else { return };
    for _ in 0..border.len() {
        vertices.push(vertex as u32);
        let i = border.partition_point(|&(a, _)| a < vertex);
        match border.get(i) {
            Some(&(a, b)) if a == vertex => vertex = b,
            _ => break,
        }
    }
}
