//! Copies of elements under other names.

use super::references::{Names, is_asset, kind_of};
use crate::mjcf::schema::Kind;
use crate::mjcf::text::tree::Node;
use crate::mjcf::text::values::Value;

/// How the names in a copy differ.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rename<'a> {
    pub(super) prefix: &'a str,
    pub(super) suffix: &'a str,
    /// The copy comes from another model: its assets and classes come along under new names, and its numbers keep
    /// the meaning that they have there. This is added to [`Node::model`].
    pub(super) other_model: Option<usize>,
}

impl Rename<'_> {
    /// A name of the copy.
    pub(super) fn name(&self, name: &str) -> String {
        format!("{}{name}{}", self.prefix, self.suffix)
    }

    /// The class of what has no class in another model: its own `main`.
    pub(super) fn main_class(&self) -> String {
        match (self.prefix, self.other_model) {
            // Without a prefix it would be the main class of the model that attaches.
            ("", Some(model)) => format!("main of attached model {model}"),
            _ => self.name("main"),
        }
    }

    /// A class of the copy.
    pub(super) fn class(&self, class: &str) -> String {
        if class == "main" { self.main_class() } else { self.name(class) }
    }
}

/// The copy of an element and all that it holds, in the order of the text: the first has no parent, the others
/// their parent's place in the copy. With it, the place of each in the original.
///
/// References are renamed when they lead to what is copied, `Some` of these names; all when it is `None`.
pub(super) fn copy(
    nodes: &[Node],
    root: usize,
    rename: Rename,
    copied: Option<&Names>,
) -> (Vec<Node>, Vec<usize>) {
    let (mut copy, mut from): (Vec<Node>, Vec<usize>) = (Vec::new(), Vec::new());
    let mut stack = vec![(root, None)];
    while let Some((at, parent)) = stack.pop() {
        let Some(node) = nodes.get(at) else { continue };
        let here = copy.len();
        if let Some(parent) = parent.and_then(|p: usize| copy.get_mut(p)) {
            parent.children.push(here);
        }
        let mut renamed = Node { parent, children: Vec::new(), ..node.clone() };
        renamed.model += rename.other_model.unwrap_or(0);
        for i in 0..renamed.attributes.len() {
            if let Some(name) = new_name(node, i, rename, copied)
                && let Some(a) = renamed.attributes.get_mut(i)
            {
                a.value = Value::Text(name);
            }
        }
        copy.push(renamed);
        from.push(at);
        stack.extend(node.children.iter().rev().map(|&c| (c, Some(here))));
    }
    (copy, from)
}

/// The new text of an attribute that is a name; `None` when it stays.
fn new_name(node: &Node, i: usize, rename: Rename, copied: Option<&Names>) -> Option<String> {
    let a = node.attributes.get(i)?;
    let Value::Text(text) = &a.value else { return None };
    if text.is_empty() {
        return None;
    }
    match (a.attr.kind, kind_of(node, a)) {
        (Kind::Name(_), _) => Some(rename.name(text)),
        (Kind::Class, _) => rename.other_model.map(|_| rename.class(text)),
        (_, Some(kind)) if is_asset(kind) => rename.other_model.map(|_| rename.name(text)),
        (_, Some(kind)) => {
            let follows = copied.is_none_or(|names| names.contains(&(kind, text.clone())));
            follows.then(|| rename.name(text))
        }
        _ => None,
    }
}

/// The names of an element and all that it holds.
pub(super) fn names(nodes: &[Node], root: usize) -> Names {
    let mut names = Names::new();
    let mut stack = vec![root];
    while let Some(node) = stack.pop().and_then(|at| nodes.get(at)) {
        names.extend(own_name(node));
        stack.extend(&node.children);
    }
    names
}

/// Kind and name of an element that has a name.
pub(super) fn own_name(node: &Node) -> Option<(&'static str, String)> {
    node.attributes.iter().find_map(|a| match (a.attr.kind, &a.value) {
        (Kind::Name(kind), Value::Text(name)) if !name.is_empty() => Some((kind, name.clone())),
        _ => None,
    })
}
