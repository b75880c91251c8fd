//! Reads bodies, depth first in the order of the text, with their inertias, sites, cameras and lights.

use super::frame::Pose;
use super::inertia::principal;
use super::read_joint;
use crate::kinds::joint;
use crate::math::{IDENTITY, normalize};
use crate::mjcf::classes::Props;
use crate::mjcf::context::Context;
use crate::mjcf::geom::read_geom;
use crate::mjcf::names::WORLD;
use crate::mjcf::rules;
use crate::mjcf::scene::read_scene;
use crate::mjcf::settings::checked;
use crate::mjcf::spec::{BodySpec, Inertia, NumberList};
use crate::mjcf::text::tree::{ElementNode, name};

/// The position of an element in the tree: its body, and the accumulated pose of the frames around it.
#[derive(Clone, Copy)]
struct ElementSite {
    body: usize,
    frame: Pose,
    childclass: Option<usize>,
}

/// All bodies, the world first. The parent of a body precedes it.
pub(crate) fn bodies(cx: &mut Context) -> Vec<BodySpec> {
    let mut list = vec![empty(0, 0..0, WORLD.into(), 0)];
    // Elements and bodies are in document order. There may be several `worldbody` elements.
    let tree = cx.tree;
    let mut inside: Vec<Option<ElementSite>> = vec![None; tree.nodes.len()];
    for (i, node) in tree.nodes.iter().enumerate() {
        let place = node.parent.and_then(|p| inside.get(p).copied().flatten());
        cx.enter(node);
        let holds = match (node.element.name, place) {
            ("worldbody", None) => ElementSite { body: 0, frame: Pose::NONE, childclass: None },
            ("body", Some(place)) => {
                list.push(body(cx, i, node, place));
                let childclass = class_inside(cx, node, place);
                ElementSite { body: list.len() - 1, frame: Pose::NONE, childclass }
            }
            ("frame", Some(place)) => {
                let p = Props::written_props(node);
                let (pos, quat) = (p.reals("pos", [0.0; 3]), cx.orientation(&p, node));
                ElementSite {
                    frame: place.frame.in_parent(pos, quat),
                    childclass: class_inside(cx, node, place),
                    ..place
                }
            }
            (_, Some(place)) => {
                if let Some(body) = list.get_mut(place.body) {
                    member(cx, i, node, place, body);
                }
                continue;
            }
            _ => continue,
        };
        if let Some(slot) = inside.get_mut(i) {
            *slot = Some(holds);
        }
    }
    list
}

/// The class of elements in a body or frame that have no class attribute.
fn class_inside(cx: &Context, node: &ElementNode, place: ElementSite) -> Option<usize> {
    node.text("childclass").and_then(|name| cx.classes.find(name)).or(place.childclass)
}

fn empty(node: usize, span: std::ops::Range<usize>, name: String, parent: usize) -> BodySpec {
    BodySpec {
        node,
        part: 0,
        span,
        name,
        parent,
        pos: [0.0; 3],
        quat: IDENTITY,
        written: Pose::NONE,
        mocap: false,
        simple: true,
        gravcomp: 0.0,
        sleep: 0,
        user: NumberList::default(),
        inertial: None,
        inertial_span: None,
        joints: Vec::new(),
        geoms: Vec::new(),
        sites: Vec::new(),
        cameras: Vec::new(),
        lights: Vec::new(),
    }
}

fn body(cx: &mut Context, i: usize, node: &ElementNode, place: ElementSite) -> BodySpec {
    let p = Props::written_props(node);
    let written = Pose { pos: p.reals("pos", [0.0; 3]), quat: cx.orientation(&p, node) };
    let Pose { pos, quat } = place.frame.in_parent(written.pos, written.quat);
    BodySpec {
        part: node.model,
        pos,
        quat,
        written,
        mocap: p.flag("mocap", false),
        simple: p.flag("simple", true),
        gravcomp: p.real("gravcomp").unwrap_or(0.0),
        sleep: p.keyword("sleep").unwrap_or(0),
        user: NumberList::read(&p, "user"),
        ..empty(i, node.span.clone(), name(node), place.body)
    }
}

/// Reads a member of a body.
fn member(cx: &mut Context, i: usize, node: &ElementNode, place: ElementSite, body: &mut BodySpec) {
    let (frame, class) = (place.frame, place.childclass);
    if place.body == 0 && matches!(node.element.name, "inertial" | "joint" | "freejoint") {
        // Directly in `worldbody`, the schema refuses these elements. Here they are inside a frame.
        let message = format!("`{}` is not allowed in the world", node.element.name);
        cx.report
            .error(rules::MISPLACED_ELEMENT, node.span.clone(), message)
            .help("write a `body` around it: a frame only places its contents");
        return;
    }
    match node.element.name {
        "inertial" => {
            if body.inertial_span.replace(node.span.clone()).is_some() {
                let message = "the body has a second `inertial`";
                cx.report.error(rules::REPEATED_ELEMENT, node.span.clone(), message);
            }
            body.inertial = inertial(cx, node).map(|mut inertia| {
                frame.transform_to_parent(&mut inertia.pos, &mut inertia.quat);
                inertia
            });
        }
        "joint" | "freejoint" => {
            let mut joint = read_joint::joint(cx, i, node, class);
            // A free joint has no position, and a ball joint has no axis.
            if joint.kind != joint::FREE {
                joint.pos = frame.point(joint.pos);
            }
            if matches!(joint.kind, joint::SLIDE | joint::HINGE) && frame.quat != IDENTITY {
                joint.axis = normalize(frame.direction(joint.axis)).0;
            }
            body.joints.push(joint);
        }
        "geom" => {
            if let Some(mut geom) = read_geom::geom(cx, i, node, class) {
                frame.transform_to_parent(&mut geom.pos, &mut geom.quat);
                body.geoms.push(geom);
            }
        }
        "site" => {
            let mut site = read_scene::site(cx, i, node, class);
            frame.transform_to_parent(&mut site.pos, &mut site.quat);
            body.sites.push(site);
        }
        "camera" => {
            let mut camera = read_scene::camera(cx, node, class);
            frame.transform_to_parent(&mut camera.pos, &mut camera.quat);
            body.cameras.push(camera);
        }
        "light" => {
            let mut light = read_scene::light(cx, node, class);
            light.pos = frame.point(light.pos);
            light.dir = frame.direction(light.dir);
            body.lights.push(light);
        }
        _ => {}
    }
}

/// Reads an explicit inertia.
fn inertial(cx: &mut Context, node: &ElementNode) -> Option<Inertia> {
    let p = Props::written_props(node);
    let mut complete = true;
    for (name, why) in
        [("pos", "it is the position of the centre of mass"), ("mass", "a body without mass cannot move")]
    {
        if !p.has(name) {
            complete = false;
            cx.report
                .error(rules::MISSING_ATTRIBUTE, node.span.clone(), format!("inertial has no `{name}`"))
                .why(why);
        }
    }
    let mass = checked(&p, "mass", "inertial", |x| x >= 0.0, "zero or more", cx.report).unwrap_or(0.0);
    let pos = p.reals("pos", [0.0; 3]);
    if p.has("diaginertia") && p.has("fullinertia") {
        cx.report.error(
            rules::CONFLICT,
            node.span.clone(),
            "inertial has both `diaginertia` and `fullinertia`",
        );
        return None;
    }
    if p.has("fullinertia") {
        let (moments, quat) = principal(p.reals("fullinertia", [1.0, 1.0, 1.0, 0.0, 0.0, 0.0]));
        if moments.iter().any(|&x| x <= 0.0 || !x.is_finite()) {
            cx.report
                .error(
                    rules::INERTIA,
                    p.span("fullinertia").unwrap_or(0..0),
                    "`fullinertia` of inertial is not the inertia of a body",
                )
                .why("its principal moments must all be larger than zero")
                .help("write the numbers in the order xx yy zz xy xz yz");
        }
        return complete.then_some(Inertia { pos, quat, mass, moments });
    }
    let moments = p.reals("diaginertia", [0.0; 3]);
    if moments.iter().any(|&x| x < 0.0) {
        cx.report.error(
            rules::INERTIA,
            p.span("diaginertia").unwrap_or(0..0),
            "`diaginertia` of inertial has a negative moment",
        );
    }
    let quat = cx.orientation(&p, node);
    complete.then_some(Inertia { pos, quat, mass, moments })
}
