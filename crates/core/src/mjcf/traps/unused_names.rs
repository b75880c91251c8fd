//! Default classes and assets that nothing names.

use crate::mjcf::rules;
use crate::mjcf::schema::Kind;
use crate::mjcf::text::diagnostic::{Report, shown};
use crate::mjcf::text::tree::Tree;
use crate::mjcf::text::values::Value;
use std::collections::BTreeSet;

/// Assets that are there to be named.
const ASSETS: [&str; 4] = ["mesh", "material", "texture", "hfield"];

pub(super) fn tell(tree: &Tree, report: &mut Report) {
    let mut used: BTreeSet<(&str, &str)> = BTreeSet::new();
    for node in &tree.nodes {
        for a in &node.attributes {
            let Value::Text(name) = &a.value else { continue };
            match a.attr.kind {
                Kind::Ref(kind) => drop(used.insert((kind, name))),
                Kind::Class if node.element.name != "default" => drop(used.insert(("default class", name))),
                _ => {}
            }
        }
    }
    // A class in another one is used through it.
    for (i, node) in tree.nodes.iter().enumerate().filter(|(_, n)| n.element.name == "default") {
        let nested = node.parent.and_then(|p| tree.nodes.get(p)).is_some_and(|p| p.element.name == "default");
        let class = node.attributes.iter().find(|a| matches!(a.attr.kind, Kind::Class));
        let (true, Some(class), true) = (nested, class, node.model == 0) else { continue };
        let Value::Text(name) = &class.value else { continue };
        let inner = below(tree, i);
        if !used.contains(&("default class", name.as_str()))
            && !inner.iter().any(|n| used.contains(&("default class", n)))
        {
            report
                .note(
                    rules::UNUSED,
                    class.span.clone(),
                    format!("nothing is of the default class {}", shown(name)),
                )
                .help("give it to what it is meant for, or remove it");
        }
    }
    for node in tree.nodes.iter().filter(|n| n.model == 0) {
        for a in &node.attributes {
            let (Kind::Name(kind), Value::Text(name)) = (a.attr.kind, &a.value) else { continue };
            if ASSETS.contains(&kind) && !name.is_empty() && !used.contains(&(kind, name.as_str())) {
                report
                    .note(rules::UNUSED, a.span.clone(), format!("nothing uses the {kind} {}", shown(name)))
                    .help("name it where it is meant to be seen, or remove it");
            }
        }
    }
}

/// Names of the classes within a class.
fn below(tree: &Tree, of: usize) -> Vec<&str> {
    let (mut names, mut open) = (Vec::new(), vec![of]);
    while let Some(at) = open.pop() {
        for (i, node) in tree.children(at).filter(|(_, n)| n.element.name == "default") {
            open.push(i);
            names.extend(node.attributes.iter().filter_map(|a| match &a.value {
                Value::Text(name) => Some(name.as_str()),
                _ => None,
            }));
        }
    }
    names
}
