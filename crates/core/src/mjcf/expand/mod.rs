//! Expands `replicate` and `attach`, copies of parts of a model, before any other pass reads the tree.
//!
//! A copy is placed in a `frame` that replaces the requesting element. Elements that refer to the copied objects, such as sensors
//! and tendons, are copied too and appended to their section, as in MuJoCo 3.14.0 (XML reference, `replicate` and `attach`; rules
//! for names and order measured on the library).
//!
//! Requests are expanded in the order of the text, inner ones first, so that copies can contain copies.

mod attach;
mod copy;
mod followers;
pub(crate) mod references;

use crate::mjcf::gather::{filled, listed};
use std::collections::BTreeMap;

use super::MAX_ELEMENTS;
use super::schema::{FRAME, ROOT};
use super::settings::CompilerSettings;
use crate::math::{Vec3, add, rotate};
use crate::mjcf::body::orientation;
use crate::mjcf::keyword_map::KeywordMap;
use crate::mjcf::rules;
use crate::mjcf::text::diagnostic::Diagnostics;
use crate::mjcf::text::load::UnexpandedModel;
use crate::mjcf::text::tree::{Attribute, ElementNode, ElementTree};
use crate::mjcf::text::values::Value;
use copy::Rename;
use followers::{Followers, Uses};
use references::Names;

/// Limit for the bytes of all copies. Without it, a small text could request any amount.
const MAX_COPIED: usize = 200 << 20;

/// A model that is part of the whole: the main model, or an attached one.
#[derive(Clone, Debug)]
pub(crate) struct AttachedModel {
    /// The compiler settings that determine the meaning of its angles, ranges and inertias.
    pub(crate) compiler: CompilerSettings,
    /// The folder of its files.
    pub(crate) folder: String,
}

/// A model after the expansion of `replicate` and `attach`.
#[derive(Debug)]
pub(crate) struct Expanded {
    pub(crate) tree: ElementTree,
    /// The models, indexed by [`ElementNode::model`].
    pub(crate) parts: Vec<AttachedModel>,
}

/// Expands all requests of a model.
pub(crate) fn model(written: UnexpandedModel, report: &mut Diagnostics) -> Expanded {
    let compiler = CompilerSettings::read(&written.tree, report);
    let child = |(name, written)| (name, Child::new(model(written, report)));
    let models = filled(written.models.into_iter().map(child));
    let nodes = written.tree.nodes;
    let mut e = Expander {
        uses: Uses::build_index(&nodes),
        written: nodes.len(),
        nodes,
        bytes: 0,
        sections: KeywordMap::default(),
        names: BTreeMap::new(),
        parts: vec![AttachedModel { compiler, folder: written.folder }],
        models,
    };
    for request in e.build_index() {
        if report.is_full() {
            break;
        }
        let done = match e.nodes.get(request).map(|n| n.element.name) {
            Some("replicate") => e.replicate(request, report),
            _ => e.attach(request, report),
        };
        if done.is_none() {
            // A request that failed has no contents, and names that it would define are missing.
            report.incomplete = true;
            e.replace_by_frame(request, Vec::new(), Vec::new());
        }
        if e.is_too_large() {
            let span = e.nodes.get(request).map_or(0..0, |n| n.span.clone());
            report
                .error(rules::LIMIT, span, "there are too many copies, or they are too large")
                .why(format!("a model can have {MAX_ELEMENTS} elements, including copies"))
                .help("lower `count`, also in the elements around it");
            break;
        }
    }
    e.finish()
}

/// A model that can be attached.
#[derive(Debug)]
struct Child {
    model: Expanded,
    uses: Uses,
    names: BTreeMap<(&'static str, String), usize>,
    /// The index of its first part among the parts of the whole, after it is attached.
    offset: Option<usize>,
}

impl Child {
    fn new(model: Expanded) -> Child {
        let nodes = &model.tree.nodes;
        let uses = Uses::build_index(nodes);
        let names = filled(nodes.iter().enumerate().filter_map(|(index, node)| Some((target(node)?, index))));
        Child { model, uses, names, offset: None }
    }
}

struct Expander {
    /// All elements, including patterns of copies. Only elements that are reachable from the root belong to the result.
    nodes: Vec<ElementNode>,
    uses: Uses,
    /// The bytes of all copies.
    bytes: usize,
    /// The number of elements in the text. Later elements are copies.
    written: usize,
    /// The last section of each name.
    sections: KeywordMap<usize>,
    /// Bodies and frames by name.
    names: BTreeMap<(&'static str, String), usize>,
    parts: Vec<AttachedModel>,
    models: BTreeMap<String, Child>,
}

impl Expander {
    /// Indexes the sections and names, and returns the requests in order.
    fn build_index(&mut self) -> Vec<usize> {
        let mut requests = Vec::new();
        for &section in self.nodes.first().map_or(&[][..], |root| &root.children) {
            if let Some(node) = self.nodes.get(section) {
                self.sections.insert(node.element.name, section);
            }
        }
        // Inner requests come first: an element is finished after all its descendants.
        let mut stack: Vec<(usize, bool)> = vec![(0, false)];
        while let Some((index, left)) = stack.pop() {
            let Some(node) = self.nodes.get(index) else { continue };
            if left {
                if matches!(node.element.name, "replicate" | "attach") {
                    requests.push(index);
                }
            } else {
                self.names.extend(target(node).map(|key| (key, index)));
                stack.push((index, true));
                stack.extend(node.children.iter().rev().map(|&c| (c, false)));
            }
        }
        requests
    }

    fn is_too_large(&self) -> bool {
        self.nodes.len() > MAX_ELEMENTS || self.bytes > MAX_COPIED
    }

    /// Appends a copy to the list and returns its index. `None` if a limit is exceeded.
    fn append_copy(&mut self, copy: Vec<ElementNode>, parent: usize) -> Option<usize> {
        let base = self.nodes.len();
        for mut node in copy {
            node.parent = Some(node.parent.map_or(parent, |p| base + p));
            node.children.iter_mut().for_each(|c| *c += base);
            self.bytes += weight(&node);
            self.names.extend(target(&node).map(|key| (key, self.nodes.len())));
            self.nodes.push(node);
        }
        if self.is_too_large() { None } else { Some(base) }
    }

    /// Replaces a request by a frame with these attributes and children.
    fn replace_by_frame(
        &mut self,
        request: usize,
        attributes: Vec<Attribute>,
        children: Vec<usize>,
    ) -> Option<()> {
        let node = self.nodes.get_mut(request)?;
        node.element = &FRAME;
        node.attributes = attributes;
        node.children = children;
        Some(())
    }

    /// Appends an element to a section.
    fn append(&mut self, section: &'static str, copy: Vec<ElementNode>) -> Option<usize> {
        let index = match self.sections.get(section) {
            Some(&index) => index,
            None => {
                let element = ROOT.child(section)?;
                let span = self.nodes.first()?.span.clone();
                let node = ElementNode {
                    element,
                    model: 0,
                    parent: Some(0),
                    span,
                    attributes: Vec::new(),
                    children: Vec::new(),
                };
                let index = self.append_copy(vec![node], 0)?;
                self.nodes.first_mut()?.children.push(index);
                self.sections.insert(element.name, index);
                index
            }
        };
        let copy = self.append_copy(copy, index)?;
        self.nodes.get_mut(index)?.children.push(copy);
        self.uses.add(section, &self.nodes, copy);
        Some(copy)
    }

    /// Makes `count` copies in consecutive frames. The original is only their pattern.
    fn replicate(&mut self, request: usize, report: &mut Diagnostics) -> Option<()> {
        let node = self.nodes.get(request)?.clone();
        let count = count(&node, report)?;
        let digits = count.to_string().len();
        let separator = node.text("sep").unwrap_or("");
        let offset = node.reals("offset").unwrap_or([0.0; 3]);
        let euler: Vec3 = node.reals("euler").unwrap_or([0.0; 3]);
        let compiler = self.parts.get(node.model)?.compiler.clone();
        let subtree = copy::names(&self.nodes, request);
        let mut followers = self.uses.followers(&self.nodes, &subtree, false);
        if count > 0 {
            self.report_unreplicable(&followers, report);
        }
        for name in &subtree {
            self.names.remove(name);
        }

        let (mut frames, mut pos) = (Vec::new(), [0.0; 3]);
        // An element without children has no copies.
        let count = if node.children.is_empty() { 0 } else { count };
        for i in 0..count {
            let suffix = format!("{separator}{i:0digits$}");
            let rename = Rename { prefix: "", suffix: &suffix, other_model: None };
            let quat = orientation::euler(euler.map(|x| f64::from(i) * x), &compiler);
            let attributes = vec![
                written(&node, "pos", Value::Reals(pos.to_vec().into()))?,
                written(&node, "quat", Value::Reals(quat.to_vec().into()))?,
            ];
            pos = add(pos, rotate(offset, quat));

            let frame = ElementNode { element: &FRAME, attributes, children: Vec::new(), ..node.clone() };
            let frame = self.append_copy(vec![ElementNode { parent: None, ..frame }], request)?;
            for &child in &node.children {
                let (copy, _) = copy::copy(&self.nodes, child, rename, None);
                let copy = self.append_copy(copy, frame)?;
                self.nodes.get_mut(frame)?.children.push(copy);
            }
            frames.push(frame);
            self.follow(&mut followers, rename)?;
        }
        self.replace_by_frame(request, listed(node.attribute("childclass").cloned()), frames)?;
        // Elements that refer to the pattern are removed together with it.
        self.uses.remove(followers.into_iter().flat_map(|f| f.bound));
        Some(())
    }

    /// Reports elements that cannot be replicated.
    fn report_unreplicable(&self, followers: &[Followers], report: &mut Diagnostics) {
        for node in followers.iter().flat_map(|f| &f.incomplete).filter_map(|&index| self.nodes.get(index)) {
            report
                .error(
                    rules::COPY,
                    node.span.clone(),
                    format!("{} connects a replicated object to one that is not replicated", node.describe()),
                )
                .why("MuJoCo copies it only if all its objects are copied, and otherwise drops it silently")
                .help("write the copies out instead of using `replicate`");
        }
    }

    /// Makes one copy of each follower.
    fn follow(&mut self, followers: &mut [Followers], rename: Rename) -> Option<()> {
        let mut copied = Names::new();
        for f in followers {
            copied.extend(f.names.iter().cloned());
            for i in 0..f.elements.len() {
                let index = *f.elements.get(i)?;
                let (copy, _) = copy::copy(&self.nodes, index, rename, Some(&copied));
                let new = self.append(f.section, copy)?;
                // A copy without references is itself copied by the next iteration.
                if references::list_references(&self.nodes, new).is_empty() {
                    f.elements.push(new);
                }
            }
        }
        Some(())
    }

    /// Returns the expanded model, with its elements in the order of the text.
    fn finish(mut self) -> Expanded {
        for section in self.nodes.first().map_or(Vec::new(), |root| root.children.clone()) {
            if let Some(section) = self.nodes.get_mut(section) {
                section.children.retain(|&index| !self.uses.is_removed(index));
            }
        }
        Expanded { tree: ElementTree { nodes: in_order(&self.nodes) }, parts: self.parts }
    }
}

/// The number of copies.
fn count(node: &ElementNode, report: &mut Diagnostics) -> Option<i32> {
    let Some(attribute) = node.attribute("count") else {
        report
            .error(rules::MISSING_ATTRIBUTE, node.span.clone(), "replicate has no `count`")
            .help("write the number of copies, `count=\"5\"`");
        return None;
    };
    let count = node.int("count")?;
    if count < 0 {
        let message = format!("`count` of replicate is {count}, but it must be zero or more");
        report.error(rules::VALUE, attribute.span.clone(), message);
        return None;
    }
    Some(count)
}

/// The kind and name of an element that `attach` can refer to.
fn target(node: &ElementNode) -> Option<(&'static str, String)> {
    let kind = ["body", "frame"].into_iter().find(|kind| *kind == node.element.name)?;
    Some((kind, node.text("name")?.to_string()))
}

/// An attribute of a frame, with the span of the request.
fn written(request: &ElementNode, name: &str, value: Value) -> Option<Attribute> {
    Some(Attribute { attr: FRAME.attribute(name)?, value, span: request.span.clone() })
}

/// The approximate size of an element, bytes.
fn weight(node: &ElementNode) -> usize {
    let value = |a: &Attribute| match &a.value {
        Value::Text(text) => text.len(),
        // Lists of numbers are shared.
        _ => 0,
    };
    128 + node.attributes.iter().map(|a| 80 + value(a)).sum::<usize>()
}

/// All elements that are reachable from the root, in the order of the text.
fn in_order(nodes: &[ElementNode]) -> Vec<ElementNode> {
    let rename = Rename { prefix: "", suffix: "", other_model: None };
    copy::copy(nodes, 0, rename, None).0
}
