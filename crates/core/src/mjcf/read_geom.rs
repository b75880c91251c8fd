//! Geoms: shape, inertia and the parameters of their contacts.

use super::defaults::Props;
use super::diagnostic::code;
use super::read_body::{Context, name};
use super::settings::checked;
use super::shapes::{self, Shape};
use super::spec::{GeomSpec, SOLIMP, SOLREF};
use super::tree::Node;
use crate::geom;
use crate::math::{Vec3, scale};

/// A `geom` element; `None` when its type was refused.
pub(crate) fn geom(cx: &mut Context, i: usize, node: &Node, childclass: Option<usize>) -> Option<GeomSpec> {
    let p = cx.classes.props(node, childclass);
    if p.has("type") && p.word("type").is_none() {
        return None;
    }
    let shape = shapes::of(p.word("type").unwrap_or(geom::SPHERE))?;
    let size = size(cx, &p, node, shape);
    let (mass, moments) = mass(cx, &p, node, shape, size);
    Some(GeomSpec {
        node: i,
        span: node.span.clone(),
        name: name(node),
        kind: shape.kind,
        size,
        pos: p.reals("pos", [0.0; 3]),
        quat: cx.orientation(&p, node),
        mass,
        moments,
        rbound: (shape.rbound)(size),
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

/// The sizes, as many as the shape needs; more are kept as they are written.
fn size(cx: &mut Context, p: &Props, node: &Node, shape: &Shape) -> Vec3 {
    let size = p.reals("size", [0.0; 3]);
    if p.has("size") && p.list("size").is_none() {
        return size; // reported before
    }
    let given = p.list("size").map_or(0, <[f64]>::len);
    let span = p.span("size").unwrap_or(node.span.clone());
    let help = format!("a {} is written as `size=\"{}\"`", shape.name, shape.example);
    for (k, (rule, &x)) in shape.sizes.iter().zip(&size).enumerate() {
        let what = if k >= given {
            format!("`size` of {} lacks the {}", node.shown(), rule.name)
        } else if x < 0.0 || x == 0.0 && !rule.zero {
            let bound = if rule.zero { "zero or more" } else { "larger than zero" };
            format!("`size` of {}: the {} is {x}, it must be {bound}", node.shown(), rule.name)
        } else {
            continue;
        };
        cx.report.error(code::GEOM, span, what).help(help);
        break;
    }
    size
}

/// Mass and principal moments: from `mass`, else from `density`.
fn mass(cx: &mut Context, p: &Props, node: &Node, shape: &Shape, size: Vec3) -> (f64, Vec3) {
    let owner = node.shown();
    let density = checked(p, "density", &owner, |x| x >= 0.0, "zero or more", cx.report).unwrap_or(1000.0);
    let given = checked(p, "mass", &owner, |x| x >= 0.0, "zero or more", cx.report);
    if shape.only_static {
        return (0.0, [0.0; 3]);
    }
    let mass = given.unwrap_or_else(|| density * (shape.volume)(size));
    let moments = scale((shape.inertia)(size), mass);
    if !mass.is_finite() || moments.iter().any(|x| !x.is_finite()) {
        let message = format!("the mass or inertia of {owner} is larger than a 64-bit number can be");
        cx.report.error(code::GEOM, p.span("size").unwrap_or(node.span.clone()), message);
    }
    (mass, moments)
}

/// The dimension of its contacts.
fn condim(cx: &mut Context, p: &Props, node: &Node) -> i32 {
    let condim = p.int("condim").unwrap_or(3);
    let span = p.span("condim").unwrap_or(node.span.clone());
    match condim {
        1 | 3 => {}
        4 | 6 => {
            let message = format!("`condim` of {} is {condim}, which is not supported yet", node.shown());
            cx.report
                .error(code::NOT_SUPPORTED, span, message)
                .help("supported: 1 (no friction) and 3 (sliding friction)");
        }
        _ => {
            let message = format!("`condim` of {} is {condim}", node.shown());
            cx.report.error(code::VALUE, span, message).help("write 1 (no friction) or 3 (sliding friction)");
        }
    }
    condim
}
