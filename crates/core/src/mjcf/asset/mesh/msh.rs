//! MuJoCo's binary mesh format (XML reference, asset/mesh: MSH): the counts of vertices, normals, texture coordinates and
//! triangles, followed by these arrays, in single precision and 32-bit integers. There is one normal and one texture coordinate
//! per vertex.

use crate::mjcf::asset::mesh::{AssetProblem, Bytes, MAX_FACES, MAX_VERTICES, Raw};
use crate::mjcf::gather::listed;

pub(super) fn read(bytes: &[u8]) -> Result<Raw, AssetProblem> {
    let cut = || {
        AssetProblem::file(
            "has an MSH file that is shorter than its header",
            "export the mesh as OBJ or binary STL",
        )
    };
    let mut numbers = Bytes(bytes);
    let sizes: [i32; 4] = numbers.ints().ok_or_else(cut)?;
    let size = |i: usize| usize::try_from(sizes[i]).unwrap_or(usize::MAX);
    let [nvert, nnormal, ntexcoord, nface] = [size(0), size(1), size(2), size(3)];
    let same = |n: usize| n == 0 || n == nvert;
    if !(4..=MAX_VERTICES).contains(&nvert) || nface > MAX_FACES || !same(nnormal) || !same(ntexcoord) {
        let [v, n, t, f] = sizes;
        return Err(AssetProblem::file(
            format!(
                "has an MSH file of {v} vertices, {n} normals, {t} texture coordinates and {f} triangles"
            ),
            "it needs at least four vertices, and as many normals and texture coordinates, or none",
        ));
    }
    let need = 4 * (3 * nvert + 3 * nnormal + 2 * ntexcoord + 3 * nface);
    if numbers.0.len() != need {
        return Err(AssetProblem::file(
            format!("has an MSH file of {} bytes, but its header needs {}", bytes.len(), need + 16),
            "export the mesh as OBJ or binary STL: the file is damaged",
        ));
    }
    let mut raw = Raw {
        vert: listed((0..nvert).map_while(|_| numbers.reals())),
        normal: listed((0..nnormal).map_while(|_| numbers.reals())),
        texcoord: listed((0..ntexcoord).map_while(|_| numbers.reals())),
        face: listed((0..nface).map_while(|_| numbers.ints())),
        ..Raw::default()
    };
    raw.facenormal.clone_from(&raw.face);
    if ntexcoord > 0 {
        raw.facetexcoord.clone_from(&raw.face);
    }
    Ok(raw)
}
