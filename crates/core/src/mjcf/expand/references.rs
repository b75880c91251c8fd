//! The objects that an element refers to, and whether the element is copied with them.

use crate::mjcf::gather::{filled, listed};
use std::collections::BTreeSet;

use crate::mjcf::names::WORLD;
use crate::mjcf::schema::AttributeType;
use crate::mjcf::text::tree::{Attribute, ElementNode};
use crate::mjcf::text::values::Value;
use crate::model::Obj;

/// Objects by kind and name.
pub(crate) type Names = BTreeSet<(&'static str, String)>;

/// Sections whose elements refer to objects, in the order of dependency: a section may refer to sections before it.
pub(super) const SECTIONS: [&str; 6] = ["contact", "tendon", "equality", "actuator", "sensor", "custom"];

/// Whether objects of a kind are shared by all copies within one model.
pub(super) fn is_asset(kind: &str) -> bool {
    matches!(kind, "texture" | "material" | "mesh" | "hfield" | "skin" | "model")
}

/// The kind of object that an attribute names, or `None` if the attribute is not a reference.
pub(crate) fn kind_of(node: &ElementNode, attribute: &Attribute) -> Option<&'static str> {
    // The kind of the object is the value of another attribute.
    let chosen = match attribute.attr.name {
        "objname" => node.attribute("objtype"),
        "refname" => node.attribute("reftype"),
        _ => {
            return match attribute.attr.kind {
                AttributeType::Ref(kind) => Some(kind),
                _ => None,
            };
        }
    };
    match &chosen?.value {
        Value::Keyword(n) => keyword(*n),
        Value::Text(word) => KINDS.iter().find(|(_, kind)| kind == word).map(|&(_, kind)| kind),
        _ => None,
    }
}

/// Object kinds that a keyword can select.
const KINDS: [(Obj, &str); 6] = [
    (Obj::Body, "body"),
    (Obj::XBody, "body"),
    (Obj::Joint, "joint"),
    (Obj::Geom, "geom"),
    (Obj::Site, "site"),
    (Obj::Camera, "camera"),
];

fn keyword(n: i32) -> Option<&'static str> {
    KINDS.iter().find(|(obj, _)| *obj as i32 == n).map(|&(_, kind)| kind)
}

/// The objects that an element and its children refer to, except assets.
pub(super) fn list_references(nodes: &[ElementNode], index: usize) -> Vec<(&'static str, String)> {
    let Some(node) = nodes.get(index) else { return Vec::new() };
    let children = node.children.iter().filter_map(|&c| nodes.get(c));
    let named = |n: &ElementNode| {
        let refs = n.attributes.iter().filter_map(|a| match (kind_of(n, a), &a.value) {
            (Some(kind), Value::Text(name)) if !name.is_empty() && !is_asset(kind) => {
                Some((kind, name.clone()))
            }
            _ => None,
        });
        listed(refs)
    };
    filled(std::iter::once(node).chain(children).flat_map(named))
}

/// Whether an element that refers to these objects is copied when `copied` are copied. For some sections MuJoCo requires that
/// one of the objects is copied, for others that all are. An element without references is always copied. In a copy of
/// another model, the only object that may stay is the world.
pub(super) fn follows(
    section: &str,
    refs: &[(&'static str, String)],
    copied: &Names,
    other_model: bool,
) -> bool {
    let is_copied = |r: &(&'static str, String)| copied.contains(r);
    let stays = |r: &(&'static str, String)| !other_model || r.0 == "body" && r.1 == WORLD;
    let one_is_enough = matches!(section, "contact" | "sensor" | "tendon");
    match refs {
        [] => true,
        _ if one_is_enough => refs.iter().any(is_copied) && refs.iter().all(|r| is_copied(r) || stays(r)),
        _ => refs.iter().all(is_copied),
    }
}
