//! Wavefront OBJ (Wavefront Technologies 1992, *Advanced Visualizer*, appendix B1): the lines `v`, `vt`, `vn`, `f`.
//!
//! As in MuJoCo, only the triangles of the first object or group with faces are used, materials and other lines are ignored, and
//! the second texture coordinate is flipped.

use super::triangulate;
use crate::math::Vec3;
use crate::mjcf::asset::mesh::{AssetProblem, MAX_FACES, MAX_VERTICES, Raw};

/// The largest number of corners of a polygon.
const MAX_CORNERS: usize = 1000;

pub(super) fn read(bytes: &[u8]) -> Result<Raw, AssetProblem> {
    let mut raw = Raw::default();
    // The polygons of the current group.
    let mut polygons: Vec<Vec<Corner>> = Vec::new();
    let mut closed = false;
    let text = String::from_utf8_lossy(bytes);
    for (number, line) in text.split(['\n', '\r']).enumerate() {
        // A line break of two characters counts as two lines here. The line number is computed again for an error message.
        let wrong = |what: String| wrong(&text, number, what);
        let mut words = line.split_ascii_whitespace();
        match words.next() {
            Some("v") => raw.vert.push(numbers(&mut words).map_err(wrong)?),
            Some("vn") => raw.normal.push(numbers(&mut words).map_err(wrong)?),
            Some("vt") => {
                let [u, v] = numbers(&mut words).map_err(wrong)?;
                raw.texcoord.push([u, f64::from(1.0 - v as f32)]);
            }
            Some("f") if !closed => {
                let sizes = [raw.vert.len(), raw.texcoord.len(), raw.normal.len()];
                let corners: Result<Vec<Corner>, String> =
                    words.take(MAX_CORNERS + 1).map(|word| corner(word, sizes)).collect();
                let corners = corners.map_err(wrong)?;
                if corners.len() > MAX_CORNERS {
                    return Err(wrong(format!("a polygon of more than {MAX_CORNERS} corners")));
                }
                if corners.len() > 2 {
                    polygons.push(corners);
                }
            }
            Some("o" | "g") => closed = !polygons.is_empty(),
            _ => {}
        }
        if raw.vert.len() > MAX_VERTICES || raw.normal.len() > MAX_FACES || polygons.len() > MAX_FACES {
            return Err(AssetProblem::file(
                format!("has an OBJ file of more than {MAX_VERTICES} vertices or {MAX_FACES} polygons"),
                "simplify the mesh: only its convex hull makes contacts",
            ));
        }
    }
    add_triangles(&mut raw, &polygons)?;
    Ok(raw)
}

/// Divides polygons into the triangles of a mesh.
fn add_triangles(raw: &mut Raw, polygons: &[Vec<Corner>]) -> Result<(), AssetProblem> {
    for corners in polygons {
        let mut places: Vec<Vec3> = Vec::with_capacity(corners.len());
        for c in corners {
            // A face may refer to a vertex that is defined after it, so the check is done at the end of the file.
            let Some(&place) = raw.vert.get(c[0] as usize) else {
                return Err(AssetProblem::file(
                    format!(
                        "has a face with vertex {} in its OBJ file, which has {} vertices",
                        c[0] + 1,
                        raw.vert.len()
                    ),
                    "export the mesh again; vertices are numbered from 1",
                ));
            };
            places.push(place);
        }
        for triangle in triangulate::triangles(&places) {
            let indexes = |what: usize| triangle.map(|k| corners.get(k).map_or(-1, |c| c[what]));
            raw.face.push(indexes(0));
            if !raw.texcoord.is_empty() {
                raw.facetexcoord.push(indexes(1));
            }
            if !raw.normal.is_empty() {
                raw.facenormal.push(indexes(2));
            }
        }
    }
    Ok(())
}

/// Vertex, texture coordinate and normal of a corner; -1 if absent.
type Corner = [i32; 3];

/// Parses `v`, `v/t`, `v//n` or `v/t/n`. A negative number counts back from the last element read so far.
fn corner(word: &str, sizes: [usize; 3]) -> Result<Corner, String> {
    let mut corner = [-1; 3];
    for (i, part) in word.split('/').enumerate() {
        let Some(slot) = corner.get_mut(i) else { return Err(format!("`{word}` in a face")) };
        if part.is_empty() && i > 0 {
            continue;
        }
        let index: i32 = part.parse().map_err(|_| format!("`{word}` in a face"))?;
        let count = sizes[i] as i32;
        *slot = match index.signum() {
            1 => index - 1,
            -1 if index >= -count => index + count,
            _ => return Err(format!("the number {index} in a face, but only {count} vertices before it")),
        };
    }
    // Invalid normals and texture coordinates are ignored, because they affect rendering only.
    for i in 1..3 {
        if corner[i] as usize >= sizes[i] {
            corner[i] = -1;
        }
    }
    Ok(corner)
}

fn numbers<'w, const N: usize>(words: &mut impl Iterator<Item = &'w str>) -> Result<[f64; N], String> {
    let mut all = [0.0; N];
    for x in &mut all {
        let word = words.next().ok_or_else(|| format!("a line with fewer than {N} numbers"))?;
        let value: f32 = word.parse().map_err(|_| format!("`{word}` instead of a number"))?;
        if !value.is_finite() {
            return Err(format!("`{word}`, which is not finite"));
        }
        *x = f64::from(value);
    }
    Ok(all)
}

#[cold]
fn wrong(text: &str, number: usize, what: String) -> AssetProblem {
    let start: usize = text.split(['\n', '\r']).take(number).map(|line| line.len() + 1).sum();
    let line = text.get(..start).map_or(0, |before| before.lines().count()) + 1;
    AssetProblem::file(
        format!("has {what} in line {line} of its OBJ file"),
        "export the mesh again, with decimal points in numbers",
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_group_with_faces_counts() {
        let raw =
            read(b"g a\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\ng b\nf 1 2 3\nf -4//1 -2 -1\ng c\nf 1 3 4\n")
                .unwrap();
        assert_eq!((raw.vert.len(), raw.face), (4, vec![[0, 1, 2], [0, 2, 3]]));
        assert!(raw.facenormal.is_empty());
    }

    #[test]
    fn corners_have_texture_and_normal() {
        let raw =
            read(b"v 0 0 0\r\nv 1 0 0\r\nv 0 1 0\r\nvt 0 0.25\r\nvn 0 0 2\r\nf 1/1/1 2//1 3/1\r\n").unwrap();
        assert_eq!(raw.texcoord, [[0.0, 0.75]]);
        assert_eq!((raw.facetexcoord, raw.facenormal), (vec![[0, -1, 0]], vec![[0, 0, -1]]));
    }

    #[test]
    fn damage_has_a_line() {
        for (text, what) in [
            ("v 0 0\n", "fewer than 3 numbers in line 1"),
            ("# x\r\nv 0 0 zero\r\n", "`zero` instead of a number in line 2"),
            ("v 0 0 nan\n", "not finite in line 1"),
            ("v 0 0 0\nf 0 1 1\n", "the number 0 in a face"),
            ("v 0 0 0\nf -2 1 1\n", "the number -2 in a face"),
            ("v 0 0 0\nf 1 1 a\n", "`a` in a face in line 2"),
            ("v 0 0 0\nf 1 1 2\n", "vertex 2"),
        ] {
            let problem = read(text.as_bytes()).unwrap_err();
            assert!(problem.message.contains(what), "{text}: {}", problem.message);
        }
    }
}
