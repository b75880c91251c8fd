//! Converts plain elements to a checked tree: the schema contains every element and attribute, and every value has its type.
//!
//! Unknown names are reported with the most similar known one. Refused elements are left out, with all their children.

use crate::mjcf::gather::listed;
use std::ops::Range;

use super::diagnostic::{Diagnostics, nearest, shorten_name};
use super::values::{self, Value};
use super::xml::XmlElement as Xml;
use crate::mjcf::MAX_DEPTH;
use crate::mjcf::rules;
use crate::mjcf::schema::{Attr, Element, INCLUDE, ROOT, Status, parents_of};

/// An attribute of an element.
#[derive(Clone, Debug)]
pub(crate) struct Attribute {
    pub(crate) attr: &'static Attr,
    pub(crate) value: Value,
    /// Bytes of the value, without quotes.
    pub(crate) span: Range<usize>,
}

/// An element.
#[derive(Clone, Debug)]
pub(crate) struct ElementNode {
    pub(crate) element: &'static Element,
    /// The model that contains the element: 0 for the main model, others are attached.
    pub(crate) model: usize,
    pub(crate) parent: Option<usize>,
    /// Bytes of the name in the start tag.
    pub(crate) span: Range<usize>,
    pub(crate) attributes: Vec<Attribute>,
    pub(crate) children: Vec<usize>,
}

impl ElementNode {
    /// The attribute of this name.
    pub(crate) fn attribute(&self, name: &str) -> Option<&Attribute> {
        #[cfg(test)]
        super::seen::note(self.element, name);
        self.attributes.iter().find(|a| a.attr.name == name)
    }

    /// The text of an attribute; `None` when it is absent or empty.
    pub(crate) fn text(&self, name: &str) -> Option<&str> {
        match &self.attribute(name)?.value {
            Value::Text(text) if !text.is_empty() => Some(text),
            _ => None,
        }
    }

    /// The number of an attribute's keyword.
    pub(crate) fn keyword(&self, name: &str) -> Option<i32> {
        match &self.attribute(name)?.value {
            Value::Keyword(word) => Some(*word),
            _ => None,
        }
    }

    /// The integer of an attribute.
    pub(crate) fn int(&self, name: &str) -> Option<i32> {
        match &self.attribute(name)?.value {
            Value::Ints(list) => list.first().copied(),
            _ => None,
        }
    }

    /// The numbers of an attribute with exactly `N` numbers.
    pub(crate) fn reals<const N: usize>(&self, name: &str) -> Option<[f64; N]> {
        match &self.attribute(name)?.value {
            Value::Reals(list) => list.as_slice().try_into().ok(),
            _ => None,
        }
    }

    /// A description of the element for messages: its tag, and its name if it has one.
    pub(crate) fn describe(&self) -> String {
        match self.text("name") {
            Some(name) => format!("{} {}", self.element.name, shorten_name(name)),
            None => self.element.name.to_string(),
        }
    }
}

/// All elements in document order; the first is the root.
#[derive(Debug, Default)]
pub(crate) struct ElementTree {
    pub(crate) nodes: Vec<ElementNode>,
}

impl ElementTree {
    /// The elements of this name directly below a node, with their indices.
    pub(crate) fn children(&self, parent: usize) -> impl Iterator<Item = (usize, &ElementNode)> {
        let list = self.nodes.get(parent).map_or(&[][..], |n| &n.children);
        list.iter().filter_map(|&i| self.nodes.get(i).map(|n| (i, n)))
    }

    /// All sections of this name. A section such as `worldbody` may occur several times.
    pub(crate) fn sections<'t>(&'t self, name: &'t str) -> impl Iterator<Item = (usize, &'t ElementNode)> {
        self.children(0).filter(move |(_, n)| n.element.name == name)
    }
}

/// Checks the elements of a model. `None` if the text is not a model.
pub(crate) fn check_tree(list: &[Xml], root: usize, report: &mut Diagnostics) -> Option<ElementTree> {
    let name = list.get(root).map_or("", |r| r.name.as_str());
    if name != ROOT.name {
        let span = list.get(root).map_or(0..0, |r| r.span.clone());
        report
            .error(
                rules::UNKNOWN_ELEMENT,
                span,
                format!("the root element is {}, not `mujoco`", shorten_name(name)),
            )
            .help("write a model as `<mujoco> … </mujoco>`");
        return None;
    }

    let mut tree = ElementTree::default();
    let mut stack = vec![(root, &ROOT, None, 1)];
    while let Some((item, element, parent, depth)) = stack.pop() {
        let Some(xml) = list.get(item) else { continue };
        if report.is_full() {
            return None;
        }
        if depth > MAX_DEPTH {
            report.error(
                rules::LIMIT,
                xml.span.clone(),
                format!("elements are nested more than {MAX_DEPTH} deep"),
            );
            return None;
        }
        let index = tree.nodes.len();
        if let Some(node) = parent.and_then(|p: usize| tree.nodes.get_mut(p)) {
            node.children.push(index);
        }
        let attributes = attributes(xml, element, report);
        let span = xml.span.clone();
        tree.nodes.push(ElementNode { element, model: 0, parent, span, attributes, children: Vec::new() });

        let below = children(list, xml, element, report);
        stack.extend(below.into_iter().rev().map(|(x, e)| (x, e, Some(index), depth + 1)));
    }
    Some(tree)
}

/// The children of an element. Those of included files replace their `include`.
fn content<'x>(list: &'x [Xml], xml: &'x Xml, report: &mut Diagnostics) -> Vec<(usize, &'x Xml)> {
    let mut content = Vec::new();
    let mut stack: Vec<usize> = listed(xml.children.iter().rev().copied());
    while let Some(index) = stack.pop() {
        let Some(child) = list.get(index) else { continue };
        if child.name == INCLUDE.name {
            attributes(child, &INCLUDE, report);
            stack.extend(child.children.iter().rev());
        } else {
            content.push((index, child));
        }
    }
    content
}

/// The child elements that the schema contains and accepts.
fn children(
    list: &[Xml],
    xml: &Xml,
    element: &'static Element,
    report: &mut Diagnostics,
) -> Vec<(usize, &'static Element)> {
    let mut known_children: Vec<(usize, &'static Element)> = Vec::new();
    let mut seen: Vec<&'static str> = Vec::new();
    for (index, child) in content(list, xml, report) {
        if report.is_full() {
            break;
        }
        let name = child.name.as_str();
        let span = child.span.clone();
        if child.namespace {
            report.error(
                rules::UNKNOWN_ELEMENT,
                span,
                format!("the element {} is in an XML namespace", shorten_name(name)),
            );
            continue;
        }
        let Some(known_child) = element.child(name) else {
            unknown_element(name, span, element, report);
            continue;
        };
        if known_child.status == Status::Unsupported {
            report.incomplete = true;
            report
                .error(rules::NOT_SUPPORTED, span, format!("`{name}` is not supported yet"))
                .why("ignoring it silently would change what the model computes");
            continue;
        }
        if known_child.once && seen.contains(&known_child.name) {
            report
                .error(rules::REPEATED_ELEMENT, span, format!("`{}` has a second `{name}`", element.name))
                .help("merge its attributes into the first");
            continue;
        }
        if known_child.once {
            seen.push(known_child.name);
        }
        known_children.push((index, known_child));
    }
    known_children
}

fn unknown_element(name: &str, span: Range<usize>, element: &'static Element, report: &mut Diagnostics) {
    report.incomplete = true;
    let places = parents_of(name);
    if !places.is_empty() {
        let list: Vec<_> = listed(places.iter().map(|p| format!("`{p}`")));
        report
            .error(rules::MISPLACED_ELEMENT, span, format!("`{name}` is not allowed in `{}`", element.name))
            .help(format!("move it into {}", list.join(" or ")));
        return;
    }
    let error = report.error(
        rules::UNKNOWN_ELEMENT,
        span,
        format!("MJCF has no element {} in `{}`", shorten_name(name), element.name),
    );
    if let Some(near) = nearest(name, element.children.iter().map(|c| c.name)) {
        error.help(format!("did you mean `{near}`?"));
    }
}

/// The attributes that the schema contains, with their parsed values.
fn attributes(xml: &Xml, element: &'static Element, report: &mut Diagnostics) -> Vec<Attribute> {
    let mut list = Vec::new();
    // The refused attributes, and whether a keyword is refused already. The `fromto` of a refused capsule needs no separate
    // finding.
    let (mut refused, mut refused_word) = (Vec::new(), false);
    for a in &xml.attributes {
        let Some(attr) = element.attribute(&a.name).filter(|_| !a.namespace) else {
            // A misspelt attribute is read as the intended one, so that nothing else is reported as missing.
            if let Some(attr) = unknown_attribute(xml, &a.name, a.name_span.clone(), element, report)
                && let Ok(value) = values::parse(attr.kind, &a.value)
            {
                list.push(Attribute { attr, value, span: a.value_span.clone() });
            }
            continue;
        };
        let span = a.value_span.clone();
        if a.value.trim().is_empty() && attr.kind.counts() && !needs_number(element.name, attr.name) {
            let message = format!("`{}` of {} is empty, so it has no effect", attr.name, element.name);
            report.warning(rules::NO_EFFECT, span.clone(), message).help("write its numbers, or remove it");
            if counts_when_empty(element.name, attr.name) {
                list.push(Attribute { attr, value: Value::Bad, span });
            }
            continue;
        }
        let value = match (attr.status, values::parse(attr.kind, &a.value)) {
            (Status::Unsupported, _) => {
                refused.push((attr.name, a.name_span.clone()));
                Value::Bad
            }
            (_, Err(p)) => {
                refused_word |= p.code == rules::NOT_SUPPORTED;
                // The position inside the value is known only if the value contains no character references.
                let place = match p.span {
                    Some(range) if a.exact => span.start + range.start..span.start + range.end,
                    _ => span.clone(),
                };
                let error =
                    report.error(p.code, place, format!("`{}` of {} {}", attr.name, element.name, p.message));
                if let Some(help) = p.help {
                    error.help(help);
                }
                Value::Bad
            }
            (Status::Only(default), Ok(value)) if !same_as(attr, &value, default) => {
                report
                    .error(
                        rules::NOT_SUPPORTED,
                        span.clone(),
                        format!("`{}` of {} is not supported yet", attr.name, element.name),
                    )
                    .why("ignoring it would change what the model computes")
                    .help(format!("remove it, or write its default, {default:?}"));
                Value::Bad
            }
            (_, Ok(value)) => value,
        };
        list.push(Attribute { attr, value, span });
    }
    exclusive(&list, element, report);
    for (name, span) in refused.into_iter().filter(|_| !refused_word) {
        report
            .error(rules::NOT_SUPPORTED, span, format!("`{name}` of {} is not supported yet", element.name))
            .why("ignoring it would change what the model computes");
    }
    list
}

/// The attributes with an integer that MuJoCo cannot read from an empty text.
fn needs_number(element: &str, attribute: &str) -> bool {
    matches!(
        (element, attribute),
        ("size", "njmax" | "nconmax" | "nstack")
            | ("freejoint", "group")
            | ("contact", "num")
            | ("mesh", "maxhullvert")
    )
}

/// Attributes that count as present for the check of exclusive attributes, although they are empty.
fn counts_when_empty(element: &str, attribute: &str) -> bool {
    attribute == "quat"
        || (element == "inertial" && crate::mjcf::schema::is_form(attribute))
        || matches!((element, attribute), ("connect" | "weld", "anchor" | "relpose"))
        || EXCLUSIVE.iter().any(|(name, pair)| *name == element && pair.contains(&attribute))
}

/// Pairs of attributes that exclude each other. MuJoCo's schema checks the element itself, not its class. (Exclusive attributes
/// that name the target of a sensor, a mesh or an equality are checked where these are read.)
const EXCLUSIVE: [(&str, [&str; 2]); 4] = [
    ("camera", ["fovy", "sensorsize"]),
    ("light", ["directional", "type"]),
    ("size", ["memory", "njmax"]),
    ("size", ["memory", "nstack"]),
];

fn exclusive(list: &[Attribute], element: &Element, report: &mut Diagnostics) {
    let find = |name: &str| list.iter().find(|a| a.attr.name == name);
    for (_, [first, second]) in EXCLUSIVE.iter().filter(|(name, _)| *name == element.name) {
        if let (Some(_), Some(other)) = (find(first), find(second)) {
            let message = format!("{} has both `{first}` and `{second}`", element.name);
            report
                .error(rules::CONFLICT, other.span.clone(), message)
                .why("both set the same value, and MuJoCo refuses a model with both")
                .help("keep one of them");
        }
    }
}

/// Whether a value equals the default. For a list, the given numbers are compared.
fn same_as(attr: &Attr, value: &Value, default: &str) -> bool {
    let equal = |a: &[f64], b: &[f64]| a.iter().zip(b).all(|(x, y)| x == y);
    match (value, values::parse(attr.kind, default)) {
        (Value::Reals(a), Ok(Value::Reals(b))) => equal(a, &b),
        (a, Ok(b)) => *a == b,
        (_, Err(_)) => false,
    }
}

/// Reports an unknown attribute; returns the one that is probably meant, unless the element has it.
fn unknown_attribute(
    xml: &Xml,
    name: &str,
    span: Range<usize>,
    element: &'static Element,
    report: &mut Diagnostics,
) -> Option<&'static Attr> {
    let message = format!("{} has no attribute {}", element.name, shorten_name(name));
    let error = report.error(rules::UNKNOWN_ATTRIBUTE, span, message);
    let near = nearest(name, element.attributes().map(|a| a.name));
    if let Some(near) = near {
        error.help(format!("did you mean `{near}`?"));
    } else if element.attributes().next().is_none() {
        error.help(format!("delete it: `{}` takes no attributes", element.name));
    }
    let is_given = |attr: &&Attr| xml.attributes.iter().any(|other| other.name == attr.name);
    element.attribute(near?).filter(|attr| !is_given(attr))
}

/// The name of an element, empty if it has none.
pub(crate) fn name(node: &ElementNode) -> String {
    node.text("name").unwrap_or("").to_string()
}
