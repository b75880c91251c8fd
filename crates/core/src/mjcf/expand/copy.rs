//! Copies of elements with renamed objects.

use super::references::{Names, is_asset, kind_of};
use crate::mjcf::schema::AttributeType;
use crate::mjcf::text::tree::ElementNode;
use crate::mjcf::text::values::Value;

/// The change of names in a copy.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rename<'a> {
    pub(super) prefix: &'a str,
    pub(super) suffix: &'a str,
    /// `Some` if the copy comes from another model. Its assets and classes are then copied and renamed, and its numbers keep
    /// their meaning in that model. The value is added to [`ElementNode::model`].
    pub(super) other_model: Option<usize>,
}

impl Rename<'_> {
    /// The name of an object in the copy.
    pub(super) fn name(&self, name: &str) -> String {
        format!("{}{name}{}", self.prefix, self.suffix)
    }

    /// The main class of another model, for its elements without a class.
    pub(super) fn main_class(&self) -> String {
        match (self.prefix, self.other_model) {
            // Without a prefix, the name would be that of the main class of the attaching model.
            ("", Some(model)) => format!("main of attached model {model}"),
            _ => self.name("main"),
        }
    }

    /// The name of a class in the copy.
    pub(super) fn class(&self, class: &str) -> String {
        if class == "main" { self.main_class() } else { self.name(class) }
    }
}

/// Copies an element and all its descendants, in the order of the text. The first has no parent, the others have the index of
/// their parent in the copy. Also returns the index of each element in the original.
///
/// References are renamed if `copied` contains the referenced object, or if `copied` is `None`.
pub(super) fn copy(
    nodes: &[ElementNode],
    root: usize,
    rename: Rename,
    copied: Option<&Names>,
) -> (Vec<ElementNode>, Vec<usize>) {
    let (mut copy, mut from): (Vec<ElementNode>, Vec<usize>) = (Vec::new(), Vec::new());
    let mut stack = vec![(root, None)];
    while let Some((index, parent)) = stack.pop() {
        let Some(node) = nodes.get(index) else { continue };
        let here = copy.len();
        if let Some(parent) = parent.and_then(|p: usize| copy.get_mut(p)) {
            parent.children.push(here);
        }
        let mut renamed = ElementNode { parent, children: Vec::new(), ..node.clone() };
        renamed.model += rename.other_model.unwrap_or(0);
        for i in 0..renamed.attributes.len() {
            if let Some(name) = new_name(node, i, rename, copied)
                && let Some(a) = renamed.attributes.get_mut(i)
            {
                a.value = Value::Text(name);
            }
        }
        copy.push(renamed);
        from.push(index);
        stack.extend(node.children.iter().rev().map(|&c| (c, Some(here))));
    }
    (copy, from)
}

/// The new text of an attribute that is a name, or `None` if it does not change.
fn new_name(node: &ElementNode, i: usize, rename: Rename, copied: Option<&Names>) -> Option<String> {
    let a = node.attributes.get(i)?;
    let Value::Text(text) = &a.value else { return None };
    if text.is_empty() {
        return None;
    }
    match (a.attr.kind, kind_of(node, a)) {
        (AttributeType::Name(_), _) => Some(rename.name(text)),
        (AttributeType::Class, _) => rename.other_model.map(|_| rename.class(text)),
        (_, Some(kind)) if is_asset(kind) => rename.other_model.map(|_| rename.name(text)),
        (_, Some(kind)) => {
            let follows = copied.is_none_or(|names| names.contains(&(kind, text.clone())));
            follows.then(|| rename.name(text))
        }
        _ => None,
    }
}

/// The names of an element and all its descendants.
pub(super) fn names(nodes: &[ElementNode], root: usize) -> Names {
    let mut names = Names::new();
    let mut stack = vec![root];
    while let Some(node) = stack.pop().and_then(|index| nodes.get(index)) {
        names.extend(own_name(node));
        stack.extend(&node.children);
    }
    names
}

/// The kind and name of an element, if it has a name.
pub(super) fn own_name(node: &ElementNode) -> Option<(&'static str, String)> {
    node.attributes.iter().find_map(|a| match (a.attr.kind, &a.value) {
        (AttributeType::Name(kind), Value::Text(name)) if !name.is_empty() => Some((kind, name.clone())),
        _ => None,
    })
}
