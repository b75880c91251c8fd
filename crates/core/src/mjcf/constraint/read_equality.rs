//! Equality constraints: the objects that they connect, and the data that the text contains.

use crate::kinds::{eqtype, joint};
use crate::mjcf::classes::Props;
use crate::mjcf::context::Context;
use crate::mjcf::gather::listed;
use crate::mjcf::ids::References;
use crate::mjcf::rules;
use crate::mjcf::spec::{EqualitySpec, SOLIMP, SOLREF};
use crate::mjcf::text::diagnostic::Diagnostics;
use crate::mjcf::text::tree::{ElementNode, name};
use crate::model::Obj;

/// All equality constraints in the order of the text.
pub(crate) fn equalities(cx: &mut Context, refs: References) -> Vec<EqualitySpec> {
    let tree = cx.tree;
    let nodes = tree.sections("equality").flat_map(|(section, _)| tree.children(section));
    listed(nodes.filter_map(|(_, node)| equality(cx, refs, node)))
}

/// The objects of a constraint (kind, first, second) and its data.
type EqualityData = (Obj, i32, i32, [f64; 11]);

fn equality(cx: &mut Context, refs: References, node: &ElementNode) -> Option<EqualitySpec> {
    let p = cx.classes.props_of("equality", node, None);
    let report = &mut *cx.report;
    let (kind, tied) = match node.element.name {
        "connect" => (eqtype::CONNECT, bodies_or_sites(refs, &p, node, report)),
        "weld" => (eqtype::WELD, bodies_or_sites(refs, &p, node, report)),
        "joint" => (eqtype::JOINT, coupled(refs, &p, node, Obj::Joint, report)),
        _ => (eqtype::TENDON, coupled(refs, &p, node, Obj::Tendon, report)),
    };
    let (objtype, obj1, obj2, data) = tied?;
    if obj1 == obj2 {
        report
            .error(
                rules::EQUALITY,
                node.span.clone(),
                format!("{} ties an object to itself", node.describe()),
            )
            .help("name two different objects; to tie a body to the world, leave out the second");
    }
    Some(EqualitySpec {
        name: name(node),
        kind,
        // For joints and tendons, the type of the constraint determines the type of its objects.
        objtype: if matches!(objtype, Obj::Body | Obj::Site) { objtype as i32 } else { 0 },
        obj1,
        obj2,
        active: p.flag("active", true),
        solref: p.reals("solref", SOLREF),
        solimp: p.reals("solimp", SOLIMP),
        data,
    })
}

/// `connect` and `weld`: two sites, or a body with an anchor and a second body. The default of the second body is the world.
fn bodies_or_sites(
    refs: References,
    p: &Props,
    node: &ElementNode,
    report: &mut Diagnostics,
) -> Option<EqualityData> {
    let given = |attribute: &str| node.attribute(attribute).is_some();
    let connect = node.element.name == "connect";
    let scale = p.real("torquescale").unwrap_or(1.0);
    let mut data = [0.0; 11];
    if given("site1") || given("site2") {
        if let Some(other) = ["body1", "body2", "anchor", "relpose"].into_iter().find(|a| given(a)) {
            report
                .error(
                    rules::CONFLICT,
                    node.span.clone(),
                    format!("{} has sites and `{other}`", node.describe()),
                )
                .why("two sites define the constraint completely")
                .help(format!("remove `{other}`, or tie bodies instead of sites"));
        }
        let site1 = refs.required("site", node, "site1", report);
        let site2 = refs.required("site", node, "site2", report);
        if !connect {
            // Unused between sites. MuJoCo leaves the initial value of a polynomial there.
            (data[1], data[10]) = (1.0, scale);
        }
        return Some((Obj::Site, site1?, site2?, data));
    }
    let body1 = refs.required("body", node, "body1", report);
    let body2 = if given("body2") { refs.optional("body", node, "body2") } else { Some(0) };
    if connect && !given("anchor") {
        report
            .error(
                rules::MISSING_ATTRIBUTE,
                node.span.clone(),
                format!("{} has no `anchor`", node.describe()),
            )
            .why("it is the point, in the frame of `body1`, where both bodies are held together");
    }
    data[..3].copy_from_slice(&p.reals("anchor", [0.0; 3]));
    // Without a quaternion, the relative pose is computed from the default configuration.
    let relpose = p.reals("relpose", [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
    data[3..10].copy_from_slice(&relpose);
    data[10] = scale;
    Some((Obj::Body, body1?, body2?, data))
}

/// `joint` and `tendon`: a polynomial of the second object, or a constant.
fn coupled(
    refs: References,
    p: &Props,
    node: &ElementNode,
    objtype: Obj,
    report: &mut Diagnostics,
) -> Option<EqualityData> {
    let (kind, first, second) = match objtype {
        Obj::Joint => ("joint", "joint1", "joint2"),
        _ => ("tendon", "tendon1", "tendon2"),
    };
    let obj1 = refs.required(kind, node, first, report)?;
    let obj2 = if node.text(second).is_some() { refs.optional(kind, node, second)? } else { -1 };
    for (id, attribute) in [(obj1, first), (obj2, second)] {
        if objtype == Obj::Joint
            && refs.ids.joint(id).is_some_and(|j| matches!(j.0, joint::FREE | joint::BALL))
        {
            let span = node.attribute(attribute).map_or(node.span.clone(), |a| a.span.clone());
            report
                .error(rules::EQUALITY, span, format!("{} ties a free or ball joint", node.describe()))
                .why("the constraint is an equation between coordinates, and such a joint has several")
                .help("use slide or hinge joints, or `weld` or `connect` for bodies");
        }
    }
    let mut data = [0.0; 11];
    data[..5].copy_from_slice(&p.reals("polycoef", [0.0, 1.0, 0.0, 0.0, 0.0]));
    data[10] = 1.0;
    Some((objtype, obj1, obj2, data))
}
