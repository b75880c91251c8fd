//! A compiled model as bytes. With them, a frontend can ship models without the MJCF parser.
//!
//! The format: a header (a magic word, the version, a hash of the table of fields), sizes, then every field in the order of the
//! table, names, textures, texts, exclusions and hull faces, and a hash of everything before it. Numbers are little-endian. A file may come
//! from any source: its hash is checked, and all integers that the engine uses as indexes are validated.

use crate::dynamics::tree_algorithms;
use crate::geometry::HullFaces;
use crate::model::bytes::{FixedSize, fingerprint};
use crate::model::reflect::{self, Elem, Object};
use crate::model::texture::Texture;
use crate::model::{Model, Names};
use crate::step::validate::validate;

const MAGIC: [u8; 8] = *b"labmodl\n";
/// The version of the layout that this module writes.
const VERSION: u32 = 4;

fn write_text(text: &str, out: &mut Vec<u8>) {
    text.len().put(out);
    out.extend_from_slice(text.as_bytes());
}

fn read_text(bytes: &mut &[u8]) -> Option<String> {
    let n = usize::take(bytes)?;
    let (text, rest) = bytes.split_at_checked(n)?;
    *bytes = rest;
    String::from_utf8(text.to_vec()).ok()
}

fn write_list<T>(list: &[T], out: &mut Vec<u8>, mut put: impl FnMut(&T, &mut Vec<u8>)) {
    list.len().put(out);
    list.iter().for_each(|x| put(x, out));
}

fn read_list<T>(bytes: &mut &[u8], mut take: impl FnMut(&mut &[u8]) -> Option<T>) -> Option<Vec<T>> {
    let n = usize::take(bytes)?;
    // Every element has at least one byte. The check prevents an allocation that is larger than the input.
    if n > bytes.len() {
        return None;
    }
    (0..n).map(|_| take(bytes)).collect()
}

fn write_texture(t: &Texture, out: &mut Vec<u8>) {
    let [width, height] = t.size;
    let [rows, columns] = t.gridsize;
    for x in [t.kind, t.builtin, t.mark, width, height, t.nchannel, rows, columns] {
        x.put(out);
    }
    for x in [t.rgb1, t.rgb2, t.markrgb].as_flattened() {
        x.put(out);
    }
    t.random.put(out);
    for flip in t.flip {
        u32::from(flip).put(out);
    }
    write_list(&t.files, out, |file, out| write_text(file, out));
    write_text(&t.gridlayout, out);
}

fn read_texture(bytes: &mut &[u8]) -> Option<Texture> {
    fn three(bytes: &mut &[u8]) -> Option<[f64; 3]> {
        Some([f64::take(bytes)?, f64::take(bytes)?, f64::take(bytes)?])
    }
    // Fields are read in the order in which they are written.
    let [kind, builtin, mark] = [i32::take(bytes)?, i32::take(bytes)?, i32::take(bytes)?];
    let (size, nchannel) = ([i32::take(bytes)?, i32::take(bytes)?], i32::take(bytes)?);
    let gridsize = [i32::take(bytes)?, i32::take(bytes)?];
    let [rgb1, rgb2, markrgb] = [three(bytes)?, three(bytes)?, three(bytes)?];
    let random = f64::take(bytes)?;
    let flip = [u32::take(bytes)? != 0, u32::take(bytes)? != 0];
    let files = read_list(bytes, read_text)?;
    let gridlayout = read_text(bytes)?;
    Some(Texture {
        kind,
        builtin,
        mark,
        rgb1,
        rgb2,
        markrgb,
        random,
        size,
        nchannel,
        files,
        gridsize,
        gridlayout,
        flip,
    })
}

/// Writes a model to bytes.
pub fn write(m: &Model) -> Vec<u8> {
    let mut out = MAGIC.to_vec();
    VERSION.put(&mut out);
    reflect::table(false).put(&mut out);
    // Sizes come first, because they determine the lengths of the other fields.
    for field in reflect::fields().filter(|f| f.info().object != Object::Data) {
        if field.info().elem == Elem::Size {
            reflect::write_model(m, field, &mut out);
        }
    }
    for field in reflect::fields().filter(|f| f.info().object != Object::Data) {
        if field.info().elem != Elem::Size {
            reflect::write_model(m, field, &mut out);
        }
    }
    write_text(&m.names.model, &mut out);
    for list in m.names.lists() {
        write_list(list, &mut out, |name, out| write_text(name, out));
    }
    write_list(&m.textures, &mut out, write_texture);
    write_list(&m.texts, &mut out, |text, out| write_text(text, out));
    write_list(&m.exclude_bodies, &mut out, |pair, out| pair.put(out));
    write_list(&m.visual_geoms, &mut out, |geom, out| geom.put(out));
    write_list(&m.planar_trees, &mut out, |tree, out| tree.put(out));
    write_list(&m.mesh_sides, &mut out, |hull_faces, out| {
        let (integers, floats) = hull_faces.numbers();
        write_list(&integers, out, |x, out| x.put(out));
        write_list(&floats, out, |x, out| x.put(out));
    });
    fingerprint(&out).put(&mut out);
    out
}

/// Reads the bytes of [`write`](fn@write). `None` for any other bytes.
pub fn read(bytes: &[u8]) -> Option<Model> {
    let (body, end) = bytes.split_last_chunk::<8>()?;
    if fingerprint(body) != u64::from_le_bytes(*end) {
        return None;
    }
    let mut rest = body;
    let bytes = &mut rest;
    let header = <[u8; 8]>::take(bytes)? == MAGIC
        && u32::take(bytes)? == VERSION
        && u64::take(bytes)? == reflect::table(false);
    if !header {
        return None;
    }
    let mut m = Model::default();
    for size in [true, false] {
        for field in reflect::fields().filter(|f| f.info().object != Object::Data) {
            if (field.info().elem == Elem::Size) == size && !reflect::read_model(&mut m, field, bytes) {
                return None;
            }
        }
    }
    m.names = Names { model: read_text(bytes)?, ..Names::default() };
    for list in m.names.lists_mut() {
        *list = read_list(bytes, read_text)?;
    }
    m.textures = read_list(bytes, read_texture)?;
    m.texts = read_list(bytes, read_text)?;
    m.exclude_bodies = read_list(bytes, FixedSize::take)?;
    m.visual_geoms = read_list(bytes, FixedSize::take)?;
    m.planar_trees = read_list(bytes, FixedSize::take)?;
    let mut mesh = 0..m.nmesh;
    m.mesh_sides = read_list(bytes, |bytes| {
        let (integers, floats) = (read_list(bytes, u32::take)?, read_list(bytes, f64::take)?);
        let corners = usize::try_from(*m.mesh_vertnum.get(mesh.next()?)?).ok()?;
        HullFaces::from_numbers(&integers, &floats, corners)
    })?;
    let good = rest.is_empty() && validate(&m).is_none() && tree_algorithms::are_chains(&m, &m.planar_trees);
    good.then_some(m)
}

#[cfg(test)]
mod tests {
    use crate::model::reflect::{self, Elem, Object};
    use crate::step::validate::validate;
    use crate::tests::compile;

    const EVERYTHING: &str = "<mujoco>
        <asset><texture name='x' type='2d' builtin='checker' width='8' height='8'/><mesh name='m' vertex='0 0 0 1 0 0 0 1 0 0 0 1'/><hfield name='h' nrow='2' ncol='2' size='1 1 1 1'/></asset>
        <worldbody><geom type='hfield' hfield='h'/>
        <body name='a'><freejoint/><geom type='mesh' mesh='m'/><site name='s'/></body>
        <body name='b'><joint name='j'/><geom size='0.1'/><site name='t' pos='1 0 0'/>
        <body pos='1 0 0'><joint name='k'/><geom name='w' size='0.1'/></body></body></worldbody>
        <tendon><spatial name='l'><site site='s'/><geom geom='w'/><site site='t'/></spatial>
        <fixed name='f'><joint joint='j' coef='1'/></fixed></tendon>
        <equality><connect body1='a' body2='b' anchor='0 0 0'/><joint joint1='j' joint2='k'/></equality>
        <actuator><motor joint='j'/><position tendon='l'/></actuator><sensor><jointpos joint='j'/><touch site='s'/></sensor>
        </mujoco>";

    /// Every compiled model is valid.
    #[test]
    fn compiled_models_are_valid() {
        let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/golden/models");
        let mut wrong = Vec::new();
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            let Ok(text) = std::fs::read_to_string(&path) else { continue };
            let Ok(m) = compile(&text) else { continue };
            if let Some(what) = validate(&m) {
                wrong.push(format!("{}: {what}", path.display()));
            }
        }
        assert_eq!(wrong, [""; 0]);
    }

    /// With any integer in any structure field, the model is refused or valid, and no integer is used as an index before the
    /// validation.
    #[test]
    fn integers_of_stored_data_are_validated_first() {
        let m = compile(EVERYTHING).unwrap();
        let fields =
            reflect::fields().filter(|f| f.info().object == Object::Model && f.info().elem == Elem::I32);
        let mut refused = 0;
        for field in fields {
            for i in 0..reflect::view_model(&m, field).len() {
                for value in [i32::MIN, -2, -1, 0, 1, 1000, i32::MAX] {
                    let mut changed = m.clone();
                    reflect::view_model_mut(&mut changed, field).set(i, f64::from(value));
                    refused += usize::from(validate(&changed).is_some());
                }
            }
        }
        assert!(refused > 1000, "{refused}");
        // Empty lists may have the address -1.
        for (adr, num) in [
            ("mesh_faceadr", "mesh_facenum"),
            ("M_rowadr", "M_rownnz"),
            ("D_rowadr", "D_rownnz"),
            ("ten_J_rowadr", "ten_J_rownnz"),
        ] {
            let mut changed = m.clone();
            for (name, value) in [(adr, -1.0), (num, 0.0)] {
                let field = reflect::field(Object::Model, name).unwrap();
                reflect::view_model_mut(&mut changed, field).set(0, value);
            }
            let _ = validate(&changed);
        }
    }
}
