//! Sites, cameras, lights, materials, and custom data.

use crate::kinds::{camlight, geom, lighttype, projection};
use crate::math::normalize;
use crate::mjcf::classes::Props;
use crate::mjcf::context::Context;
use crate::mjcf::gather::listed;
use crate::mjcf::geom::read_geom::fromto;
use crate::mjcf::geom::{read_form, shapes};
use crate::mjcf::ids::{Ids, References};
use crate::mjcf::names::NameTable;
use crate::mjcf::rules;
use crate::mjcf::spec::{CameraSpec, LightSpec, MaterialSpec, NumberList, NumericSpec, SiteSpec, TupleSpec};
use crate::mjcf::text::tree::{ElementNode, ElementTree, name};
use crate::model::Obj;

/// The largest number of elements of a custom list, as in MuJoCo.
const MAX_NUMBERS: i32 = 500;

/// A site: a marked frame, with a volume for sensors that test whether a point is inside.
pub(crate) fn site(cx: &mut Context, i: usize, node: &ElementNode, childclass: Option<usize>) -> SiteSpec {
    let p = cx.classes.props(node, childclass);
    let kind = p.keyword("type").unwrap_or(geom::SPHERE);
    let mut size = p.reals("size", [0.005; 3]);
    let (mut pos, mut quat) = (p.reals("pos", [0.0; 3]), cx.orientation(&p, node));
    let shape = shapes::for_kind(kind);
    let length = shape.and_then(|s| s.length);
    if let Some(span) = fromto(cx, &p, node, shape.map_or("site", |s| s.name), length) {
        (pos, quat) = (span.pos, span.quat);
        if length == Some(2) {
            size[1] = size[0];
        }
        if let Some(x) = length.and_then(|index| size.get_mut(index)) {
            *x = span.half;
        }
    }
    let mut data = -1;
    if (kind == geom::MESH || p.text("mesh").is_some()) && check_mesh(cx, &p, node, kind) {
        // The mesh is positioned relative to the site as it is positioned relative to its own centre of mass.
        let mesh = p.text("mesh").and_then(|name| cx.assets.mesh(name));
        (data, size) = mesh.map_or((-1, size), |(id, mesh)| (id, mesh.reach()));
    }
    let needed = shape.map_or(0, |s| s.sizes.len());
    if let Some(x) = size.iter().take(needed).find(|&&x| x <= 0.0) {
        let message = format!("`size` of {} has {x}, but it must be larger than zero", node.describe());
        cx.report.error(rules::VALUE, p.span("size").unwrap_or(node.span.clone()), message);
    }
    SiteSpec {
        node: i,
        name: name(node),
        kind,
        data,
        size,
        pos,
        quat,
        material: p.text("material").map(str::to_string),
        group: p.int("group").unwrap_or(0),
        rgba: p.reals("rgba", [0.5, 0.5, 0.5, 1.0]),
        user: NumberList::read(&p, "user"),
    }
}

/// Checks that a site that names a mesh has the type mesh.
fn check_mesh(cx: &mut Context, p: &Props, node: &ElementNode, kind: i32) -> bool {
    if kind == geom::MESH {
        return read_form::check_form(cx, p, node, kind);
    }
    let message = format!("{} names a mesh but has another type", node.describe());
    cx.report
        .error(rules::GEOM, p.span("mesh").unwrap_or(node.span.clone()), message)
        .help("write `type=\"mesh\"`, or delete `mesh`");
    false
}

/// A camera. Its lens is given by the field of view, or by the size of the sensor and a focal length, in metres or in
/// pixels.
pub(crate) fn camera(cx: &mut Context, node: &ElementNode, childclass: Option<usize>) -> CameraSpec {
    let p = cx.classes.props(node, childclass);
    let resolution = match p.ints("resolution") {
        Some(&[w, h]) => [w, h],
        _ => [1, 1],
    };
    let sensorsize = p.reals("sensorsize", [0.0; 2]);
    let metres = |length: &str, pixels: &str, default: [f64; 2]| -> [f64; 2] {
        let values = p.reals(length, default);
        match p.list(pixels) {
            Some(&[x, y]) => {
                std::array::from_fn(|i| [x, y][i] * sensorsize[i] / f64::from(resolution[i].max(1)))
            }
            _ => values,
        }
    };
    check_lens(cx, &p, node, sensorsize, resolution);
    let [fx, fy] = metres("focal", "focalpixel", [0.01; 2]);
    let [px, py] = metres("principal", "principalpixel", [0.0; 2]);
    let fovy = match sensorsize[1] > 0.0 {
        // In single precision, because MuJoCo stores the lengths in single precision.
        true => {
            let half = libm::atan2f(sensorsize[1] as f32 / 2.0, fy as f32);
            2.0 * f64::from(half) * 180.0 / std::f64::consts::PI
        }
        false => p.real("fovy").unwrap_or(45.0),
    };
    if sensorsize[1] <= 0.0 && fovy >= 180.0 {
        let message = format!("`fovy` of {} is {fovy}, but it must be less than 180", node.describe());
        cx.report
            .error(rules::VALUE, p.span("fovy").unwrap_or(node.span.clone()), message)
            .why("it is an angle in degrees, from the lower to the upper edge of the picture");
    }
    CameraSpec {
        name: name(node),
        mode: p.keyword("mode").unwrap_or(camlight::FIXED),
        target: node.text("target").map(str::to_string),
        pos: p.reals("pos", [0.0; 3]),
        quat: cx.orientation(&p, node),
        projection: p.keyword("projection").unwrap_or(projection::PERSPECTIVE),
        fovy,
        ipd: p.real("ipd").unwrap_or(0.068),
        resolution,
        output: output(cx, &p, node),
        sensorsize,
        intrinsic: [fx, fy, px, py],
        user: NumberList::read(&p, "user"),
    }
}

/// Reports a sensor without pixels, and a lens without a sensor.
fn check_lens(cx: &mut Context, p: &Props, node: &ElementNode, sensorsize: [f64; 2], resolution: [i32; 2]) {
    if sensorsize[1] > 0.0 && resolution.iter().any(|&n| n <= 0) {
        let [w, h] = resolution;
        let message = format!("{} has a `sensorsize`, but its image has {w} by {h} pixels", node.describe());
        cx.report
            .error(rules::VALUE, p.span("resolution").unwrap_or(node.span.clone()), message)
            .why("the size of one pixel is the size of the sensor divided by the number of pixels")
            .help("write the width and height of the image in pixels, such as `resolution=\"640 480\"`, or remove `sensorsize`");
    }
    // MuJoCo requires a sensor only if a focal length or a principal point differs from its default.
    let lens = ["focal", "focalpixel", "principal", "principalpixel"];
    let given = lens.iter().find(|name| p.list(name).is_some_and(|list| list.iter().any(|&x| x != 0.0)));
    if let Some(name) = given
        && sensorsize.iter().any(|&x| x <= 0.0)
    {
        let message = format!("{} has a `{name}`, but no `sensorsize` larger than zero", node.describe());
        cx.report
            .error(rules::VALUE, p.span(name).unwrap_or(node.span.clone()), message)
            .why("the field of view depends on both, and MuJoCo refuses one without the other")
            .help("write the width and height of the sensor in metres, or write `fovy` instead");
    }
}

/// The images that a camera renders, as bits.
fn output(cx: &mut Context, p: &Props, node: &ElementNode) -> i32 {
    const IMAGES: [&str; 5] = ["rgb", "depth", "distance", "normal", "segmentation"];
    let Some(text) = p.text("output") else { return 1 };
    let mut bits = 0;
    for word in text.split_whitespace() {
        match IMAGES.iter().position(|image| *image == word) {
            Some(i) => bits |= 1 << i,
            None => {
                let span = p.span("output").unwrap_or(node.span.clone());
                cx.report
                    .error(rules::VALUE, span, format!("`{word}` is not an image type of a camera"))
                    .help(format!("write some of {}", IMAGES.join(", ")));
            }
        }
    }
    bits
}

/// A light.
pub(crate) fn light(cx: &mut Context, node: &ElementNode, childclass: Option<usize>) -> LightSpec {
    let p = cx.classes.props(node, childclass);
    let number = |name: &str, default: f64| p.real(name).unwrap_or(default);
    let directional = if p.flag("directional", false) { lighttype::DIRECTIONAL } else { lighttype::SPOT };
    let kind = p.keyword("type").unwrap_or(directional);
    if p.list("dir").is_some_and(|dir| dir.iter().all(|&x| x == 0.0)) {
        let span = p.span("dir").unwrap_or(node.span.clone());
        cx.report
            .error(rules::VALUE, span, format!("`dir` of {} has no length", node.describe()))
            .why("it is the direction in which the light shines")
            .help("write for example `dir=\"0 0 -1\"` for a light from above");
    }
    LightSpec {
        name: name(node),
        mode: p.keyword("mode").unwrap_or(camlight::FIXED),
        target: node.text("target").map(str::to_string),
        texture: node.text("texture").map(str::to_string),
        span: p.span("texture").unwrap_or(node.span.clone()),
        kind,
        castshadow: p.flag("castshadow", true),
        active: p.flag("active", true),
        pos: p.reals("pos", [0.0; 3]),
        dir: normalize(p.reals("dir", [0.0, 0.0, -1.0])).0,
        numbers: [
            number("bulbradius", 0.02),
            number("intensity", 0.0),
            number("range", 10.0),
            number("cutoff", 45.0),
            number("softness", 0.2),
            number("exponent", 10.0),
        ],
        triples: [
            p.reals("attenuation", [1.0, 0.0, 0.0]),
            p.reals("ambient", [0.0; 3]),
            p.reals("diffuse", [0.7; 3]),
            p.reals("specular", [0.3; 3]),
        ],
    }
}

/// The number of texture roles of a material, and the role of its colour.
const ROLES: usize = 10;
const RGB: usize = 1;

/// All materials in the order of the text.
pub(crate) fn materials(cx: &Context) -> Vec<MaterialSpec> {
    let tree = cx.tree;
    let nodes = tree.sections("asset").flat_map(|(index, _)| tree.children(index));
    let read = |index: usize, node: &ElementNode| {
        let p = cx.classes.props(node, None);
        let number = |name: &str, default: f64| p.real(name).unwrap_or(default);
        let mut textures: [Option<String>; ROLES] = Default::default();
        textures[RGB] = p.text("texture").map(str::to_string);
        for (_, layer) in tree.children(index) {
            let role = layer.keyword("role").and_then(|role| textures.get_mut(usize::try_from(role).ok()?));
            if let Some(place) = role {
                *place = layer.text("texture").map(str::to_string);
            }
        }
        MaterialSpec {
            name: name(node),
            textures,
            texuniform: p.flag("texuniform", false),
            texrepeat: p.reals("texrepeat", [1.0; 2]),
            numbers: [
                number("emission", 0.0),
                number("specular", 0.5),
                number("shininess", 0.5),
                number("reflectance", 0.0),
                number("metallic", -1.0),
                number("roughness", -1.0),
            ],
            rgba: p.reals("rgba", [1.0; 4]),
        }
    };
    listed(nodes.filter(|(_, node)| node.element.name == "material").map(|(index, node)| read(index, node)))
}

/// All custom lists of numbers. Missing numbers are zero.
pub(crate) fn numerics(cx: &mut Context) -> Vec<NumericSpec> {
    let tree = cx.tree;
    let mut all = Vec::new();
    for (_, node) in tree.sections("custom").flat_map(|(index, _)| tree.children(index)) {
        if node.element.name != "numeric" {
            continue;
        }
        let p = Props::written_props(node);
        let mut data = p.list("data").unwrap_or(&[]).to_vec();
        let size = p.int("size").unwrap_or(data.len() as i32);
        let problem = match usize::try_from(size) {
            Ok(n) if size > 0 && size <= MAX_NUMBERS && n >= data.len() => {
                data.resize(n, 0.0);
                None
            }
            Ok(n) if n < data.len() => Some(format!("it has {} numbers", data.len())),
            _ => Some(format!("it must be from 1 to {MAX_NUMBERS}")),
        };
        if let Some(problem) = problem {
            let span = p.span("size").unwrap_or(node.span.clone());
            cx.report.error(
                rules::COUNT,
                span,
                format!("the size of {} is {size}, but {problem}", node.describe()),
            );
        }
        all.push(NumericSpec { name: name(node), data });
    }
    all
}

/// All custom texts: name and text.
pub(crate) fn texts(
    tree: &ElementTree,
    report: &mut crate::mjcf::text::diagnostic::Diagnostics,
) -> Vec<(String, String)> {
    let nodes = tree.sections("custom").flat_map(|(index, _)| tree.children(index));
    listed(
        nodes
            .filter(|(_, node)| node.element.name == "text")
            .inspect(|(_, node)| {
                if let Some(data) = node.attribute("data").filter(|_| node.text("data").is_none()) {
                    let message = format!("`data` of {} is empty", node.describe());
                    report
                        .error(rules::VALUE, data.span.clone(), message)
                        .help("write a text, or remove the element");
                }
            })
            .map(|(_, node)| (name(node), node.text("data").unwrap_or("").to_string())),
    )
}

/// All custom tuples.
pub(crate) fn tuples(cx: &mut Context, refs: References) -> Vec<TupleSpec> {
    let tree = cx.tree;
    let mut all = Vec::new();
    for (index, node) in tree.sections("custom").flat_map(|(index, _)| tree.children(index)) {
        if node.element.name != "tuple" {
            continue;
        }
        let mut elements = Vec::new();
        for (_, element) in tree.children(index) {
            let p = Props::written_props(element);
            if let Some((kind, id)) = element_of(cx, refs.ids, refs.names, &p, element) {
                elements.push((kind, id, p.real("prm").unwrap_or(0.0)));
            }
        }
        all.push(TupleSpec { name: name(node), elements });
    }
    all
}

/// The kind and the id of the object that an element of a tuple names.
fn element_of(
    cx: &mut Context,
    ids: &Ids,
    names: &NameTable,
    p: &Props,
    node: &ElementNode,
) -> Option<(i32, i32)> {
    const KINDS: [(&str, Obj); 10] = [
        ("body", Obj::Body),
        ("xbody", Obj::XBody),
        ("joint", Obj::Joint),
        ("geom", Obj::Geom),
        ("site", Obj::Site),
        ("camera", Obj::Camera),
        ("light", Obj::Light),
        ("tendon", Obj::Tendon),
        ("actuator", Obj::Actuator),
        ("sensor", Obj::Sensor),
    ];
    let (kind, object) = (p.text("objtype").unwrap_or(""), p.text("objname").unwrap_or(""));
    let Some(&(word, object_kind)) = KINDS.iter().find(|(word, _)| *word == kind) else {
        let span = p.span("objtype").unwrap_or(node.span.clone());
        let message = format!("a tuple cannot contain objects of the kind `{kind}`");
        cx.report
            .error(rules::VALUE, span, message)
            .help("write body, joint, geom, site, tendon or actuator");
        return None;
    };
    let word = if word == "xbody" { "body" } else { word };
    match ids.find(word, object, names) {
        Some(id) => Some((object_kind as i32, id)),
        None => {
            names.unknown(word, object, p.span("objname").unwrap_or(node.span.clone()), cx.report);
            None
        }
    }
}
