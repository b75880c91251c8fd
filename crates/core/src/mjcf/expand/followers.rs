//! The elements that are copied together with a part of the tree: sensors, tendons and other elements that refer to it.

use crate::mjcf::gather::{filled, listed};
use std::collections::{BTreeMap, BTreeSet};

use super::copy::own_name;
use super::references::{self, Names, SECTIONS};
use crate::mjcf::text::tree::ElementNode;

/// The elements of [`SECTIONS`], indexed by the objects that they refer to.
#[derive(Debug, Default)]
pub(super) struct Uses {
    /// For each object, the section (an index of [`SECTIONS`]) and the element of each reference to it.
    by_object: BTreeMap<(&'static str, String), Vec<(usize, usize)>>,
    /// Elements without references.
    free: Vec<(usize, usize)>,
    gone: BTreeSet<usize>,
}

/// The elements of one section that are copied together with a part.
#[derive(Debug)]
pub(super) struct Followers {
    pub(super) section: &'static str,
    /// The elements, in the order in which they are copied.
    pub(super) elements: Vec<usize>,
    /// The names that are copied with this section, before they are renamed.
    pub(super) names: Names,
    /// The elements that refer to copied objects, and the subset that also refers to objects that are not copied, so that no copy
    /// can be complete.
    pub(super) bound: Vec<usize>,
    pub(super) incomplete: Vec<usize>,
}

/// Whether an element can be copied with a part. Custom numbers and texts belong to the model as a whole.
pub(super) fn can_follow(section: &str, node: &ElementNode) -> bool {
    section != "custom" || node.element.name == "tuple"
}

impl Uses {
    /// Adds an element to the index.
    pub(super) fn add(&mut self, section: &str, nodes: &[ElementNode], index: usize) {
        let Some(section) = SECTIONS.iter().position(|s| *s == section) else { return };
        if !nodes.get(index).is_some_and(|node| can_follow(SECTIONS[section], node)) {
            return;
        }
        let refs = references::list_references(nodes, index);
        if refs.is_empty() {
            self.free.push((section, index));
        }
        for object in refs {
            self.by_object.entry(object).or_default().push((section, index));
        }
    }

    /// Removes elements permanently.
    pub(super) fn remove(&mut self, elements: impl IntoIterator<Item = usize>) {
        self.gone.extend(elements);
    }

    /// Whether an element was removed.
    pub(super) fn is_removed(&self, index: usize) -> bool {
        self.gone.contains(&index)
    }

    /// The index of all elements of a tree.
    pub(super) fn build_index(nodes: &[ElementNode]) -> Uses {
        let mut uses = Uses::default();
        for &section in nodes.first().map_or(&[][..], |root| &root.children) {
            let Some(section) = nodes.get(section) else { continue };
            for &index in &section.children {
                uses.add(section.element.name, nodes, index);
            }
        }
        uses
    }

    /// The elements that are copied together with a part that has these names: those that refer to it, directly or through
    /// other copied elements, and those without references.
    pub(super) fn followers(
        &self,
        nodes: &[ElementNode],
        subtree: &Names,
        other_model: bool,
    ) -> Vec<Followers> {
        let mut bound: BTreeSet<(usize, usize)> = BTreeSet::new();
        let mut followed = subtree.clone();
        let mut new: Vec<(&'static str, String)> = listed(subtree.iter().cloned());
        while let Some(object) = new.pop() {
            for &(section, index) in self.by_object.get(&object).map_or(&[][..], Vec::as_slice) {
                if !self.gone.contains(&index) && bound.insert((section, index)) {
                    new.extend(
                        nodes.get(index).and_then(own_name).filter(|name| followed.insert(name.clone())),
                    );
                }
            }
        }
        let free = self.free.iter().filter(|(_, index)| !self.gone.contains(index));
        let all: BTreeSet<(usize, usize)> = filled(bound.iter().chain(free).copied());

        let mut copied = subtree.clone();
        let mut list: Vec<Followers> = listed(SECTIONS.iter().map(|&section| Followers::none(section)));
        if let Some(first) = list.first_mut() {
            first.names.clone_from(subtree);
        }
        for (section, index) in all {
            let (Some(f), Some(node)) = (list.get_mut(section), nodes.get(index)) else { continue };
            if bound.contains(&(section, index)) {
                f.bound.push(index);
            }
            if references::follows(
                f.section,
                &references::list_references(nodes, index),
                &copied,
                other_model,
            ) {
                f.elements.push(index);
                f.names.extend(own_name(node));
                copied.extend(own_name(node));
            } else {
                f.incomplete.push(index);
            }
        }
        list
    }
}

impl Followers {
    fn none(section: &'static str) -> Followers {
        Followers {
            section,
            elements: Vec::new(),
            names: Names::new(),
            bound: Vec::new(),
            incomplete: Vec::new(),
        }
    }
}
