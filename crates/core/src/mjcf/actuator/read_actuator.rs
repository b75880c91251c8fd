//! Reads actuators: the attributes of their classes and elements, and their targets.

use crate::mjcf::gather::listed;
use std::rc::Rc;

use super::{check_actuator, shortcut};
use crate::kinds::{biastype, dyntype, gaintype, trntype};
use crate::mjcf::classes::Props;
use crate::mjcf::context::Context;
use crate::mjcf::ids::References;
use crate::mjcf::rules;
use crate::mjcf::spec::{ActuatorSpec, BodySpec, RangeSpec, TendonSpec, TransmissionSpec};
use crate::mjcf::text::diagnostic::Diagnostics;
use crate::mjcf::text::tree::{ElementNode, name};

/// All actuators in the order of the text.
pub(crate) fn actuators(
    cx: &mut Context,
    refs: References,
    bodies: &[BodySpec],
    tendons: &[TendonSpec],
) -> Vec<ActuatorSpec> {
    let (tree, classes) = (cx.tree, cx.classes);
    let mut of_class: Vec<ActuatorSpec> = Vec::new();
    for (parent, nodes) in classes.elements() {
        let mut spec = of_class.get(parent).cloned().unwrap_or_else(unset);
        for node in nodes.iter().filter_map(|&i| tree.nodes.get(i)) {
            overlay(&mut spec, node, cx.report);
        }
        of_class.push(spec);
    }
    let nodes = tree.sections("actuator").flat_map(|(section, _)| tree.children(section));
    let mut list = Vec::new();
    for (_, node) in nodes {
        if cx.report.is_full() {
            break;
        }
        cx.enter(node);
        let class = of_class.get(classes.class_of(node, None));
        let mut spec = class.cloned().unwrap_or_else(unset);
        overlay(&mut spec, node, cx.report);
        spec.name = name(node);
        (spec.span, spec.described) = (node.span.clone(), node.describe());
        spec.transmission = transmission(&spec, refs, node, cx.report);
        check_actuator::finish(&mut spec, cx, node, bodies, tendons);
        list.push(spec);
    }
    list
}

/// An actuator with the values before any element is read.
fn unset() -> ActuatorSpec {
    let first = |x: f64| std::array::from_fn(|i| if i == 0 { x } else { 0.0 });
    let auto = RangeSpec { flag: 2, range: [0.0; 2] };
    ActuatorSpec {
        span: 0..0,
        described: String::new(),
        name: String::new(),
        gaintype: gaintype::FIXED,
        gainprm: first(1.0),
        biastype: biastype::NONE,
        biasprm: [0.0; 10],
        dyntype: dyntype::NONE,
        dynprm: first(1.0),
        actdim: -1,
        actearly: false,
        ctrlspec: 0,
        ctrl: auto.clone(),
        velrange: [0.0; 2],
        ffrange: [0.0; 2],
        force: auto.clone(),
        act: auto,
        inheritrange: 0.0,
        gear: [1.0, 0.0, 0.0, 0.0, 0.0, 0.0],
        cranklength: 0.0,
        lengthrange: [0.0; 2],
        damping: [0.0; 3],
        armature: 0.0,
        group: 0,
        nsample: 0,
        interp: 0,
        delay: 0.0,
        user: Rc::default(),
        user_span: 0..0,
        transmission: None,
    }
}

/// Overrides the fields of an actuator: first the attributes that all elements share, then those of its shortcut.
fn overlay(a: &mut ActuatorSpec, node: &ElementNode, report: &mut Diagnostics) {
    let Some(set) = shortcut::find(node.element.name) else { return };
    let p = Props::written_props(node);
    a.gaintype = p.keyword("gaintype").unwrap_or(a.gaintype);
    a.biastype = p.keyword("biastype").unwrap_or(a.biastype);
    a.dyntype = p.keyword("dyntype").unwrap_or(a.dyntype);
    a.gainprm = p.reals("gainprm", a.gainprm);
    a.biasprm = p.reals("biasprm", a.biasprm);
    a.dynprm = p.reals("dynprm", a.dynprm);
    a.actdim = p.int("actdim").unwrap_or(a.actdim);
    a.actearly = p.flag("actearly", a.actearly);
    for (limit, flag, range) in [
        (&mut a.ctrl, "ctrllimited", "ctrlrange"),
        (&mut a.force, "forcelimited", "forcerange"),
        (&mut a.act, "actlimited", "actrange"),
    ] {
        limit.flag = p.keyword(flag).unwrap_or(limit.flag);
        limit.range = p.reals(range, limit.range);
    }
    a.velrange = p.reals("velrange", a.velrange);
    a.ffrange = p.reals("ffrange", a.ffrange);
    a.gear = p.reals("gear", a.gear);
    a.cranklength = p.real("cranklength").unwrap_or(a.cranklength);
    a.lengthrange = p.reals("lengthrange", a.lengthrange);
    a.damping = p.reals("damping", a.damping);
    a.armature = p.real("armature").unwrap_or(a.armature);
    a.group = p.int("group").unwrap_or(a.group);
    a.nsample = p.int("nsample").unwrap_or(a.nsample);
    a.interp = p.keyword("interp").unwrap_or(a.interp);
    a.delay = p.real("delay").unwrap_or(a.delay);
    if p.has("user") {
        a.user = p.shared("user");
        a.user_span = p.span("user").unwrap_or(node.span.clone());
    }
    set(a, &mut super::overlay::ActuatorOverlay { node, p, report });
}

/// The attributes that name the target of an actuator, with the kind of object and the transmission.
const TARGETS: [(&str, &str, i32); 6] = [
    ("joint", "joint", trntype::JOINT),
    ("jointinparent", "joint", trntype::JOINTINPARENT),
    ("tendon", "tendon", trntype::TENDON),
    ("cranksite", "site", trntype::SLIDERCRANK),
    ("site", "site", trntype::SITE),
    ("body", "body", trntype::BODY),
];

/// The target of an actuator. `None`, with an error in the report, if it is unknown.
fn transmission(
    a: &ActuatorSpec,
    refs: References,
    node: &ElementNode,
    report: &mut Diagnostics,
) -> Option<TransmissionSpec> {
    let owner = node.describe();
    let given: Vec<_> = listed(TARGETS.iter().filter(|(name, ..)| node.attribute(name).is_some()));
    if let [.., (first, ..), (last, ..)] = given.as_slice() {
        let message = format!("{owner} has both `{first}` and `{last}`, and acts only on the latter");
        report
            .warning(rules::NO_EFFECT, node.span.clone(), message)
            .why("an actuator acts on one object; of several, MuJoCo takes the last of joint, jointinparent, tendon, cranksite, site, body")
            .help("remove one of them, or write two actuators");
    }
    let named = |name: &str| node.text(name).is_some();
    let (attribute, object, mut kind) = match given.last().filter(|(name, ..)| named(name)) {
        Some(one) => **one,
        None => {
            let possible: Vec<_> = listed(
                TARGETS
                    .iter()
                    .filter(|(name, ..)| node.element.attribute(name).is_some())
                    .map(|(name, ..)| format!("`{name}`")),
            );
            report
                .error(rules::ACTUATOR, node.span.clone(), format!("{owner} acts on nothing"))
                .why("a force needs something to act on")
                .help(match refs.names.of_kind("joint").next() {
                    Some(joint) => {
                        format!(
                            "write `joint=\"{joint}\"`, or one of {} with the name of an object",
                            possible.join(", ")
                        )
                    }
                    None => format!("write one of {} with the name of an object", possible.join(", ")),
                });
            return None;
        }
    };
    check_transmission_attribute(node, attribute, object, kind, report);
    let id = refs.optional(object, node, attribute)?;
    let second = match kind {
        trntype::SLIDERCRANK => refs.required("site", node, "slidersite", report)?,
        trntype::SITE if node.text("refsite").is_some() => refs.optional("site", node, "refsite")?,
        _ => -1,
    };
    if a.gaintype == gaintype::SO3 && matches!(kind, trntype::JOINT | trntype::SITE) {
        kind = trntype::SO3;
        check_orientation(attribute, id, second, refs, node, report);
    }
    if kind == trntype::SLIDERCRANK && a.cranklength <= 0.0 {
        let span = node.attribute("cranklength").map_or(node.span.clone(), |a| a.span.clone());
        report
            .error(rules::ACTUATOR, span, format!("`cranklength` of {owner} is {}", a.cranklength))
            .why("it is the length of the rod between both sites, which must be larger than zero");
    }
    Some(TransmissionSpec { kind, id: [id, second] })
}

/// Reports attributes that are valid only for another transmission.
fn check_transmission_attribute(
    node: &ElementNode,
    attribute: &str,
    object: &str,
    kind: i32,
    report: &mut Diagnostics,
) {
    let owner = node.describe();
    for (name, transmission, needs) in [
        ("slidersite", trntype::SLIDERCRANK, "cranksite"),
        ("cranklength", trntype::SLIDERCRANK, "cranksite"),
        ("refsite", trntype::SITE, "site"),
    ] {
        if let Some(a) = node.attribute(name).filter(|_| kind != transmission) {
            report
                .error(
                    rules::ACTUATOR,
                    a.span.clone(),
                    format!("{owner} has `{name}` but acts on a {object}"),
                )
                .help(format!(
                    "remove `{name}`, which belongs to `{needs}`, or write `{needs}` instead of `{attribute}`"
                ));
        }
    }
}

/// Reports targets that are invalid for an actuator of orientations.
fn check_orientation(
    attribute: &str,
    id: i32,
    second: i32,
    refs: References,
    node: &ElementNode,
    report: &mut Diagnostics,
) {
    let owner = node.describe();
    let joint = attribute == "joint";
    if !joint && second < 0 {
        report
            .error(rules::ACTUATOR, node.span.clone(), format!("{owner} has no `refsite`"))
            .why("an orientation is relative to another site")
            .help("write `refsite` with a site of the world for an orientation in space");
    }
    if joint && refs.ids.joint(id).is_some_and(|(kind, _)| kind != crate::kinds::joint::BALL) {
        report
            .error(
                rules::ACTUATOR,
                node.span.clone(),
                format!("{owner} acts on a joint that is not a ball joint"),
            )
            .why("an orientation has three degrees of freedom")
            .help("use `position` for a hinge, and `site` with `refsite` for the orientation of a free body");
    }
}
