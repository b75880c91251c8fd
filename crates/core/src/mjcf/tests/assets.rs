//! Meshes and height fields from files: damaged, malicious, large.

use std::collections::BTreeMap;

use crate::mjcf::compile_with;
use crate::model::Model;
use crate::source::files::Files;
use crate::step::step;
use crate::step::workspace::Workspace;

fn load(asset: &str, geom: &str, file: &str, bytes: &[u8]) -> Result<Model, String> {
    let files = BTreeMap::from([(file.to_string(), bytes.to_vec())]);
    let xml = format!(
        "<mujoco><asset>{asset}</asset><worldbody><geom {geom}/><body name='ball' pos='0 0 1'><freejoint/><geom size='0.1'/></body></worldbody></mujoco>"
    );
    compile_with(&xml, &files as &dyn Files, None).map_err(|list| list[0].message.clone())
}

fn mesh(file: &str, bytes: &[u8]) -> Result<Model, String> {
    load(&format!("<mesh name='m' file='{file}'/>"), "type='mesh' mesh='m'", file, bytes)
}

fn to_bytes(list: &[f32]) -> impl Iterator<Item = u8> + '_ {
    list.iter().flat_map(|x| x.to_le_bytes())
}

const CORNERS: [[f32; 3]; 4] = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.5]];
const FACES: [[usize; 3]; 4] = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];

fn stl() -> Vec<u8> {
    let mut bytes = vec![0; 80];
    bytes.extend(4_i32.to_le_bytes());
    for face in FACES {
        bytes.extend([0; 12]);
        bytes.extend(face.iter().flat_map(|&v| to_bytes(&CORNERS[v]).collect::<Vec<u8>>()));
        bytes.extend([0; 2]);
    }
    bytes
}

fn msh() -> Vec<u8> {
    let mut bytes: Vec<u8> = [4_i32, 0, 0, 4].iter().flat_map(|n| n.to_le_bytes()).collect();
    bytes.extend(to_bytes(CORNERS.as_flattened()));
    bytes.extend(FACES.as_flattened().iter().flat_map(|&v| (v as i32).to_le_bytes()));
    bytes
}

fn hfield() -> Vec<u8> {
    let mut bytes: Vec<u8> = [2_i32, 3].iter().flat_map(|n| n.to_le_bytes()).collect();
    bytes.extend(to_bytes(&[0.0, 1.0, 2.0, 3.0, 1.0, 0.0]));
    bytes
}

const OBJ: &[u8] = b"v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1.5\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";

/// A skin with one triangle, whose vertices follow two bodies.
fn skn() -> Vec<u8> {
    let mut bytes: Vec<u8> = [3_i32, 3, 1, 2].iter().flat_map(|n| n.to_le_bytes()).collect();
    bytes.extend(to_bytes(&[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0]));
    bytes.extend(to_bytes(&[0.0, 0.0, 1.0, 0.0, 0.0, 1.0]));
    bytes.extend([0_i32, 1, 2].iter().flat_map(|n| n.to_le_bytes()));
    for (body, ids) in [("world", &[0_i32, 1][..]), ("ball", &[2])] {
        let mut name = body.as_bytes().to_vec();
        name.resize(40, 0);
        bytes.extend(name);
        bytes.extend(to_bytes(&[0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 0.0]));
        bytes.extend((ids.len() as i32).to_le_bytes());
        bytes.extend(ids.iter().flat_map(|n| n.to_le_bytes()));
        bytes.extend(to_bytes(&vec![0.5; ids.len()]));
    }
    bytes
}

fn skin(bytes: &[u8]) -> Result<Model, String> {
    load("<skin name='s' file='a.skn'/>", "size='1'", "a.skn", bytes)
}

fn field(bytes: &[u8]) -> Result<Model, String> {
    load("<hfield name='h' file='h.bin' size='1 1 1 1'/>", "type='hfield' hfield='h'", "h.bin", bytes)
}

#[test]
fn three_formats_are_one_mesh() {
    let [obj, stl, msh] = [("a.obj", OBJ.to_vec()), ("a.STL", stl()), ("a.msh", msh())]
        .map(|(name, bytes)| mesh(name, &bytes).unwrap());
    for other in [&stl, &msh] {
        for (a, b) in obj.mesh_pos.iter().zip(&other.mesh_pos) {
            assert!((a - b).abs() < 1e-15);
        }
        assert_eq!((obj.nmeshvert, obj.nmeshface), (other.nmeshvert, other.nmeshface));
    }
}

/// A file that is truncated anywhere, or has any byte changed, is refused or gives a mesh that can be simulated.
#[test]
fn damaged_files_are_errors() {
    let go = |model: Result<Model, String>| {
        if let Ok(m) = model {
            let Workspace { fields: mut d, scratch: mut s } = Workspace::new(&m);
            (0..3).for_each(|_| step(&m, &mut d, &mut s));
        }
    };
    for (name, bytes) in
        [("a.obj", OBJ.to_vec()), ("a.stl", stl()), ("a.msh", msh()), ("h.bin", hfield()), ("a.skn", skn())]
    {
        let load = |bytes: &[u8]| match name {
            "h.bin" => field(bytes),
            "a.skn" => skin(bytes),
            _ => mesh(name, bytes),
        };
        assert!(load(&bytes).is_ok(), "{name}");
        for end in 0..bytes.len() {
            let cut = load(&bytes[..end]);
            assert!(cut.is_err() || name == "a.obj", "{name} {end}");
        }
        for offset in 0..bytes.len() {
            for change in [0x80, 0x7f, 0xff] {
                let mut damaged = bytes.clone();
                damaged[offset] ^= change;
                go(load(&damaged));
            }
        }
    }
}

#[test]
fn a_large_mesh_is_ready_in_seconds() {
    let start = std::time::Instant::now();
    let n = 100_000;
    let mut text = String::new();
    for i in 0..n {
        let (h, a) = (1.0 - 2.0 * (f64::from(i) + 0.5) / f64::from(n), 2.399_963 * f64::from(i));
        let r = (1.0 - h * h).sqrt();
        text += &format!("v {} {} {}\n", r * a.cos(), 0.9 * r * a.sin(), 0.8 * h);
    }
    let m = mesh("a.obj", text.as_bytes()).unwrap();
    assert!(m.mesh_graph[0] > n / 2);
    assert!(start.elapsed().as_secs() < 60, "{:?}", start.elapsed());
}

#[test]
fn images_and_text_stl_are_refused_by_name() {
    let png = field(b"\x89PNG\r\n\x1a\n").unwrap_err();
    assert!(png.contains("PNG"), "{png}");
    let text = mesh("a.stl", b"solid a\nfacet normal 0 0 1\n").unwrap_err();
    assert!(text.contains("text form"), "{text}");
    assert!(mesh("a.ply", b"ply").unwrap_err().contains("does not end in"));
}

/// Skins that MuJoCo 3.14.0 refuses, with the messages. One case is accepted by MuJoCo and refused here: a triangle with a vertex
/// that does not exist, for which a renderer would read beyond the end of the list.
#[test]
fn skins_that_do_not_fit() {
    let bone = "<bone body='ball' bindpos='0 0 0' bindquat='1 0 0 0' vertid='0 1 2' vertweight='1 1 1'/>";
    let vertex = "vertex='0 0 0 1 0 0 0 1 0' face='0 1 2'";
    let cases = [
        (vertex.to_string(), String::new(), "no bones"),
        ("face='0 1 2'".into(), bone.into(), "no vertices"),
        ("vertex='0 0 0 1 0 0'".into(), bone.into(), "no triangles"),
        (String::new(), String::new(), "no vertices and no triangles and no bones"),
        (vertex.replace("0 1 2", "0 1 2 0"), bone.into(), "4 numbers in `face`"),
        (vertex.replace("0 1 2", "0 1 3"), bone.into(), "a triangle with vertex 3, of 3 vertices"),
        (vertex.replace("0 1 2", "0 1 -1"), bone.into(), "a triangle with vertex -1"),
        (format!("{vertex} texcoord='0 0 1 1'"), bone.into(), "2 texture coordinates for 3 vertices"),
        (format!("{vertex} group='6'"), bone.into(), "in group 6"),
        (format!("{vertex} material='nix'"), bone.into(), "no material named `nix`"),
        (vertex.into(), bone.replace("ball", "nix"), "no body named `nix`"),
        (vertex.into(), bone.replace("'0 1 2'", "'0 1 3'"), "a bone with vertex 3"),
        (vertex.into(), bone.replace("'0 1 2'", "'0 1'"), "a bone of 2 vertices with 3 weights"),
        (vertex.into(), bone.replace("'1 1 1'", "'1 1 0'"), "a vertex 2 that no bone carries"),
        (vertex.into(), bone.replace("'1 1 1'", "'1 1 -1'"), "a vertex 2 that no bone carries"),
        (vertex.into(), bone.replace("bindpos='0 0 0'", ""), "has no `bindpos`"),
        (vertex.into(), bone.replace("body='ball'", ""), "has no `body`"),
        ("file='a.skn' face='0 1 2'".into(), String::new(), "both a file and inline data"),
        ("file='a.skn'".into(), bone.into(), "both a file and inline data"),
        ("file='a.txt'".into(), String::new(), "does not end in .skn"),
        ("file='b.skn'".into(), String::new(), "b.skn"),
    ];
    for (attributes, bones, expected) in cases {
        let file = if attributes.contains("a.txt") { "a.txt" } else { "a.skn" };
        let asset = format!("<skin name='s' {attributes}>{bones}</skin>");
        let message = load(&asset, "size='1'", file, &skn()).err();
        assert!(
            message.as_ref().is_some_and(|m| m.contains(expected)),
            "{asset}: {message:?}, not {expected}"
        );
    }
    assert!(load(&format!("<skin {vertex}>{bone}</skin>"), "size='1'", "a.skn", &[]).is_ok());
    let mut other = skn();
    other[0x58..0x5c].copy_from_slice(b"wor2");
    assert!(skin(&other).unwrap_err().contains("`wor2"), "{:?}", skin(&other));
}

/// Declarations of textures with their defaults and the paths of their files, for views.
#[test]
fn textures_are_declared() {
    let m = crate::mjcf::compile(
        "<mujoco><compiler texturedir='pictures'/><asset>
        <texture name='sky' type='skybox' builtin='gradient' rgb1='0.3 0.5 0.7' rgb2='0 0 0' width='512' height='3072'/>
        <texture name='floor' type='2d' builtin='checker' mark='edge' markrgb='1 0 0' random='0.2' width='300' height='200'/>
        <texture file='wall.png'/>
        <texture name='cube' type='cube' fileright='a/r.png' fileback='../b.png' hflip='true'/>
        <texture name='grid' type='cube' file='g.png' gridsize='3 4' gridlayout='.U..LFRB.D..'/></asset>
        <worldbody><geom size='1'/></worldbody></mujoco>",
    )
    .unwrap();
    let [sky, floor, wall, cube, grid] = m.textures.as_slice() else { panic!("{:?}", m.textures) };
    assert_eq!((sky.kind, sky.builtin, sky.size, sky.rgb1), (2, 1, [512, 3072], [0.3, 0.5, 0.7]));
    assert_eq!((floor.kind, floor.builtin, floor.mark, floor.random), (0, 2, 1, 0.2));
    assert_eq!((floor.markrgb, floor.rgb1, floor.rgb2), ([1.0, 0.0, 0.0], [0.8; 3], [0.5; 3]));
    assert_eq!((wall.kind, wall.files.as_slice()), (1, ["pictures/wall.png".to_string()].as_slice()));
    assert_eq!(cube.files, ["pictures/a/r.png", "", "", "", "", "b.png"]);
    assert_eq!((cube.flip, grid.gridsize, grid.gridlayout.as_str()), ([true, false], [3, 4], ".U..LFRB.D.."));
    assert_eq!(m.names.texture, ["sky", "floor", "wall", "cube", "grid"]);
}
