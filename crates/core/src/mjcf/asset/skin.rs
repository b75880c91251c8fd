//! Skins: triangles whose vertices follow bodies ("bones") with weights. The simulation does not use them; a frontend
//! that renders them reads their data from the model (XML reference, `deformable/skin`; details measured on the library).

use crate::mjcf::gather::listed;
use std::ops::Range;

use super::mesh::{AssetProblem, Bytes, MAX_FACES, MAX_VERTICES};
use crate::math::MINVAL;

/// The data of a skin as given in the text or a file.
#[derive(Debug, Default)]
pub(crate) struct Skin {
    /// Vertices, m.
    pub(crate) vert: Vec<[f64; 3]>,
    /// A pair for each vertex, or none.
    pub(crate) texcoord: Vec<[f64; 2]>,
    /// The vertices of each triangle.
    pub(crate) face: Vec<[i32; 3]>,
    pub(crate) bones: Vec<Bone>,
    pub(crate) material: Option<String>,
    pub(crate) rgba: [f64; 4],
    /// The distance by which vertices are moved along their normals, m.
    pub(crate) inflate: f64,
    pub(crate) group: i32,
}

/// The vertices of a skin that one body carries.
#[derive(Debug)]
pub(crate) struct Bone {
    pub(crate) body: String,
    /// The pose of the body in which the vertices are given: m, and a unit quaternion (zero stays zero).
    pub(crate) bindpos: [f64; 3],
    pub(crate) bindquat: [f64; 4],
    pub(crate) vertid: Vec<i32>,
    /// The weight of the body for each of these vertices. After completion, the weights of each vertex sum to 1.
    pub(crate) vertweight: Vec<f64>,
    /// The span that names the file, if the bone is read from a file.
    pub(crate) file: Option<Range<usize>>,
}

/// The number of bytes of a body name in a file.
const NAME: usize = 40;

impl Skin {
    /// Checks that the parts are consistent, and normalizes the weights of each vertex to the sum 1.
    pub(crate) fn complete(mut self) -> Result<Skin, AssetProblem> {
        if self.vert.is_empty() || self.face.is_empty() || self.bones.is_empty() {
            let missing = [
                ("vertices", self.vert.is_empty()),
                ("triangles", self.face.is_empty()),
                ("bones", self.bones.is_empty()),
            ];
            let missing = listed(missing.iter().filter(|m| m.1).map(|m| m.0)).join(" and no ");
            return Err(AssetProblem::new(
                "",
                format!("has no {missing}"),
                "a skin is a surface that bodies carry",
                "write `vertex`, `face` and a `bone` for each body that carries it, or name a `file`",
            ));
        }
        let n = self.vert.len();
        if !self.texcoord.is_empty() && self.texcoord.len() != n {
            return Err(AssetProblem::new(
                "texcoord",
                format!("has {} texture coordinates for {n} vertices", self.texcoord.len()),
                "",
                "write a pair of numbers for each vertex",
            ));
        }
        let is_vertex = |&id: &i32| usize::try_from(id).is_ok_and(|id| id < n);
        if let Some(id) = self.face.as_flattened().iter().find(|id| !is_vertex(id)) {
            return Err(AssetProblem::new(
                "face",
                format!("has a triangle with vertex {id}, of {n} vertices"),
                "a renderer would read past the end",
                "count vertices from 0",
            ));
        }
        let total = self.total_weights(n)?;
        if let Some(i) = total.iter().position(|&sum| sum.is_nan() || sum <= MINVAL) {
            return Err(AssetProblem::new(
                "",
                format!("has a vertex {i} that no bone carries"),
                "the weights of a vertex give the share of each body, and their sum must be positive",
                "give the vertex to a bone, with a positive weight",
            ));
        }
        for bone in &mut self.bones {
            for (id, weight) in bone.vertid.iter().zip(&mut bone.vertweight) {
                *weight /= total.get(*id as usize).copied().unwrap_or(1.0);
            }
            let length = libm::sqrt(bone.bindquat.iter().map(|x| x * x).sum());
            if length > MINVAL {
                bone.bindquat = bone.bindquat.map(|x| x / length);
            }
        }
        Ok(self)
    }

    /// The sum of the weights of each of `n` vertices.
    fn total_weights(&self, n: usize) -> Result<Vec<f64>, AssetProblem> {
        let mut total = vec![0.0; n];
        for bone in &self.bones {
            let (ids, weights) = (bone.vertid.len(), bone.vertweight.len());
            if ids != weights || ids == 0 {
                return Err(AssetProblem::new(
                    "",
                    format!("has a bone of {ids} vertices with {weights} weights"),
                    "",
                    "write one weight for each vertex of the bone, and at least one vertex",
                ));
            }
            for (id, weight) in bone.vertid.iter().zip(&bone.vertweight) {
                let Some(sum) = usize::try_from(*id).ok().and_then(|id| total.get_mut(id)) else {
                    return Err(AssetProblem::new(
                        "",
                        format!("has a bone with vertex {id}, of {n} vertices"),
                        "",
                        "count vertices from 0",
                    ));
                };
                *sum += weight;
            }
        }
        Ok(total)
    }
}

/// Reads MuJoCo's binary skin format (XML reference, SKN): the counts of vertices, texture coordinates, triangles and bones, then
/// these, in single precision and 32-bit integers. A bone consists of the name of its body, its pose, and its vertices with their
/// weights.
pub(crate) fn decode(path: &str, bytes: &[u8], span: &Range<usize>) -> Result<Skin, AssetProblem> {
    let ending = path.rsplit_once('.').map_or("", |(_, ending)| ending);
    if !ending.eq_ignore_ascii_case("skn") {
        return Err(AssetProblem::file(
            "has a file whose name does not end in .skn",
            "export the skin in MuJoCo's binary format",
        ));
    }
    let mut numbers = Bytes(bytes);
    let sizes: [i32; 4] = numbers.ints().ok_or_else(damaged)?;
    let [nvert, ntexcoord, nface, nbone] = sizes.map(|n| usize::try_from(n).unwrap_or(usize::MAX));
    if nvert > MAX_VERTICES || ntexcoord > MAX_VERTICES || nface > MAX_FACES || nbone > MAX_VERTICES {
        let [v, t, f, b] = sizes;
        let message =
            format!("has an SKN file of {v} vertices, {t} texture coordinates, {f} triangles and {b} bones");
        return Err(AssetProblem::file(message, "the file is damaged: export it again"));
    }
    // Checks the length before allocation, so that the size of the file bounds the memory.
    if numbers.0.len() < 4 * (3 * nvert + 2 * ntexcoord + 3 * nface) {
        return Err(damaged());
    }
    let mut skin = Skin {
        vert: listed((0..nvert).map_while(|_| numbers.reals())),
        texcoord: listed((0..ntexcoord).map_while(|_| numbers.reals())),
        face: listed((0..nface).map_while(|_| numbers.ints())),
        ..Skin::default()
    };
    for _ in 0..nbone {
        skin.bones.push(read_bone(&mut numbers, span)?);
    }
    if !numbers.0.is_empty() {
        let message = format!("has an SKN file with {} bytes more than its header says", numbers.0.len());
        return Err(AssetProblem::file(message, "the file is damaged: export it again"));
    }
    let numbers = skin.vert.as_flattened().iter().chain(skin.texcoord.as_flattened());
    let of_bones = skin.bones.iter().flat_map(|b| b.bindpos.iter().chain(&b.bindquat).chain(&b.vertweight));
    if numbers.chain(of_bones).any(|x| !x.is_finite()) {
        return Err(AssetProblem::file(
            "has an SKN file with a number that is not finite",
            "write finite numbers",
        ));
    }
    Ok(skin)
}

fn damaged() -> AssetProblem {
    AssetProblem::file(
        "has an SKN file that is shorter than its header says",
        "the file is damaged: export it again",
    )
}

/// Reads the next bone.
fn read_bone(numbers: &mut Bytes, span: &Range<usize>) -> Result<Bone, AssetProblem> {
    let (name, rest) = numbers.0.split_at_checked(NAME).ok_or_else(damaged)?;
    *numbers = Bytes(rest);
    let end = name.iter().position(|&c| c == 0).unwrap_or(NAME - 1);
    let body = String::from_utf8_lossy(name.get(..end).unwrap_or(name)).into_owned();
    let (Some(bindpos), Some(bindquat), Some(n)) = (numbers.reals(), numbers.reals(), numbers.int()) else {
        return Err(damaged());
    };
    let n = usize::try_from(n).ok().filter(|&n| n <= numbers.0.len() / 8).ok_or_else(damaged)?;
    let vertid = listed((0..n).map_while(|_| numbers.int()));
    let vertweight = listed((0..n).map_while(|_| numbers.real()));
    Ok(Bone { body, bindpos, bindquat, vertid, vertweight, file: Some(span.clone()) })
}
