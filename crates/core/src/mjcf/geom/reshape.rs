//! Changes of the whole model that `compiler` requests, made after masses are known. `fusestatic` merges bodies without joints
//! into their parents, `discardvisual` removes geoms that cannot collide, and `alignfree` aligns free bodies with the frame of
//! their inertia. Also sets the total mass.
//!
//! Which elements remain, and in which order, follows MuJoCo 3.14.0 (XML reference, `compiler`; measured on the library).

use crate::mjcf::gather::{filled, listed};
use std::collections::BTreeSet;

use crate::kinds::{choice, joint};
use crate::math::{IDENTITY, MINVAL, quat_conj, rotate, scale};
use crate::mjcf::body::frame::Pose;
use crate::mjcf::body::inertia::combined;
use crate::mjcf::expand::AttachedModel;
use crate::mjcf::expand::references::{Names, kind_of};
use crate::mjcf::settings::CompilerSettings;
use crate::mjcf::spec::{BodySpec, GeomSpec, Inertia};
use crate::mjcf::text::tree::{ElementNode, ElementTree};
use crate::mjcf::text::values::Value;
use crate::model::Model;

/// Applies the changes that the model requests.
pub(crate) fn apply(
    bodies: &mut Vec<BodySpec>,
    inertias: &mut Vec<Inertia>,
    tree: &ElementTree,
    parts: &[AttachedModel],
) {
    let Some(AttachedModel { compiler, .. }) = parts.first() else { return };
    align_free(bodies, inertias, parts);
    if compiler.fusestatic {
        fuse_static(bodies, inertias, tree);
    }
    if compiler.discardvisual {
        let named = references(tree);
        let seen = |g: &GeomSpec| g.contype == 0 && g.conaffinity == 0;
        for body in bodies {
            body.geoms.retain(|g| !seen(g) || named.contains(&("geom", g.name.clone())));
        }
    }
}

/// Moves the frame of each free body without children to its centre of mass, along its principal axes. Its mass
/// matrix is then diagonal.
fn align_free(bodies: &mut [BodySpec], inertias: &mut [Inertia], parts: &[AttachedModel]) {
    let mut carries = vec![false; bodies.len()];
    for body in bodies.iter().skip(1) {
        if let Some(carries) = carries.get_mut(body.parent) {
            *carries = true;
        }
    }
    for ((body, inertia), carries) in bodies.iter_mut().zip(inertias).zip(carries) {
        let by_rule = parts.get(body.part).is_some_and(|p| p.compiler.alignfree);
        let asked = |align: i32| if align == choice::AUTO { by_rule } else { align == choice::TRUE };
        let free = body.joints.iter().any(|j| j.kind == joint::FREE && asked(j.align));
        if !free || carries {
            continue;
        }
        let to = Pose { pos: inertia.pos, quat: inertia.quat };
        Pose { pos: body.pos, quat: body.quat } =
            Pose { pos: body.pos, quat: body.quat }.in_parent(to.pos, to.quat);
        let back = quat_conj(to.quat);
        move_members(body, Pose { pos: rotate(scale(to.pos, -1.0), back), quat: back });
        (inertia.pos, inertia.quat) = ([0.0; 3], IDENTITY);
    }
}

/// Moves the members of a body to another frame. `pose` is the old frame relative to the new one.
fn move_members(body: &mut BodySpec, pose: Pose) {
    body.geoms.iter_mut().for_each(|g| pose.transform_to_parent(&mut g.pos, &mut g.quat));
    body.sites.iter_mut().for_each(|s| pose.transform_to_parent(&mut s.pos, &mut s.quat));
    body.cameras.iter_mut().for_each(|c| pose.transform_to_parent(&mut c.pos, &mut c.quat));
    for light in &mut body.lights {
        light.pos = pose.point(light.pos);
        light.dir = pose.direction(light.dir);
    }
}

/// Merges bodies without joints into their parents, unless an element refers to them. Their members are appended to those of
/// their parents, and their children replace them.
///
/// MuJoCo resolves every reference again for each body, with the original indexes of the bodies. If an index is beyond the end of
/// the shortened list, no named body is removed before the referenced one is reached.
fn fuse_static(bodies: &mut Vec<BodySpec>, inertias: &mut Vec<Inertia>, tree: &ElementTree) {
    let named = references(tree);
    let sensed = sites_of_force_sensors(tree);
    let meant = |body: &BodySpec| !body.name.is_empty() && named.contains(&("body", body.name.clone()));
    let last_meant = bodies.iter().rposition(meant).unwrap_or(0);
    let mut left = bodies.len();
    // For each merged body, the body that it was merged into, and its pose relative to that body.
    let mut fused: Vec<Option<(usize, Pose)>> = vec![None; bodies.len()];
    for i in 1..bodies.len() {
        let (before, rest) = bodies.split_at_mut(i);
        let (Some(body), Some(inertia)) = (rest.first_mut(), inertias.get(i).cloned()) else { return };
        if let Some(Some((target, pose))) = fused.get(body.parent) {
            body.parent = *target;
            pose.transform_to_parent(&mut body.pos, &mut body.quat);
        }
        let is_named = !body.name.is_empty()
            && (meant(body)
                || i < last_meant && last_meant >= left
                || body.sites.iter().any(|s| sensed.contains(s.name.as_str())));
        if is_named || !body.joints.is_empty() || body.mocap {
            continue;
        }
        let (Some(parent), Some(merged)) = (before.get_mut(body.parent), inertias.get_mut(body.parent))
        else {
            continue;
        };
        let pose = Pose { pos: body.pos, quat: body.quat };
        if body.parent > 0 && inertia.mass >= MINVAL {
            let Pose { pos, quat } = pose.in_parent(inertia.pos, inertia.quat);
            *merged = combined(&[merged.clone(), Inertia { pos, quat, ..inertia }]);
        }
        move_members(body, pose);
        parent.geoms.append(&mut body.geoms);
        parent.sites.append(&mut body.sites);
        parent.cameras.append(&mut body.cameras);
        parent.lights.append(&mut body.lights);
        if let Some(slot) = fused.get_mut(i) {
            *slot = Some((body.parent, pose));
            left -= 1;
        }
    }

    // Parents precede their children, so that the new index of a parent is known when it is needed.
    let mut number = vec![0; bodies.len()];
    let mut next = 0;
    for (n, gone) in number.iter_mut().zip(&fused) {
        *n = next;
        next += usize::from(gone.is_none());
    }
    let mut gone = fused.iter().map(Option::is_some);
    inertias.retain(|_| gone.next() != Some(true));
    let mut gone = fused.iter().map(Option::is_some);
    bodies.retain(|_| gone.next() != Some(true));
    for body in bodies {
        body.parent = number.get(body.parent).copied().unwrap_or(0);
    }
}

/// All objects that elements refer to.
fn references(tree: &ElementTree) -> Names {
    let files_of = |node: &ElementNode| {
        let names = node.attributes.iter().filter_map(|a| match (kind_of(node, a), &a.value) {
            (Some(kind), Value::Text(name)) => Some((kind, name.clone())),
            _ => None,
        });
        listed(names)
    };
    filled(tree.nodes.iter().flat_map(files_of))
}

/// The sites at which forces between bodies are measured. Their bodies must not be merged, because the force acts between body
/// and parent.
fn sites_of_force_sensors(tree: &ElementTree) -> BTreeSet<&str> {
    let sensors = tree.sections("sensor").flat_map(|(section, _)| tree.children(section));
    let of_force = sensors.filter(|(_, n)| matches!(n.element.name, "force" | "torque"));
    filled(of_force.filter_map(|(_, n)| n.text("site")))
}

/// Scales masses and inertias so that the total mass is `settotalmass`, if that is positive.
pub(crate) fn total_mass(m: &mut Model, compiler: &CompilerSettings) {
    if compiler.settotalmass <= 0.0 {
        return;
    }
    let sum: f64 = m.body_mass.iter().sum();
    let factor = (compiler.settotalmass / sum.max(MINVAL)).max(MINVAL);
    m.body_mass.iter_mut().for_each(|x| *x *= factor);
    m.body_inertia.iter_mut().for_each(|x| *x *= factor);
}
