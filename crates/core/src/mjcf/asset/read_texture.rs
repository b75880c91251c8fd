//! `texture`: the declarations of textures, for views. Their files are not read here.

use crate::mjcf::classes::Props;
use crate::mjcf::context::Context;
use crate::mjcf::gather::listed;
use crate::mjcf::text::tree::{ElementNode, name};
use crate::model::texture::Texture;
use crate::source::files;

/// The files of the faces of a cube, in the order of the faces.
const FACES: [&str; 6] = ["fileright", "fileleft", "fileup", "filedown", "filefront", "fileback"];
/// The largest length of a layout: the cells of a grid of faces.
const MOST_CELLS: usize = 12;

/// All textures with their names, in the order of the text.
pub(crate) fn textures(cx: &Context) -> Vec<(String, Texture)> {
    let nodes = cx.tree.sections("asset").flat_map(|(section, _)| cx.tree.children(section));
    let textures = nodes.filter(|(_, node)| node.element.name == "texture");
    listed(textures.map(|(_, node)| (name(node), read(cx, node))))
}

fn read(cx: &Context, node: &ElementNode) -> Texture {
    let p = Props::written_props(node);
    let default = Texture::default();
    let path = |attribute: &str| p.text(attribute).and_then(|written| resolve(cx, node, written));
    let faces = FACES.map(|face| path(face).unwrap_or_default());
    let files = match path("file") {
        Some(file) => vec![file],
        None if faces.iter().all(String::is_empty) => Vec::new(),
        None => faces.to_vec(),
    };
    let grid = p.ints("gridsize").unwrap_or(&[]);
    Texture {
        kind: p.keyword("type").unwrap_or(default.kind),
        builtin: p.keyword("builtin").unwrap_or(default.builtin),
        mark: p.keyword("mark").unwrap_or(default.mark),
        rgb1: p.reals("rgb1", default.rgb1),
        rgb2: p.reals("rgb2", default.rgb2),
        markrgb: p.reals("markrgb", default.markrgb),
        random: p.real("random").unwrap_or(default.random),
        size: ["width", "height"].map(|side| p.int(side).unwrap_or(0)),
        nchannel: p.int("nchannel").unwrap_or(default.nchannel),
        files,
        gridsize: [grid.first().copied().unwrap_or(1), grid.get(1).copied().unwrap_or(1)],
        gridlayout: p.text("gridlayout").unwrap_or("").chars().take(MOST_CELLS).collect(),
        flip: ["hflip", "vflip"].map(|flip| p.flag(flip, false)),
    }
}

/// The path of a file in the folder of the model. `None` if it is outside.
fn resolve(cx: &Context, node: &ElementNode, written: &str) -> Option<String> {
    let part = cx.parts.get(node.model)?;
    let compiler = &part.compiler;
    let file = match written.rsplit_once(['/', '\\']) {
        Some((_, file)) if compiler.strippath => file,
        _ => written,
    };
    let whole = match compiler.texturedir.as_str() {
        "" => file.to_string(),
        folder => format!("{folder}/{file}"),
    };
    files::normalize_path(&part.folder, &whole)
}
