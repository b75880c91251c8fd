//! Triangle meshes from text, files or a rule. The vertices are relative to the centre of mass, along the principal axes. A mesh
//! has a volume, an inertia and a convex hull.
//!
//! [`Raw`] contains the data as given; [`build::mesh`] computes a [`CompiledMesh`] from it, in the order that MuJoCo's documentation
//! describes ("XML reference, asset/mesh"; details measured on the library).

pub(crate) mod build;
pub(crate) mod builtin;
mod bulk;
mod msh;
mod normals;
mod obj;
mod quickhull;
mod stl;
mod triangulate;

use crate::kinds::geom;
use crate::math::{Quat, Vec3, add, dot, norm, rotate, scale, sub};

pub(crate) use bulk::MeshBody;
pub(crate) use quickhull::{ConvexHull, Flat};

/// Limit for the vertices of a mesh: more than any collision shape needs.
pub(crate) const MAX_VERTICES: usize = 1_000_000;
/// Limit for the triangles of a mesh.
pub(crate) const MAX_FACES: usize = 2_000_000;

/// The data of a mesh as given in the text or a file.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Raw {
    /// Vertices, m, before scaling. Rounded to single precision, as in files.
    pub(crate) vert: Vec<Vec3>,
    pub(crate) normal: Vec<Vec3>,
    pub(crate) texcoord: Vec<[f64; 2]>,
    /// The vertices of each triangle. If empty, the faces are those of the convex hull of the vertices.
    pub(crate) face: Vec<[i32; 3]>,
    /// The normals of each triangle's corners. If empty, those of the vertices.
    pub(crate) facenormal: Vec<[i32; 3]>,
    /// The texture coordinates of each triangle's corners. If empty, those of the vertices.
    pub(crate) facetexcoord: Vec<[i32; 3]>,
}

/// A mesh ready for geoms.
#[derive(Clone, Debug)]
pub(crate) struct CompiledMesh {
    /// The shape for rendering and for rays: vertices in the frame of the mesh, m.
    pub(crate) shape: Raw,
    /// The vertices before scaling. The hull is computed from them.
    pub(crate) written: Vec<Vec3>,
    pub(crate) hull: Option<ConvexHull>,
    pub(crate) options: build::MeshOptions,
    /// Centre of mass in the frame in which the data were given, m.
    pub(crate) pos: Vec3,
    /// Orientation of the principal axes in that frame.
    pub(crate) quat: Quat,
    /// Volume, m^3, or area of a shell, m^2.
    pub(crate) amount: f64,
    /// Half lengths of the box with the same mass and moments of inertia, m.
    pub(crate) half: Vec3,
    /// Corners of the axis-aligned box that contains the vertices, m.
    pub(crate) lower: Vec3,
    pub(crate) upper: Vec3,
}

impl CompiledMesh {
    /// Centre and half lengths of the box that contains the vertices, m.
    pub(crate) fn aabb(&self) -> [f64; 6] {
        let ([a, b, c], [x, y, z]) = (self.centre(), scale(sub(self.upper, self.lower), 0.5));
        [a, b, c, x, y, z]
    }

    /// Half lengths of the box about the centre of mass that contains the vertices, m.
    pub(crate) fn reach(&self) -> Vec3 {
        [0, 1, 2].map(|i| self.lower[i].abs().max(self.upper[i].abs()))
    }

    /// Principal moments of the mesh for unit mass, m^2, computed from the equivalent box.
    pub(crate) fn moments(&self) -> Vec3 {
        let [x, y, z] = self.half.map(|h| h * h / 3.0);
        [y + z, x + z, x + y]
    }

    fn centre(&self) -> Vec3 {
        scale(add(self.upper, self.lower), 0.5)
    }

    /// A primitive shape that replaces the mesh: its centre, in the frame in which the data were given, and its sizes. The shape
    /// is fitted to the inertia, or to the bounding box. `None` for a type without volume.
    pub(crate) fn fit(&self, kind: i32, bounding: bool) -> Option<(Vec3, Vec3)> {
        let size = if bounding { self.enclosing_size(kind)? } else { self.equivalent(kind)? };
        let centre = if bounding { add(self.pos, rotate(self.centre(), self.quat)) } else { self.pos };
        Some((centre, size))
    }

    /// Sizes of the shape, from those of the box with the same inertia.
    fn equivalent(&self, kind: i32) -> Option<Vec3> {
        let [x, y, z] = self.half;
        let radius = (x + y) / 2.0;
        Some(match kind {
            geom::SPHERE => [(x + y + z) / 3.0, 0.0, 0.0],
            geom::CAPSULE => [radius, (z - radius / 2.0).max(0.0), 0.0],
            geom::CYLINDER => [radius, z, 0.0],
            geom::ELLIPSOID | geom::BOX => [x, y, z],
            _ => return None,
        })
    }

    /// Sizes of the shape, centred at the centre of the bounding box, that contains every vertex. Those of an ellipsoid are
    /// the sizes of the box.
    fn enclosing_size(&self, kind: i32) -> Option<Vec3> {
        let middle = self.centre();
        let largest = |distance: &dyn Fn(Vec3) -> f64| {
            self.shape.vert.iter().fold(0.0_f64, |largest, &v| largest.max(distance(sub(v, middle))))
        };
        let across = |[x, y, _]: Vec3| libm::sqrt(x * x + y * y);
        Some(match kind {
            geom::SPHERE => [largest(&norm), 0.0, 0.0],
            geom::CYLINDER => [largest(&across), largest(&|d| d[2].abs()), 0.0],
            geom::CAPSULE => {
                let radius = largest(&across);
                // Beyond the half length, the height of the cap at the vertex's distance from the axis is available.
                let cap = |d: Vec3| radius * libm::sin(libm::acos(across(d) / radius));
                [radius, largest(&|d| d[2].abs() - cap(d)), 0.0]
            }
            geom::ELLIPSOID | geom::BOX => sub(self.upper, middle),
            _ => return None,
        })
    }
}

/// Area, centre and unit normal of a triangle. The area of a degenerate triangle is zero.
pub(crate) fn triangle([a, b, c]: [Vec3; 3]) -> (f64, Vec3, Vec3) {
    let centre = [0, 1, 2].map(|i| (a[i] + b[i] + c[i]) / 3.0);
    let normal = crate::math::cross(sub(b, a), sub(c, a));
    let length = libm::sqrt(dot(normal, normal));
    if length < crate::math::MINVAL || !length.is_finite() {
        return (0.0, centre, normal);
    }
    (0.5 * length, centre, normal.map(|x| x / length))
}

/// An error in a mesh or height field, and what to do about it.
#[derive(Debug)]
pub(crate) struct AssetProblem {
    /// The attribute that contains the error.
    pub(crate) attribute: &'static str,
    /// The end of a sentence that starts with the asset.
    pub(crate) message: String,
    pub(crate) why: &'static str,
    pub(crate) help: &'static str,
}

impl AssetProblem {
    pub(crate) fn new(
        attribute: &'static str,
        message: impl Into<String>,
        why: &'static str,
        help: &'static str,
    ) -> AssetProblem {
        AssetProblem { attribute, message: message.into(), why, help }
    }

    /// A problem with the contents of a file.
    pub(crate) fn file(message: impl Into<String>, help: &'static str) -> AssetProblem {
        AssetProblem::new("file", message, "", help)
    }
}

/// The content type of MuJoCo's mesh files.
const MSH: &str = "model/vnd.mujoco.msh";

/// Reads a mesh from the bytes of a file. The extension of the file name determines the format. The `content_type` of MuJoCo's
/// format takes precedence, other content types have no effect, as in MuJoCo 3.14.0 (measured).
pub(crate) fn decode(path: &str, content_type: &str, bytes: &[u8]) -> Result<Raw, AssetProblem> {
    let ending = path.rsplit_once('.').map_or("", |(_, ending)| ending).to_ascii_lowercase();
    let ending = if content_type == MSH { "msh" } else { ending.as_str() };
    match ending {
        "stl" => stl::read(bytes),
        "obj" => obj::read(bytes),
        "msh" => msh::read(bytes),
        _ => Err(AssetProblem::file(
            "has a file whose name does not end in .obj, .stl or .msh",
            "export the mesh as Wavefront OBJ or as binary STL",
        )),
    }
}

/// Reads the numbers of a little-endian file in sequence.
pub(crate) struct Bytes<'b>(pub(crate) &'b [u8]);

impl Bytes<'_> {
    fn word(&mut self) -> Option<[u8; 4]> {
        let (word, rest) = self.0.split_first_chunk()?;
        self.0 = rest;
        Some(*word)
    }

    pub(crate) fn int(&mut self) -> Option<i32> {
        self.word().map(i32::from_le_bytes)
    }

    pub(crate) fn real(&mut self) -> Option<f64> {
        self.word().map(|w| f64::from(f32::from_le_bytes(w)))
    }

    pub(crate) fn reals<const N: usize>(&mut self) -> Option<[f64; N]> {
        let mut all = [0.0; N];
        for x in &mut all {
            *x = self.real()?;
        }
        Some(all)
    }

    pub(crate) fn ints<const N: usize>(&mut self) -> Option<[i32; N]> {
        let mut all = [0; N];
        for x in &mut all {
            *x = self.int()?;
        }
        Some(all)
    }
}
