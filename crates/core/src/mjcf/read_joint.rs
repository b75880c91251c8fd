//! Joints.

use super::defaults::Props;
use super::diagnostic::code;
use super::read_body::{Context, name};
use super::spec::{JointSpec, SOLIMP, SOLREF};
use super::tree::Node;
use crate::joint;
use crate::math::{norm, normalize};

/// An axis shorter than this has no direction.
const SHORTEST_AXIS: f64 = 1e-6;

/// A `joint` or `freejoint` element.
pub(crate) fn joint(cx: &mut Context, i: usize, node: &Node, childclass: Option<usize>) -> JointSpec {
    // A free joint written as its own element takes no defaults: they are meant for the other types.
    let free = node.element.name == "freejoint";
    let p = if free { Props::own(node) } else { cx.classes.props(node, childclass) };
    let kind = if free { joint::FREE } else { p.word("type").unwrap_or(joint::HINGE) };

    let angle = |x: f64| if kind == joint::HINGE { cx.compiler.angle(x) } else { x };
    let (reference, springref) =
        (angle(p.real("ref").unwrap_or(0.0)), angle(p.real("springref").unwrap_or(0.0)));
    let (limited, range) = limits(cx, &p, node, kind);
    JointSpec {
        node: i,
        span: node.span.clone(),
        name: name(node),
        kind,
        pos: if kind == joint::FREE { [0.0; 3] } else { p.reals("pos", [0.0; 3]) },
        axis: axis(cx, &p, node, kind),
        limited,
        range,
        margin: p.real("margin").unwrap_or(0.0),
        stiffness: linear(cx, &p, node, "stiffness"),
        damping: linear(cx, &p, node, "damping"),
        armature: p.real("armature").unwrap_or(0.0),
        reference,
        springref,
        solref: p.reals("solreflimit", SOLREF),
        solimp: p.reals("solimplimit", SOLIMP),
    }
}

fn axis(cx: &mut Context, p: &Props, node: &Node, kind: i32) -> [f64; 3] {
    let z = [0.0, 0.0, 1.0];
    if kind == joint::FREE || kind == joint::BALL {
        return z;
    }
    let given = p.reals("axis", z);
    let length = norm(given);
    if length < SHORTEST_AXIS || !length.is_finite() {
        let message = format!("`axis` of {} has no direction", node.shown());
        cx.report
            .error(code::JOINT, p.span("axis").unwrap_or(node.span.clone()), message)
            .why("the joint turns about it or slides along it")
            .help("write a vector such as \"0 1 0\"; its length does not matter");
        return z;
    }
    normalize(given).0
}

/// Whether the joint is limited, and its range with angles in radians.
fn limits(cx: &mut Context, p: &Props, node: &Node, kind: i32) -> (bool, [f64; 2]) {
    let [lower, upper] = p.reals("range", [0.0; 2]);
    if kind == joint::FREE {
        return (false, [lower, upper]);
    }
    let span = p.span("range").unwrap_or(node.span.clone());
    let given = p.has("range") && (lower, upper) != (0.0, 0.0);
    let limited = match p.word("limited") {
        Some(0) => false,
        Some(1) => true,
        _ if cx.compiler.autolimits => given,
        _ => {
            if given {
                cx.report
                    .error(
                        code::JOINT,
                        span.clone(),
                        format!("{} has a range, but nothing says that it holds", node.shown()),
                    )
                    .why("`autolimits` of compiler is false, so a range alone does not limit the joint")
                    .help("write `limited=\"true\"`, or `limited=\"false\"`, or remove `autolimits`");
            }
            false
        }
    };
    if !limited {
        return (false, [lower, upper]);
    }
    if lower >= upper {
        let message = format!("the range of {} is {lower} to {upper}", node.shown());
        let error =
            cx.report.error(code::JOINT, span, message).why("the lower limit must be smaller than the upper");
        if p.has("range") {
            error.help(format!("write `range=\"{upper} {lower}\"`, or remove `limited` and `range`"));
        } else {
            error.help("write `range=\"LOWER UPPER\"`, or remove `limited`");
        }
    } else if kind == joint::BALL && lower != 0.0 {
        cx.report
            .error(code::JOINT, span, format!("the range of {} begins at {lower}", node.shown()))
            .why("a ball joint's range limits the angle of its rotation, which is never negative")
            .help(format!("write `range=\"0 {upper}\"`"));
    }
    let angle = |x: f64| if kind == joint::SLIDE { x } else { cx.compiler.angle(x) };
    (true, [angle(lower), angle(upper)])
}

/// The linear coefficient of a force law; the quadratic and cubic ones must be zero.
fn linear(cx: &mut Context, p: &Props, node: &Node, name: &str) -> f64 {
    let [first, second, third] = p.reals(name, [0.0; 3]);
    if second != 0.0 || third != 0.0 {
        let message = format!("`{name}` of {}: a nonlinear law is not supported yet", node.shown());
        cx.report
            .error(code::NOT_SUPPORTED, p.span(name).unwrap_or(node.span.clone()), message)
            .help(format!("give one number: `{name}=\"{first}\"`"));
    }
    first
}
