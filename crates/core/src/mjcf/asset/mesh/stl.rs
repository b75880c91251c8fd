//! Binary STL (3D Systems 1988, *StereoLithography interface specification*): 80 arbitrary bytes, the number of
//! triangles, then for each triangle a normal, three corners and two unused bytes. The normals are not read.

use std::collections::HashMap;

use crate::mjcf::asset::mesh::{AssetProblem, Bytes, MAX_FACES, Raw};

const HEAD: usize = 84;
const TRIANGLE: usize = 50;
/// The largest valid coordinate. A larger one indicates a damaged file.
const FARTHEST: f64 = (1u64 << 30) as f64;

/// Reads a mesh. Corners at the same position become one vertex, in the order of their first occurrence.
pub(super) fn read(bytes: &[u8]) -> Result<Raw, AssetProblem> {
    if bytes.is_empty() {
        return Err(AssetProblem::file("has an empty file", "export the mesh again"));
    }
    if bytes.trim_ascii_start().starts_with(b"solid") && !fits(bytes) {
        return Err(AssetProblem::file(
            "has an STL file in text form",
            "export it as binary STL: MuJoCo reads only that",
        ));
    }
    if bytes.len() < HEAD {
        return Err(AssetProblem::file(
            format!("has an STL file of {} bytes, shorter than its header of {HEAD}", bytes.len()),
            "export the mesh again: the file is truncated",
        ));
    }
    let count = count(bytes).unwrap_or(0);
    if !(1..=MAX_FACES).contains(&count) {
        return Err(AssetProblem::file(
            format!("has an STL file of {count} triangles"),
            "export the mesh again, as binary STL with 1 to 2000000 triangles",
        ));
    }
    if !fits(bytes) {
        return Err(AssetProblem::file(
            format!(
                "has an STL file of {} bytes, but {count} triangles need {}",
                bytes.len(),
                HEAD + TRIANGLE * count
            ),
            "export the mesh again: the file is truncated, or in text form",
        ));
    }
    let mut raw = Raw::default();
    let mut places: HashMap<[u64; 3], i32> = HashMap::new();
    for record in bytes.get(HEAD..).unwrap_or(&[]).chunks_exact(TRIANGLE) {
        let mut numbers = Bytes(record);
        let mut face = [0; 3];
        let _normal = numbers.reals::<3>();
        for corner in &mut face {
            let v = numbers.reals::<3>().unwrap_or_default();
            if !v.iter().all(|x| x.abs() <= FARTHEST) {
                return Err(AssetProblem::file(
                    format!("has a corner at {} {} {}", v[0], v[1], v[2]),
                    "export the mesh again: a coordinate is too large or not a number",
                ));
            }
            // Maps negative zero to zero, so that both give the same vertex.
            let key = v.map(|x| (x + 0.0).to_bits());
            *corner = *places.entry(key).or_insert_with(|| {
                raw.vert.push(v);
                raw.vert.len() as i32 - 1
            });
        }
        raw.face.push(face);
    }
    Ok(raw)
}

/// The number of triangles that the header states.
fn count(bytes: &[u8]) -> Option<usize> {
    let word = bytes.get(HEAD - 4..HEAD)?;
    usize::try_from(Bytes(word).int()?).ok()
}

/// Whether the length of the file agrees with its header.
fn fits(bytes: &[u8]) -> bool {
    count(bytes).and_then(|n| n.checked_mul(TRIANGLE)?.checked_add(HEAD)) == Some(bytes.len())
}
