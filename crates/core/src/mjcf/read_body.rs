//! Bodies, depth first in the order of the text, with their inertias, sites, cameras and lights.

use super::defaults::{Classes, Props};
use super::diagnostic::{Report, code};
use super::inertia::principal;
use super::names::WORLD;
use super::settings::{Compiler, checked};
use super::spec::{BodySpec, Inertia, List};
use super::tree::{Node, Tree};
use super::{orientation, read_geom, read_joint, read_scene};
use crate::math::{IDENTITY, Quat};

/// What reading an element needs to know.
pub(crate) struct Context<'a, 't> {
    pub(crate) tree: &'a Tree,
    pub(crate) classes: &'a Classes,
    pub(crate) compiler: &'a Compiler,
    pub(crate) report: &'a mut Report<'t>,
}

impl Context<'_, '_> {
    /// The orientation of an element.
    pub(crate) fn orientation(&mut self, p: &Props, node: &Node) -> Quat {
        orientation::read(p, self.compiler, node, self.report)
    }
}

/// All bodies, the world first. A body's parent stands before it.
pub(crate) fn bodies(cx: &mut Context) -> Vec<BodySpec> {
    let mut list = vec![empty(0, 0..0, WORLD.into(), 0)];
    // Elements are in document order, so are the bodies; `worldbody` may stand several times.
    let tree = cx.tree;
    let mut body_of: Vec<Option<usize>> = vec![None; tree.nodes.len()];
    for (i, node) in tree.nodes.iter().enumerate() {
        let parent = node.parent.and_then(|p| body_of.get(p).copied().flatten());
        let body = match (node.element.name, parent) {
            ("worldbody", None) => 0,
            ("body", Some(parent)) => {
                let childclass = list.get(parent).and_then(|b| b.childclass);
                list.push(body(cx, i, node, parent, childclass));
                list.len() - 1
            }
            (_, Some(parent)) => {
                if let Some(body) = list.get_mut(parent) {
                    member(cx, i, node, body);
                }
                continue;
            }
            _ => continue,
        };
        if let Some(slot) = body_of.get_mut(i) {
            *slot = Some(body);
        }
    }
    list
}

fn empty(node: usize, span: std::ops::Range<usize>, name: String, parent: usize) -> BodySpec {
    BodySpec {
        node,
        span,
        name,
        parent,
        childclass: None,
        pos: [0.0; 3],
        quat: IDENTITY,
        mocap: false,
        simple: true,
        gravcomp: 0.0,
        sleep: 0,
        user: List::default(),
        inertial: None,
        inertial_span: None,
        joints: Vec::new(),
        geoms: Vec::new(),
        sites: Vec::new(),
        cameras: Vec::new(),
        lights: Vec::new(),
    }
}

fn body(cx: &mut Context, i: usize, node: &Node, parent: usize, childclass: Option<usize>) -> BodySpec {
    let p = Props::own(node);
    BodySpec {
        childclass: node.text("childclass").and_then(|name| cx.classes.find(name)).or(childclass),
        pos: p.reals("pos", [0.0; 3]),
        quat: cx.orientation(&p, node),
        mocap: p.word("mocap") == Some(1),
        simple: p.word("simple") != Some(0),
        gravcomp: p.real("gravcomp").unwrap_or(0.0),
        sleep: p.word("sleep").unwrap_or(0),
        user: List::read(&p, "user"),
        ..empty(i, node.span.clone(), name(node), parent)
    }
}

/// The name of an element, empty when it has none.
pub(crate) fn name(node: &Node) -> String {
    node.text("name").unwrap_or("").to_string()
}

/// Something that stands in a body.
fn member(cx: &mut Context, i: usize, node: &Node, body: &mut BodySpec) {
    match node.element.name {
        "inertial" => {
            body.inertial = inertial(cx, node);
            body.inertial_span = Some(node.span.clone());
        }
        "joint" | "freejoint" => body.joints.push(read_joint::joint(cx, i, node, body.childclass)),
        "geom" => body.geoms.extend(read_geom::geom(cx, i, node, body.childclass)),
        "site" => body.sites.push(read_scene::site(cx, i, node, body.childclass)),
        "camera" => body.cameras.push(read_scene::camera(cx, node, body.childclass)),
        "light" => body.lights.push(read_scene::light(cx, node, body.childclass)),
        _ => {}
    }
}

/// An explicit inertia.
fn inertial(cx: &mut Context, node: &Node) -> Option<Inertia> {
    let p = Props::own(node);
    let mut complete = true;
    for (name, why) in [("pos", "it places the centre of mass"), ("mass", "a body without mass cannot move")]
    {
        if !p.has(name) {
            complete = false;
            cx.report
                .error(code::MISSING_ATTRIBUTE, node.span.clone(), format!("inertial has no `{name}`"))
                .why(why);
        }
    }
    let mass = checked(&p, "mass", "inertial", |x| x >= 0.0, "zero or more", cx.report).unwrap_or(0.0);
    let pos = p.reals("pos", [0.0; 3]);
    if p.has("diaginertia") && p.has("fullinertia") {
        cx.report.error(
            code::CONFLICT,
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
                    code::INERTIA,
                    p.span("fullinertia").unwrap_or(0..0),
                    "`fullinertia` of inertial is not the inertia of a body",
                )
                .why("its principal moments must all be larger than zero")
                .help("the order is xx yy zz xy xz yz");
        }
        return complete.then_some(Inertia { pos, quat, mass, moments });
    }
    let moments = p.reals("diaginertia", [0.0; 3]);
    if moments.iter().any(|&x| x < 0.0) {
        cx.report.error(
            code::INERTIA,
            p.span("diaginertia").unwrap_or(0..0),
            "`diaginertia` of inertial has a negative moment",
        );
    }
    let quat = cx.orientation(&p, node);
    complete.then_some(Inertia { pos, quat, mass, moments })
}
