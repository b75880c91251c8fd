//! Joints.

use super::limits;
use crate::kinds::{choice, joint};
use crate::math::{norm, normalize};
use crate::mjcf::classes::Props;
use crate::mjcf::context::Context;
use crate::mjcf::rules;
use crate::mjcf::spec::{JointSpec, NumberList, SOLIMP, SOLREF};
use crate::mjcf::text::tree::{ElementNode, name};

/// The length below which an axis has no direction.
const SHORTEST_AXIS: f64 = 1e-6;

/// A `joint` or `freejoint` element.
pub(crate) fn joint(cx: &mut Context, i: usize, node: &ElementNode, childclass: Option<usize>) -> JointSpec {
    // The element `freejoint` takes no defaults, because these are meant for the other joint types.
    let free = node.element.name == "freejoint";
    let p = if free { Props::written_props(node) } else { cx.classes.props(node, childclass) };
    let kind = if free { joint::FREE } else { p.keyword("type").unwrap_or(joint::HINGE) };

    let angle = |x: f64| if kind == joint::HINGE { cx.compiler.angle(x) } else { x };
    let (reference, springref) =
        (angle(p.real("ref").unwrap_or(0.0)), angle(p.real("springref").unwrap_or(0.0)));
    let (limited, range) = limits(cx, &p, node, kind);
    let (actfrclimited, actfrcrange) = force_limits(cx, &p, node, kind);
    JointSpec {
        node: i,
        span: node.span.clone(),
        name: name(node),
        kind,
        pos: if kind == joint::FREE { [0.0; 3] } else { p.reals("pos", [0.0; 3]) },
        axis: axis(cx, &p, node, kind),
        align: p.keyword("align").unwrap_or(choice::AUTO),
        limited,
        range,
        margin: p.real("margin").unwrap_or(0.0),
        stiffness: p.reals("stiffness", [0.0; 3]),
        damping: p.reals("damping", [0.0; 3]),
        springdamper: springdamper(cx, &p, node),
        frictionloss: p.real("frictionloss").unwrap_or(0.0),
        solref_friction: p.reals("solreffriction", SOLREF),
        solimp_friction: p.reals("solimpfriction", SOLIMP),
        actfrclimited,
        actfrcrange,
        actgravcomp: p.flag("actuatorgravcomp", false),
        group: p.int("group").unwrap_or(0),
        user: NumberList::read(&p, "user"),
        armature: p.real("armature").unwrap_or(0.0),
        reference,
        springref,
        solref: p.reals("solreflimit", SOLREF),
        solimp: p.reals("solimplimit", SOLIMP),
    }
}

fn axis(cx: &mut Context, p: &Props, node: &ElementNode, kind: i32) -> [f64; 3] {
    let z = [0.0, 0.0, 1.0];
    if kind == joint::FREE || kind == joint::BALL {
        return z;
    }
    let given = p.reals("axis", z);
    let length = norm(given);
    if length < SHORTEST_AXIS || !length.is_finite() {
        let message = format!("`axis` of {} has no direction", node.describe());
        cx.report
            .error(rules::JOINT, p.span("axis").unwrap_or(node.span.clone()), message)
            .why("the joint turns about it or slides along it")
            .help("write a vector such as \"0 1 0\"; its length does not matter");
        return z;
    }
    normalize(given).0
}

/// Whether the joint is limited, and its range, with angles in radians.
fn limits(cx: &mut Context, p: &Props, node: &ElementNode, kind: i32) -> (bool, [f64; 2]) {
    if kind == joint::FREE {
        return (false, p.reals("range", [0.0; 2]));
    }
    let (limited, [lower, upper]) = limits::read(cx, p, node, &limits::JOINT);
    if !limited {
        return (false, [lower, upper]);
    }
    if kind == joint::BALL && lower < upper && lower != 0.0 {
        let span = p.span("range").unwrap_or(node.span.clone());
        cx.report
            .error(rules::JOINT, span, format!("the range of {} begins at {lower}", node.describe()))
            .why("the range of a ball joint limits its rotation angle, which is never negative")
            .help(format!("write `range=\"0 {upper}\"`"));
    }
    let angle = |x: f64| if kind == joint::SLIDE { x } else { cx.compiler.angle(x) };
    (true, [angle(lower), angle(upper)])
}

/// Whether the force of actuators is limited, and its range. Only for slides and hinges.
fn force_limits(cx: &mut Context, p: &Props, node: &ElementNode, kind: i32) -> (bool, [f64; 2]) {
    if matches!(kind, joint::FREE | joint::BALL) {
        return (false, p.reals("actuatorfrcrange", [0.0; 2]));
    }
    limits::read(cx, p, node, &limits::JOINT_FORCE)
}

/// The time constant and the damping ratio from which stiffness and damping are computed, or `None` if they are not given.
fn springdamper(cx: &mut Context, p: &Props, node: &ElementNode) -> Option<[f64; 2]> {
    let given = p.reals("springdamper", [0.0; 2]);
    if given == [0.0; 2] {
        return None;
    }
    if given.iter().any(|&x| x <= 0.0) {
        let span = p.span("springdamper").unwrap_or(node.span.clone());
        let message = format!("`springdamper` of {} is {} {}", node.describe(), given[0], given[1]);
        cx.report
            .error(rules::JOINT, span, message)
            .why("it gives a time constant (s) and a damping ratio, both larger than zero")
            .help("write for example `springdamper=\"0.5 1\"`, or give `stiffness` and `damping`");
    }
    Some(given)
}
