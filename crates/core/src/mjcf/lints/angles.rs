//! Angles in the wrong unit, and gravity in the wrong direction: numbers that are right in the conventions of another program.

use super::{digits, format_name, own_name};
use crate::kinds::{angle, biastype, geom, joint, trntype};
use crate::mjcf::gather::listed;
use crate::mjcf::rules;
use crate::mjcf::text::diagnostic::Diagnostics;
use crate::mjcf::text::tree::{Attribute, ElementNode, ElementTree};
use crate::mjcf::text::values::Value;
use crate::model::{Model, Obj};
use std::f64::consts::PI;

/// The decimals to which authors round an angle.
const DECIMALS: std::ops::RangeInclusive<i32> = 2..=10;
/// Angles are recognized in steps of 15 degrees, up to two turns.
const STEP: f64 = 15.0;
const MAX_STEPS: f64 = 48.0;
/// A servo whose targets are larger, in radians, is given degrees if they are also the range of its joint in degrees.
const LARGE_TARGET: f64 = 10.0;
/// The standard gravity on Earth, m/s², and how much values for other places and of fewer digits differ.
const EARTH: (f64, f64) = (9.81, 0.03);

pub(super) fn check_angles(tree: &ElementTree, m: &Model, report: &mut Diagnostics) {
    let radians = tree.sections("compiler").any(|(_, n)| n.keyword("angle") == Some(angle::RADIAN));
    for node in tree.nodes.iter().filter(|n| n.model == 0) {
        match radians {
            true => degrees_in_range(tree, node, report),
            false => radians_for_degrees(tree, node, report),
        }
    }
    degrees_of_servo(tree, m, report);
    degrees_in_keys(tree, m, report);
    gravity(tree, m, report);
}

/// Reports angles of an element that are multiples of 15 degrees in radians.
fn radians_for_degrees(tree: &ElementTree, node: &ElementNode, report: &mut Diagnostics) {
    for attribute in &node.attributes {
        let Value::Reals(all) = &attribute.value else { continue };
        let angles = match (node.element.name, attribute.attr.name) {
            ("joint", "range" | "ref" | "springref") if turns(tree, node) => all.as_slice(),
            (_, "euler") => all.as_slice(),
            (_, "axisangle") => all.get(3..).unwrap_or_default(),
            _ => continue,
        };
        let degrees: Option<Vec<f64>> = angles.iter().map(|x| rounded_radians(*x)).collect();
        let Some(degrees) = degrees.filter(|d| d.iter().any(|x| *x != 0.0)) else { continue };
        let [given, meant] = [angles, &degrees].map(|l| listed(l.iter().map(|x| digits(*x))).join(" "));
        let name = attribute.attr.name;
        let message = format!("`{name}` is {given}, in degrees: as radians it would be {meant} degrees");
        report
            .warning(rules::ANGLE_UNIT, attribute.span.clone(), message)
            .why("angles of this model are read in degrees, because its `compiler` does not say `angle=\"radian\"`")
            .help(format!(
                "write {meant}; if every angle of the model is in radians, write `<compiler angle=\"radian\"/>` instead"
            ));
    }
}

/// Whether a joint turns: its range is an angle. Not known if a default gives its type.
fn turns(tree: &ElementTree, node: &ElementNode) -> bool {
    match node.keyword("type") {
        Some(kind) => kind != joint::SLIDE,
        None => !tree
            .nodes
            .iter()
            .any(|n| n.element.name == "joint" && in_default(tree, n) && n.keyword("type").is_some()),
    }
}

fn in_default(tree: &ElementTree, node: &ElementNode) -> bool {
    node.parent.and_then(|p| tree.nodes.get(p)).is_some_and(|p| p.element.name == "default")
}

/// The angle in degrees, if a number is a multiple of 15 degrees in radians, rounded to two or more decimals. Two decimals are
/// enough for right angles only, three for multiples of 30 and 45 degrees: 0.52 may be half a degree.
fn rounded_radians(x: f64) -> Option<f64> {
    if x == 0.0 {
        return Some(0.0);
    }
    let steps = (x / (STEP * PI / 180.0)).round();
    let exact = steps * STEP * PI / 180.0;
    let divides = |n: f64| steps % n == 0.0;
    let enough = if divides(6.0) {
        2
    } else if divides(2.0) || divides(3.0) {
        3
    } else {
        4
    };
    let matches = |decimals: i32| {
        let scale = 10_f64.powi(decimals);
        let rounded = ((exact * scale).round() - x * scale).abs() < 1e-6;
        let cut = ((exact * scale).trunc() - x * scale).abs() < 1e-6;
        // The digits that are written must be those of the angle: 3.1 and 0.5 are ordinary numbers.
        let written = (x * scale / 10.0).fract().abs() > 1e-6;
        (rounded || cut) && written && decimals >= enough
    };
    (steps != 0.0 && steps.abs() <= MAX_STEPS && DECIMALS.into_iter().any(matches)).then_some(steps * STEP)
}

/// Whether a number is a multiple of 15 of at most 360: a usual angle in degrees, but many turns in radians.
fn is_usual_in_degrees(x: f64) -> bool {
    x % STEP == 0.0 && x.abs() <= 360.0
}

/// Reports a range of a joint that is written in degrees, although the model is in radians.
fn degrees_in_range(tree: &ElementTree, node: &ElementNode, report: &mut Diagnostics) {
    let Some(range) = node.attribute("range").filter(|_| node.element.name == "joint" && turns(tree, node))
    else {
        return;
    };
    let Value::Reals(all) = &range.value else { return };
    if !all.iter().all(|x| is_usual_in_degrees(*x)) || all.iter().all(|x| *x == 0.0) {
        return;
    }
    let turns = all.iter().fold(0.0, |most: f64, x| most.max(x.abs())) / (2.0 * PI);
    let meant = listed(all.iter().map(|x| digits(x.to_radians()))).join(" ");
    report
        .warning(
            rules::ANGLE_UNIT,
            range.span.clone(),
            format!("`range` reaches {} turns: it looks like degrees", digits(turns)),
        )
        .why("angles of this model are read in radians, because its `compiler` says `angle=\"radian\"`")
        .help(format!("write {meant}, which is the same range in radians"));
}

/// Reports keyframes that turn a joint by a number of radians that is a usual angle in degrees.
fn degrees_in_keys(tree: &ElementTree, m: &Model, report: &mut Diagnostics) {
    let nodes: Vec<&ElementNode> =
        listed(tree.sections("keyframe").flat_map(|(i, _)| tree.children(i).map(|(_, n)| n)));
    for (k, node) in nodes.iter().enumerate().take(m.nkey) {
        let Some(qpos) = node.attribute("qpos") else { continue };
        let hinges = (0..m.njnt).filter(|j| m.jnt_type.get(*j) == Some(&joint::HINGE));
        let looks_like_degrees = |j: usize| {
            let adr = usize::try_from(*m.jnt_qposadr.get(j)?).ok()?;
            let x = *m.key_qpos.get(k * m.nq + adr)?;
            (x != 0.0 && is_usual_in_degrees(x)).then_some((j, x))
        };
        let Some((j, x)) = hinges.into_iter().find_map(looks_like_degrees) else { continue };
        let name = m.names.of_kind(Obj::Joint).get(j).map_or("", String::as_str);
        let message = format!(
            "{} turns {} by {} radians: it looks like degrees",
            format_name("key", own_name(node).unwrap_or(""), k),
            format_name("joint", name, j),
            digits(x)
        );
        report
            .warning(rules::ANGLE_UNIT, qpos.span.clone(), message)
            .why("positions in a keyframe are always radians")
            .help(format!("write {} for this joint", digits(x.to_radians())));
    }
}

/// Reports position servos whose targets are the range of their joint in degrees.
fn degrees_of_servo(tree: &ElementTree, m: &Model, report: &mut Diagnostics) {
    let nodes: Vec<&ElementNode> =
        listed(tree.sections("actuator").flat_map(|(i, _)| tree.children(i).map(|(_, n)| n)));
    if nodes.len() != m.nactuator || m.nu != m.nactuator {
        return;
    }
    for (a, node) in nodes.iter().enumerate() {
        let servo = m.actuator_trntype.get(a) == Some(&trntype::JOINT)
            && m.actuator_biastype.get(a) == Some(&biastype::AFFINE)
            && m.actuator_biasprm.get(10 * a + 1).is_some_and(|k| *k < 0.0);
        let hinge = m.actuator_trnid.get(2 * a).and_then(|j| usize::try_from(*j).ok()).filter(|j| {
            m.jnt_type.get(*j) == Some(&joint::HINGE) && m.jnt_limited.get(*j).copied().unwrap_or(false)
        });
        let (Some(j), true) = (hinge, servo) else { continue };
        let (Some(targets), Some(range)) =
            (m.actuator_ctrlrange.get(2 * a..2 * a + 2), m.jnt_range.get(2 * j..2 * j + 2))
        else {
            continue;
        };
        let large = targets.iter().any(|x| x.abs() > LARGE_TARGET);
        let same = targets.iter().zip(range).all(|(t, r)| (t - r * 180.0 / PI).abs() < 0.5);
        if !large || !same {
            continue;
        }
        let name = m.names.of_kind(Obj::Actuator).get(a).map_or("", String::as_str);
        let [given, meant] = [targets, range].map(|l| listed(l.iter().map(|x| digits(*x))).join(" "));
        let message = format!(
            "targets of {} are {given} radians, which is the range of its joint in degrees",
            format_name("servo", name, a)
        );
        report
            .warning(rules::ANGLE_UNIT, ctrlrange_span(node), message)
            .why("targets are always radians: only angles of joints and orientations are read in degrees")
            .help(format!(
                "write `ctrlrange=\"{meant}\"`, or `inheritrange=\"1\"` for the range of the joint"
            ));
    }
}

fn ctrlrange_span(node: &ElementNode) -> std::ops::Range<usize> {
    node.attribute("ctrlrange").map_or(node.span.clone(), |a: &Attribute| a.span.clone())
}

/// Reports gravity that pulls up, or along every plane on which a free body could lie.
fn gravity(tree: &ElementTree, m: &Model, report: &mut Diagnostics) {
    let Some(written) = tree.sections("option").filter_map(|(_, n)| n.attribute("gravity")).last() else {
        return;
    };
    let [x, y, z] = m.opt.gravity;
    let earth = |g: f64| (g.abs() - EARTH.0).abs() <= EARTH.1;
    let up = x == 0.0 && y == 0.0 && earth(z) && z > 0.0;
    let sideways = z == 0.0 && ((x == 0.0 && earth(y)) || (y == 0.0 && earth(x)));
    let (message, help) = if up && !planes(m).any(|normal| normal[2] < 0.0) {
        ("gravity pulls upward: z points up".to_owned(), format!("write `0 0 {}`", digits(-z)))
    } else if sideways && falls_along(m, [x, y, z]) {
        let axis = if x == 0.0 { "y" } else { "x" };
        let message = format!("gravity pulls along {axis}, along the floor: no plane stops what falls");
        (
            message,
            format!(
                "write `gravity=\"0 0 -{}\"`: z points up; or turn the plane",
                digits(x.abs().max(y.abs()))
            ),
        )
    } else {
        return;
    };
    report.warning(rules::GRAVITY, written.span.clone(), message).help(help);
}

/// Whether a free body falls, and every plane of the world that it could touch is parallel to gravity.
fn falls_along(m: &Model, g: [f64; 3]) -> bool {
    let mut all = planes(m).peekable();
    let free = m.jnt_type.contains(&joint::FREE);
    free && all.peek().is_some()
        && all.all(|n| n.iter().zip(&g).map(|(a, b)| a * b).sum::<f64>().abs() < 1e-6)
}

/// The normals of the planes of the world that collide.
fn planes(m: &Model) -> impl Iterator<Item = [f64; 3]> {
    (0..m.ngeom).filter_map(|g| {
        let collides =
            [&m.geom_contype, &m.geom_conaffinity].iter().any(|bits| bits.get(g).is_some_and(|b| *b != 0));
        let plane = m.geom_type.get(g) == Some(&geom::PLANE) && m.geom_bodyid.get(g) == Some(&0) && collides;
        let [w, x, y, z] = *m.geom_quat.get(4 * g..4 * g + 4)?.first_chunk::<4>()?;
        plane.then_some([2.0 * (x * z + w * y), 2.0 * (y * z - w * x), w * w - x * x - y * y + z * z])
    })
}
