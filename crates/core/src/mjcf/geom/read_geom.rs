//! Geoms: shape, inertia and the parameters of their contacts.

use super::read_form::{self, GeomForm};
use super::shapes::{self, GeomTypeProperties};
use crate::kinds::geom;
use crate::math::{MINVAL, Quat, Vec3, normalize, quat_normalize, scale, sub};
use crate::mjcf::body::frame::Pose;
use crate::mjcf::body::orientation;
use crate::mjcf::classes::Props;
use crate::mjcf::context::Context;
use crate::mjcf::rules;
use crate::mjcf::settings::checked;
use crate::mjcf::spec::{GeomSpec, NumberList, SOLIMP, SOLREF};
use crate::mjcf::text::tree::{ElementNode, name};

/// Reads a `geom` element. `None` if its type was refused.
pub(crate) fn geom(
    cx: &mut Context,
    i: usize,
    node: &ElementNode,
    childclass: Option<usize>,
) -> Option<GeomSpec> {
    let p = cx.classes.props(node, childclass);
    if p.has("type") && p.keyword("type").is_none() {
        return None;
    }
    let shape = shapes::for_kind(p.keyword("type").unwrap_or(geom::SPHERE))?;
    let mut size = p.reals("size", [0.0; 3]);
    let (mut pos, mut quat) = (p.reals("pos", [0.0; 3]), cx.orientation(&p, node));
    if let Some(span) = fromto(cx, &p, node, shape.name, shape.length) {
        (pos, quat) = (span.pos, span.quat);
        if let Some((length, half)) = shape.length.and_then(|i| Some((size.get_mut(i)?, span.half))) {
            *length = half;
        }
        // A missing second radius equals the first.
        if shape.length == Some(2) {
            size[1] = size[0];
        }
    }
    let (form, Pose { pos, quat }) = form_at(cx, &p, node, shape, size, Pose { pos, quat })?;
    let (mass, moments) = mass(cx, &p, node, shape, &form);
    let material = p.text("material").or_else(|| cx.assets.material(p.text("mesh")?));
    Some(GeomSpec {
        node: i,
        span: node.span.clone(),
        name: name(node),
        kind: shape.kind,
        size: form.size,
        pos,
        quat,
        mass,
        moments,
        rbound: form.rbound,
        aabb: form.aabb,
        data: form.data,
        fluid: fluid(&p, shape, form.size),
        material: material.map(str::to_string),
        surfacevel: p.reals("surfacevel", [0.0; 6]),
        adhesion: p.real("adhesion").unwrap_or(0.0),
        user: NumberList::read(&p, "user"),
        only_static: shape.only_static,
        contype: p.int("contype").unwrap_or(1),
        conaffinity: p.int("conaffinity").unwrap_or(1),
        condim: condim(cx, &p, node),
        priority: p.int("priority").unwrap_or(0),
        group: p.int("group").unwrap_or(0),
        friction: p.reals("friction", [1.0, 0.005, 0.0001]),
        solmix: p.real("solmix").unwrap_or(1.0),
        solref: p.reals("solref", SOLREF),
        solimp: p.reals("solimp", SOLIMP),
        margin: p.real("margin").unwrap_or(0.0),
        gap: p.real("gap").unwrap_or(0.0),
        rgba: p.reals("rgba", [0.5, 0.5, 0.5, 1.0]),
    })
}

/// The form of a geom, and its pose, because a mesh has its own frame. `None` if it was refused.
fn form_at(
    cx: &mut Context,
    p: &Props,
    node: &ElementNode,
    shape: &GeomTypeProperties,
    size: Vec3,
    pose: Pose,
) -> Option<(GeomForm, Pose)> {
    if !form_is_of_asset(p, shape) {
        check_size(cx, p, node, shape, size);
        return Some((GeomForm::primitive(shape, size, p.flag("shellinertia", false)), pose));
    }
    if !read_form::check_form(cx, p, node, shape.kind) {
        return None;
    }
    let form = read_form::of_asset(cx, p, node, shape)?;
    check_fit(cx, p, node, shape, form.size);
    let pose = pose.in_parent(form.mesh_pose.pos, form.mesh_pose.quat);
    Some((form, pose))
}

/// A segment between two points: its centre, an orientation with its z axis along the segment, and half its length.
pub(crate) struct Span {
    pub(crate) pos: Vec3,
    pub(crate) quat: Quat,
    pub(crate) half: f64,
}

/// Reads `fromto`, for a shape that has a length.
pub(crate) fn fromto(
    cx: &mut Context,
    p: &Props,
    node: &ElementNode,
    shape: &str,
    length: Option<usize>,
) -> Option<Span> {
    let &[ax, ay, az, bx, by, bz] = p.list("fromto")? else { return None };
    let (from, to) = ([ax, ay, az], [bx, by, bz]);
    let (axis, distance) = normalize(sub(from, to));
    let owner = node.describe();
    let problem = if length.is_none() {
        format!("{owner} has `fromto`, but a {shape} has no length")
    } else if p.reals("pos", [0.0; 3]) != [0.0; 3] {
        format!("{owner} has both `pos` and `fromto`")
    } else if distance < MINVAL || !distance.is_finite() {
        format!("the two points of `fromto` of {owner} are the same")
    } else {
        let pos = std::array::from_fn(|i| 0.5 * (from[i] + to[i]));
        return Some(Span { pos, quat: quat_normalize(orientation::z_to(axis)), half: 0.5 * distance });
    };
    let span = p.span("fromto").unwrap_or(node.span.clone());
    cx.report
        .error(rules::GEOM, span, problem)
        .why("`fromto` gives the ends of a capsule, cylinder, ellipsoid or box, and so its position");
    None
}

/// Coefficients of fluid forces, for a geom with the ellipsoid model.
fn fluid(p: &Props, shape: &GeomTypeProperties, size: Vec3) -> [f64; 12] {
    if p.keyword("fluidshape") != Some(geom::ELLIPSOID) || shape.only_static {
        return [0.0; 12];
    }
    shapes::fluid((shape.half)(size), p.reals("fluidcoef", [0.5, 0.25, 1.5, 1.0, 1.0]))
}

/// Checks the sizes that the shape requires.
fn check_size(cx: &mut Context, p: &Props, node: &ElementNode, shape: &GeomTypeProperties, size: Vec3) {
    if p.has("size") && p.list("size").is_none() {
        return; // already reported
    }
    let spans = p.has("fromto");
    let given = if spans && p.has("size") { 3 } else { p.list("size").map_or(0, <[f64]>::len) };
    let span = p.span("size").unwrap_or(node.span.clone());
    let help = format!("write `size=\"{1}\"` for a {0}", shape.name, shape.example);
    for (k, (rule, &x)) in shape.sizes.iter().zip(&size).enumerate() {
        let what = if k >= given {
            format!("`size` of {} lacks the {}", node.describe(), rule.name)
        } else if x < 0.0 || x == 0.0 && !rule.zero {
            let bound = if rule.zero { "zero or more" } else { "larger than zero" };
            format!("`size` of {}: the {} is {x}, but it must be {bound}", node.describe(), rule.name)
        } else {
            continue;
        };
        cx.report.error(rules::GEOM, span, what).help(help);
        break;
    }
}

/// Whether a mesh or height field determines the form of a geom.
fn form_is_of_asset(p: &Props, shape: &GeomTypeProperties) -> bool {
    matches!(shape.kind, geom::MESH | geom::HFIELD) || p.text("mesh").or(p.text("hfield")).is_some()
}

/// Checks that the sizes of a shape that replaces a mesh are positive.
fn check_fit(cx: &mut Context, p: &Props, node: &ElementNode, shape: &GeomTypeProperties, size: Vec3) {
    if let Some((rule, _)) = shape.sizes.iter().zip(size).find(|&(_, x)| x <= 0.0) {
        let message =
            format!("{} replaces its mesh with a {} of zero or negative size", node.describe(), rule.name);
        cx.report
            .error(rules::GEOM, p.span("mesh").unwrap_or(node.span.clone()), message)
            .why(format!("the mesh is too flat or too long for a {}", shape.name))
            .help("choose another `type`: a box fits anything that has a volume");
    }
}

/// Mass and principal moments: from `mass`, else from `density`.
fn mass(
    cx: &mut Context,
    p: &Props,
    node: &ElementNode,
    shape: &GeomTypeProperties,
    form: &GeomForm,
) -> (f64, Vec3) {
    let owner = node.describe();
    let density = checked(p, "density", &owner, |x| x >= 0.0, "zero or more", cx.report).unwrap_or(1000.0);
    let given = checked(p, "mass", &owner, |x| x >= 0.0, "zero or more", cx.report);
    if shape.only_static {
        return (0.0, [0.0; 3]);
    }
    let mass = given.unwrap_or(density * form.amount);
    let moments = if mass > 0.0 { scale(form.moments, mass) } else { [0.0; 3] };
    if !mass.is_finite() || moments.iter().any(|x| !x.is_finite()) {
        let message = format!("the mass or inertia of {owner} exceeds a 64-bit number");
        cx.report.error(rules::GEOM, p.span("size").unwrap_or(node.span.clone()), message);
    }
    (mass, moments)
}

/// The dimension of the contacts of the geom.
fn condim(cx: &mut Context, p: &Props, node: &ElementNode) -> i32 {
    let condim = p.int("condim").unwrap_or(3);
    let span = p.span("condim").unwrap_or(node.span.clone());
    if !matches!(condim, 1 | 3 | 4 | 6) {
        let message = format!("`condim` of {} is {condim}", node.describe());
        cx.report
            .error(rules::VALUE, span, message)
            .help("write 1 (no friction), 3 (sliding), 4 (and spinning) or 6 (and rolling friction)");
    }
    condim
}
