//! Default classes and assets that are never referenced.

use crate::mjcf::rules;
use crate::mjcf::schema::AttributeType;
use crate::mjcf::text::diagnostic::{Diagnostics, shorten_name};
use crate::mjcf::text::tree::{ElementNode, ElementTree};
use crate::mjcf::text::values::Value;
use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;

const CLASS: &str = "default class";
/// Assets that have an effect only if they are referenced.
const ASSETS: [&str; 4] = ["mesh", "material", "texture", "hfield"];

pub(super) fn check_names(tree: &ElementTree, report: &mut Diagnostics) {
    // A file that contains only classes and assets is meant for inclusion.
    if !tree.nodes.iter().any(|n| n.element.name == "geom" && n.parent.is_some_and(|p| holds_bodies(tree, p)))
    {
        return;
    }
    let mut used: BTreeSet<(&str, &str)> = BTreeSet::new();
    for node in &tree.nodes {
        for a in &node.attributes {
            let Value::Text(name) = &a.value else { continue };
            match a.attr.kind {
                AttributeType::Ref(kind) => drop(used.insert((kind, name))),
                AttributeType::Class if node.element.name != "default" => drop(used.insert((CLASS, name))),
                _ => {}
            }
        }
    }
    let mut unused: BTreeMap<&str, Vec<(&str, Range<usize>)>> = BTreeMap::new();
    // A nested class is used if one of the classes inside it is used.
    for (i, node) in tree.nodes.iter().enumerate().filter(|(_, n)| n.element.name == "default") {
        let nested = node.parent.and_then(|p| tree.nodes.get(p)).is_some_and(|p| p.element.name == "default");
        let class = node.attributes.iter().find(|a| matches!(a.attr.kind, AttributeType::Class));
        let (true, Some(class), true) = (nested, class, node.model == 0) else { continue };
        let Value::Text(name) = &class.value else { continue };
        let is_used = |name: &str| used.contains(&(CLASS, name));
        if !is_used(name) && !below(tree, i).into_iter().any(is_used) {
            unused.entry(CLASS).or_default().push((name, class.span.clone()));
        }
    }
    for node in tree.nodes.iter().filter(|n| n.model == 0 && !is_sky(n)) {
        for a in &node.attributes {
            let (AttributeType::Name(kind), Value::Text(name)) = (a.attr.kind, &a.value) else { continue };
            if ASSETS.contains(&kind) && !name.is_empty() && !used.contains(&(kind, name.as_str())) {
                unused.entry(kind).or_default().push((name, a.span.clone()));
            }
        }
    }
    // One note for each kind, at the first unused name.
    for (kind, all) in unused {
        let Some((first, span)) = all.first() else { continue };
        let more = match all.len() {
            1 => String::new(),
            n => format!(", and {} more like it", n - 1),
        };
        report
            .note(
                rules::UNUSED,
                span.clone(),
                format!("nothing uses the {kind} {}{more}", shorten_name(first)),
            )
            .help("use it, or remove it");
    }
}

/// The names of the classes within a class.
fn below(tree: &ElementTree, root: usize) -> Vec<&str> {
    let (mut names, mut open) = (Vec::new(), vec![root]);
    while let Some(index) = open.pop() {
        for (i, node) in tree.children(index).filter(|(_, n)| n.element.name == "default") {
            open.push(i);
            names.extend(node.attributes.iter().filter_map(|a| match &a.value {
                Value::Text(name) => Some(name.as_str()),
                _ => None,
            }));
        }
    }
    names
}

fn holds_bodies(tree: &ElementTree, index: usize) -> bool {
    tree.nodes.get(index).is_some_and(|n| n.element.name != "default")
}

/// A sky texture is visible without a reference.
fn is_sky(node: &ElementNode) -> bool {
    node.element.name == "texture"
        && node.attributes.iter().any(|a| a.attr.name == "type" && matches!(&a.value, Value::Keyword(2)))
}
