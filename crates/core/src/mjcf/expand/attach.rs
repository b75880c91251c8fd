//! `attach`: a copy, with a prefix, of a part of another model, or of a body or frame of the same model.

use super::copy::{self, Rename};
use super::references::Names;
use super::{Child, Expander};
use crate::mjcf::gather::{filled, listed};
use crate::mjcf::names::WORLD;
use crate::mjcf::rules;
use crate::mjcf::schema::{BODY, FRAME};
use crate::mjcf::text::diagnostic::{Diagnostics, nearest, shorten_name};
use crate::mjcf::text::tree::{Attribute, ElementNode};
use crate::mjcf::text::values::Value;

impl Expander {
    /// Copies a part of another model, or of this one, with a prefix for its names.
    pub(super) fn attach(&mut self, request: usize, report: &mut Diagnostics) -> Option<()> {
        let node = self.nodes.get(request)?.clone();
        let Some(prefix) = node.attribute("prefix").and(Some(node.text("prefix").unwrap_or(""))) else {
            report
                .error(rules::MISSING_ATTRIBUTE, node.span.clone(), "attach has no `prefix`")
                .why("it comes before every name of the copy, so that names stay unique")
                .help("write `prefix=\"left_\"`");
            return None;
        };
        let part = match (node.text("body"), node.text("frame")) {
            (Some(_), Some(_)) => {
                report
                    .error(rules::CONFLICT, node.span.clone(), "attach has both `body` and `frame`")
                    .help("keep one of them: only one object is attached");
                return None;
            }
            (Some(name), None) => Some(("body", name)),
            (None, Some(name)) => Some(("frame", name)),
            (None, None) => None,
        };
        match node.text("model") {
            Some(model) => {
                // Removed temporarily, so that it can be read while this model is modified.
                let Some((name, mut child)) = self.models.remove_entry(model) else {
                    let span = node.attribute("model").map_or(node.span.clone(), |a| a.span.clone());
                    report_unknown("model", model, self.models.keys().map(String::as_str), span, report);
                    return None;
                };
                let done = self.attach_model(request, &node, prefix, &mut child, part, report);
                self.models.insert(name, child);
                done
            }
            None => self.attach_element(request, &node, prefix, part, report),
        }
    }

    /// Copies a body or frame of this model.
    fn attach_element(
        &mut self,
        request: usize,
        node: &ElementNode,
        prefix: &str,
        part: Option<(&'static str, &str)>,
        report: &mut Diagnostics,
    ) -> Option<()> {
        let Some((kind, name)) = part else {
            report
                .error(rules::MISSING_ATTRIBUTE, node.span.clone(), "attach names neither a model nor a body")
                .help("write `model=\"…\"` for a model of the assets, or `body=\"…\"` for a copy of a body of this model");
            return None;
        };
        let span = node.attribute(kind).map_or(node.span.clone(), |a| a.span.clone());
        let Some(&original) = self.names.get(&(kind, name.to_string())) else {
            let names = self.names.keys().filter(|(k, _)| *k == kind).map(|(_, name)| name.as_str());
            report_unknown(kind, name, names, span, report);
            return None;
        };
        if original > request && original < self.written {
            report
                .error(
                    rules::COPY,
                    span,
                    format!("{kind} {} comes after the `attach` that copies it", shorten_name(name)),
                )
                .help("move the `attach` after it");
            return None;
        }
        if self.contains(original, request) {
            report
                .error(rules::COPY, span, format!("{kind} {} is attached inside itself", shorten_name(name)))
                .why("the copy would contain itself without end");
            return None;
        }
        let rename = Rename { prefix, suffix: "", other_model: None };
        let subtree = copy::names(&self.nodes, original);
        let mut followers = self.uses.followers(&self.nodes, &subtree, false);
        let (copy, _) = copy::copy(&self.nodes, original, rename, None);
        let copy = self.append_copy(copy, request)?;
        let class = inherited_class(&self.nodes, original).unwrap_or("main").to_string();
        self.replace_by_frame(request, vec![childclass(node, class)?], vec![copy])?;
        self.follow(&mut followers, rename)
    }

    /// Whether an element is inside another.
    fn contains(&self, outer: usize, inner: usize) -> bool {
        let mut up = Some(inner);
        while let Some(index) = up {
            if index == outer {
                return true;
            }
            up = self.nodes.get(index).and_then(|n| n.parent);
        }
        false
    }

    /// Copies a body, a frame or all of another model, with its assets and classes.
    fn attach_model(
        &mut self,
        request: usize,
        node: &ElementNode,
        prefix: &str,
        child: &mut Child,
        part: Option<(&'static str, &str)>,
        report: &mut Diagnostics,
    ) -> Option<()> {
        let offset = *child.offset.get_or_insert(self.parts.len());
        if offset == self.parts.len() {
            self.parts.extend(child.model.parts.iter().cloned());
        }
        let nodes = &child.model.tree.nodes;
        let rename = Rename { prefix, suffix: "", other_model: Some(offset) };
        let roots = roots_to_attach(child, node, part, report)?;
        let mut subtree: Names = filled(roots.iter().flat_map(|&root| copy::names(nodes, root)));

        let class = match roots.as_slice() {
            [root] if part.is_some() => inherited_class(nodes, *root).map(|class| rename.class(class)),
            _ => None,
        };
        let class = childclass(node, class.unwrap_or(rename.main_class()))?;
        if part == Some(("body", WORLD)) {
            subtree.insert(("body", WORLD.to_string()));
            let holder = self.append_copy(vec![world_body(node, rename, offset)?], request)?;
            let inside = self.copy_roots(nodes, &roots, rename, holder)?;
            self.nodes.get_mut(holder)?.children = inside;
            self.replace_by_frame(request, vec![class], vec![holder])?;
        } else {
            let inside = self.copy_roots(nodes, &roots, rename, request)?;
            self.replace_by_frame(request, vec![class], inside)?;
        }
        self.copy_dependencies(nodes, rename, node)?;
        for f in child.uses.followers(nodes, &subtree, true) {
            subtree.extend(f.names);
            for index in f.elements {
                let (mut copy, _) = copy::copy(nodes, index, rename, Some(&subtree));
                add_main_class(&mut copy, rename, node);
                self.append(f.section, copy)?;
            }
        }
        Some(())
    }

    /// Copies elements of another model into an element of this one.
    fn copy_roots(
        &mut self,
        nodes: &[ElementNode],
        roots: &[usize],
        rename: Rename,
        holder: usize,
    ) -> Option<Vec<usize>> {
        let mut inside = Vec::new();
        for &root in roots {
            let (copy, _) = copy::copy(nodes, root, rename, None);
            inside.push(self.append_copy(copy, holder)?);
        }
        Some(inside)
    }

    /// Copies the elements of another model that are copied for every attached part.
    fn copy_dependencies(
        &mut self,
        nodes: &[ElementNode],
        rename: Rename,
        request: &ElementNode,
    ) -> Option<()> {
        for (section, index) in dependencies(nodes) {
            let (mut copy, _) = copy::copy(nodes, index, rename, None);
            add_main_class(&mut copy, rename, request);
            if section == "default" {
                let root = self.append_copy(copy, 0)?;
                self.nodes.first_mut()?.children.push(root);
            } else {
                self.append(section, copy)?;
            }
        }
        Some(())
    }
}

/// The elements of another model that are attached. `None`, with an error in the report, if a name is unknown.
fn roots_to_attach(
    child: &Child,
    request: &ElementNode,
    part: Option<(&'static str, &str)>,
    report: &mut Diagnostics,
) -> Option<Vec<usize>> {
    let (kind, name) = match part {
        None | Some(("body", WORLD)) => return Some(members(&child.model.tree.nodes, "worldbody")),
        Some(part) => part,
    };
    let Some(&root) = child.names.get(&(kind, name.to_string())) else {
        let span = request.attribute(kind).map_or(request.span.clone(), |a| a.span.clone());
        let names = child.names.keys().filter(|(k, _)| *k == kind).map(|(_, name)| name.as_str());
        report_unknown(kind, name, names, span, report);
        return None;
    };
    Some(vec![root])
}

/// The body that replaces the world of another model.
fn world_body(request: &ElementNode, rename: Rename, model: usize) -> Option<ElementNode> {
    let name = Attribute {
        attr: BODY.attribute("name")?,
        value: Value::Text(rename.name(WORLD)),
        span: request.span.clone(),
    };
    Some(ElementNode {
        element: &BODY,
        model,
        attributes: vec![name],
        children: Vec::new(),
        parent: None,
        ..request.clone()
    })
}

/// The class of elements at this position that have no class attribute, or `None` for the main class. A copy keeps this class.
fn inherited_class(nodes: &[ElementNode], index: usize) -> Option<&str> {
    let mut up = nodes.get(index)?.parent;
    while let Some(node) = up.and_then(|index| nodes.get(index)) {
        if let Some(class) = node.text("childclass") {
            return Some(class);
        }
        up = node.parent;
    }
    None
}

/// The attribute with the class of the contents of a copy.
fn childclass(request: &ElementNode, class: String) -> Option<Attribute> {
    let attr = FRAME.attribute("childclass")?;
    Some(Attribute { attr, value: Value::Text(class), span: request.span.clone() })
}

/// Reports an unknown name.
fn report_unknown<'n>(
    kind: &str,
    name: &str,
    names: impl Iterator<Item = &'n str>,
    span: std::ops::Range<usize>,
    report: &mut Diagnostics,
) {
    let error = report.error(
        rules::UNKNOWN_NAME,
        span,
        format!("there is no {kind} named {} to attach", shorten_name(name)),
    );
    if let Some(near) = nearest(name, names) {
        error.help(format!("did you mean `{near}`?"));
    }
}

/// An element of another model without a class gets the main class of that model.
fn add_main_class(copy: &mut [ElementNode], rename: Rename, request: &ElementNode) {
    let Some(node) = copy.first_mut() else { return };
    let without =
        node.attribute("class").is_none() || node.element.name == "default" && node.text("class").is_none();
    if let Some(attr) = node.element.attribute("class").filter(|_| without) {
        let value = Value::Text(rename.main_class());
        node.attributes.push(Attribute { attr, value, span: request.span.clone() });
    }
}

/// The elements that are copied for every attached part of another model: all classes and assets, numbers and texts.
fn dependencies(nodes: &[ElementNode]) -> Vec<(&'static str, usize)> {
    let mut list: Vec<_> = Vec::new();
    for &index in nodes.first().map_or(&[][..], |root| &root.children) {
        let Some(section) = nodes.get(index) else { continue };
        match section.element.name {
            "default" => list.push(("default", index)),
            name @ ("asset" | "custom" | "deformable") => {
                let travels = |c: &usize| match nodes.get(*c).map_or("", |n| n.element.name) {
                    "model" => false,
                    "tuple" => false, // a tuple is copied with its objects
                    _ => true,
                };
                list.extend(section.children.iter().copied().filter(travels).map(|c| (name, c)));
            }
            _ => {}
        }
    }
    list
}

/// The elements of all sections of a name.
fn members(nodes: &[ElementNode], section: &str) -> Vec<usize> {
    let sections = nodes.first().map_or(&[][..], |root| &root.children);
    let sections = sections.iter().filter_map(|&s| nodes.get(s)).filter(|s| s.element.name == section);
    listed(sections.flat_map(|s| s.children.iter().copied()))
}
