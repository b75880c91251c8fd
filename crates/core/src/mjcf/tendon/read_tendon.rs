//! Reads tendons: attributes and paths.

use crate::kinds::{geom, trntype, wraptype};
use crate::mjcf::body::limits;
use crate::mjcf::classes::Props;
use crate::mjcf::context::Context;
use crate::mjcf::gather::listed;
use crate::mjcf::ids::References;
use crate::mjcf::rules;
use crate::mjcf::settings::checked;
use crate::mjcf::spec::{ActuatorSpec, NumberList, SOLIMP, SOLREF, TendonSpec, WrapSpec};
use crate::mjcf::text::diagnostic::Diagnostics;
use crate::mjcf::text::tree::{ElementNode, name};

/// All tendons in the order of the text.
pub(crate) fn tendons(cx: &mut Context, refs: References) -> Vec<TendonSpec> {
    let tree = cx.tree;
    let nodes = tree.sections("tendon").flat_map(|(section, _)| tree.children(section));
    listed(nodes.map(|(i, node)| tendon(cx, refs, i, node)))
}

fn tendon(cx: &mut Context, refs: References, i: usize, node: &ElementNode) -> TendonSpec {
    cx.enter(node);
    let p = cx.classes.props_of("tendon", node, None);
    let spatial = node.element.name == "spatial";
    let (limited, range) = limits::read(cx, &p, node, &limits::TENDON);
    let (actfrclimited, actfrcrange) = limits::read(cx, &p, node, &limits::TENDON_FORCE);
    if actfrclimited && !(actfrcrange[0] <= 0.0 && 0.0 <= actfrcrange[1]) {
        let span = p.span("actuatorfrcrange").unwrap_or(node.span.clone());
        cx.report
            .error(rules::TENDON, span, format!("the actuatorfrcrange of {} excludes zero", node.describe()))
            .why(
                "the actuator forces are scaled until their sum is in the range, but a sum of zero cannot be scaled",
            );
    }
    let path = path(cx, refs, i, node);
    let owner = node.describe();
    let armature = checked(&p, "armature", &owner, |x| x >= 0.0, "zero or more", cx.report).unwrap_or(0.0);
    if armature > 0.0 && wraps_geoms(&path) {
        cx.report
            .error(
                rules::TENDON,
                p.span("armature").unwrap_or(0..0),
                format!("{owner} has armature and wraps around a geom"),
            )
            .why(NO_SECOND_DERIVATIVE)
            .help("remove `armature`, or route the tendon through sites only");
    }
    let width = if spatial {
        checked(&p, "width", &owner, |x| x > 0.0, "larger than zero", cx.report)
    } else {
        p.real("width")
    };
    TendonSpec {
        span: node.span.clone(),
        name: name(node),
        path,
        group: p.int("group").unwrap_or(0),
        limited,
        range,
        actfrclimited,
        actfrcrange,
        margin: p.real("margin").unwrap_or(0.0),
        stiffness: p.reals("stiffness", [0.0; 3]),
        damping: p.reals("damping", [0.0; 3]),
        armature,
        frictionloss: p.real("frictionloss").unwrap_or(0.0),
        springlength: springlength(cx, &p, node),
        solref_limit: p.reals("solreflimit", SOLREF),
        solimp_limit: p.reals("solimplimit", SOLIMP),
        solref_friction: p.reals("solreffriction", SOLREF),
        solimp_friction: p.reals("solimpfriction", SOLIMP),
        width: width.unwrap_or(0.003),
        rgba: p.reals("rgba", [0.5, 0.5, 0.5, 1.0]),
        user: NumberList::read(&p, "user"),
    }
}

const NO_SECOND_DERIVATIVE: &str =
    "the inertia of a tendon needs the second derivative of its length, which is unknown for wrapping";

fn wraps_geoms(path: &[WrapSpec]) -> bool {
    path.iter().any(|w| matches!(w.kind, wraptype::SPHERE | wraptype::CYLINDER))
}

/// Refuses armature of actuators that act on tendons that wrap around geoms.
pub(crate) fn check_rotors(tendons: &[TendonSpec], actuators: &[ActuatorSpec], report: &mut Diagnostics) {
    for a in actuators.iter().filter(|a| a.armature != 0.0 && a.gear[0] != 0.0) {
        let Some(t) = a.transmission.filter(|t| t.kind == trntype::TENDON) else { continue };
        let tendon = usize::try_from(t.id[0]).ok().and_then(|t| tendons.get(t));
        if let Some(tendon) = tendon.filter(|t| wraps_geoms(&t.path)) {
            let name = if tendon.name.is_empty() { String::new() } else { format!(" `{}`", tendon.name) };
            let message =
                format!("{} has armature and acts on tendon{name}, which wraps around a geom", a.described);
            report
                .error(rules::TENDON, a.span.clone(), message)
                .why(NO_SECOND_DERIVATIVE)
                .help("remove `armature`, or route the tendon through sites only");
        }
    }
}

/// The rest length of a tendon's spring, or a range without force. -1 means the length in the configuration in which joint
/// springs are relaxed.
fn springlength(cx: &mut Context, p: &Props, node: &ElementNode) -> [f64; 2] {
    let [lower, upper] = match *p.list("springlength").unwrap_or(&[-1.0]) {
        [both] => [both; 2],
        [lower, upper, ..] => [lower, upper],
        [] => [-1.0; 2],
    };
    if lower > upper {
        let span = p.span("springlength").unwrap_or(node.span.clone());
        cx.report
            .error(
                rules::TENDON,
                span,
                format!("the springlength of {} is {lower} to {upper}", node.describe()),
            )
            .why("the spring is relaxed between both lengths, so the first must be the smaller one")
            .help(format!("write `springlength=\"{upper} {lower}\"`"));
    }
    [lower, upper]
}

/// The objects of a path, in order.
fn path(cx: &mut Context, refs: References, i: usize, node: &ElementNode) -> Vec<WrapSpec> {
    let tree = cx.tree;
    let nodes: Vec<&ElementNode> = listed(tree.children(i).map(|(_, n)| n));
    if nodes.is_empty() {
        let (what, one) = match node.element.name {
            "fixed" => ("joints", "<joint joint=\"…\" coef=\"1\"/>"),
            _ => ("sites", "<site site=\"…\"/>"),
        };
        cx.report
            .error(rules::TENDON, node.span.clone(), format!("{} has no path", node.describe()))
            .why(format!("its length is measured along its {what}"))
            .help(format!("write `{one}` inside it"));
        return Vec::new();
    }
    let list: Vec<Option<WrapSpec>> = listed(nodes.iter().map(|n| wrap(refs, n, cx.report)));
    let list: Option<Vec<WrapSpec>> = list.into_iter().collect();
    // If an object could not be read, an error is reported already. The rules of the path would only repeat it.
    let list = list.unwrap_or_default();
    if node.element.name == "spatial" {
        check_path(&nodes, &list, cx.report);
    }
    list
}

/// One object of a path. `None`, with an error in the report, if it is invalid.
fn wrap(refs: References, node: &ElementNode, report: &mut Diagnostics) -> Option<WrapSpec> {
    let p = Props::written_props(node);
    let number = |name: &str, report: &mut Diagnostics| {
        if !p.has(name) {
            let message = format!("{} has no `{name}`", node.describe());
            report.error(rules::MISSING_ATTRIBUTE, node.span.clone(), message);
        }
        p.real(name)
    };
    match node.element.name {
        "joint" => {
            let id = refs.required("joint", node, "joint", report)?;
            let prm = number("coef", report)?;
            // The first coordinate is used for a free or ball joint, as in MuJoCo.
            Some(WrapSpec { kind: wraptype::JOINT, id, prm })
        }
        "site" => Some(WrapSpec {
            kind: wraptype::SITE,
            id: refs.required("site", node, "site", report)?,
            prm: 0.0,
        }),
        "geom" => {
            let id = refs.required("geom", node, "geom", report)?;
            let kind = match refs.ids.geom(id)? {
                geom::SPHERE => wraptype::SPHERE,
                geom::CYLINDER => wraptype::CYLINDER,
                _ => {
                    let span = node.attribute("geom").map_or(node.span.clone(), |a| a.span.clone());
                    report
                        .error(rules::TENDON, span, "a tendon can wrap only around spheres and cylinders")
                        .help("put a sphere or cylinder there; with `contype=\"0\" conaffinity=\"0\"` it makes no contacts");
                    return None;
                }
            };
            let side = refs.optional("site", node, "sidesite");
            Some(WrapSpec { kind, id, prm: side.map_or(-1.0, f64::from) })
        }
        _ => {
            let divisor = number("divisor", report)?;
            if divisor <= 0.0 {
                let span = p.span("divisor").unwrap_or(node.span.clone());
                report
                    .error(
                        rules::TENDON,
                        span,
                        format!("`divisor` of a pulley is {divisor}, but it must be larger than zero"),
                    )
                    .why("the length of the branch after the pulley is divided by it");
                return None;
            }
            Some(WrapSpec { kind: wraptype::PULLEY, id: -1, prm: divisor })
        }
    }
}

/// Checks a path: every branch between two pulleys runs from site to site, with at most one geom between two sites.
fn check_path(nodes: &[&ElementNode], path: &[WrapSpec], report: &mut Diagnostics) {
    let kind = |i: usize| path.get(i).map_or(wraptype::PULLEY, |w| w.kind);
    for (i, (node, wrap)) in nodes.iter().zip(path).enumerate() {
        let (before, after) = (if i == 0 { wraptype::PULLEY } else { kind(i - 1) }, kind(i + 1));
        let (message, help) = match wrap.kind {
            wraptype::PULLEY if i > 0 && before == wraptype::PULLEY => {
                ("a pulley directly follows another", "put the sites of a branch between them")
            }
            wraptype::PULLEY if i + 1 == path.len() => {
                ("the path ends with a pulley", "continue the branch after it through at least two sites")
            }
            wraptype::SITE if before == wraptype::PULLEY && after == wraptype::PULLEY => {
                ("a branch has a single site and no length", "route the branch through at least two sites")
            }
            wraptype::SITE if after == wraptype::SITE && path.get(i + 1).is_some_and(|w| w.id == wrap.id) => {
                ("the same site appears twice in a row", "remove one of them")
            }
            wraptype::SPHERE | wraptype::CYLINDER if before != wraptype::SITE || after != wraptype::SITE => {
                ("a geom is not between two sites", "put a site before and after it")
            }
            _ => continue,
        };
        report
            .error(rules::TENDON, node.span.clone(), format!("in the path of a tendon: {message}"))
            .help(help);
    }
}
