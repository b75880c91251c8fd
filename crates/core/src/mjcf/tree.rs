//! XML to a checked tree: every element and attribute known to the schema, every value of its type.
//!
//! Unknown names are reported with the nearest known one; what is refused is left out, with all it holds.

use std::ops::Range;

use roxmltree::{Document, Error, ParsingOptions};

use super::diagnostic::{Report, closest, code, shown};
use super::schema::{Attr, Element, ROOT, Status, parents_of};
use super::values::{self, Value};

/// An attribute of an element.
#[derive(Debug)]
pub(crate) struct Attribute {
    pub(crate) attr: &'static Attr,
    pub(crate) value: Value,
    /// Bytes of the value, without quotes.
    pub(crate) span: Range<usize>,
}

/// An element.
#[derive(Debug)]
pub(crate) struct Node {
    pub(crate) element: &'static Element,
    pub(crate) parent: Option<usize>,
    /// Bytes of the name in the start tag.
    pub(crate) span: Range<usize>,
    pub(crate) attributes: Vec<Attribute>,
    pub(crate) children: Vec<usize>,
}

impl Node {
    /// The attribute of this name.
    pub(crate) fn attribute(&self, name: &str) -> Option<&Attribute> {
        self.attributes.iter().find(|a| a.attr.name == name)
    }

    /// The text of an attribute; `None` when it is absent or empty.
    pub(crate) fn text(&self, name: &str) -> Option<&str> {
        match &self.attribute(name)?.value {
            Value::Text(text) if !text.is_empty() => Some(text),
            _ => None,
        }
    }

    /// The element in a message: its name in the XML, and its own name if it has one.
    pub(crate) fn shown(&self) -> String {
        match self.text("name") {
            Some(name) => format!("{} {}", self.element.name, shown(name)),
            None => self.element.name.to_string(),
        }
    }
}

/// All elements in document order; the first is the root.
#[derive(Debug, Default)]
pub(crate) struct Tree {
    pub(crate) nodes: Vec<Node>,
}

impl Tree {
    /// The elements of this name directly below a node, with their indices.
    pub(crate) fn children(&self, of: usize) -> impl Iterator<Item = (usize, &Node)> {
        let list = self.nodes.get(of).map_or(&[][..], |n| &n.children);
        list.iter().filter_map(|&i| self.nodes.get(i).map(|n| (i, n)))
    }

    /// The elements of all sections of this name (`worldbody` may stand several times).
    pub(crate) fn sections<'t>(&'t self, name: &'t str) -> impl Iterator<Item = (usize, &'t Node)> {
        self.children(0).filter(move |(_, n)| n.element.name == name)
    }
}

/// Parses and checks a text; `None` when it is not XML or not a model at all.
pub(crate) fn parse(text: &str, report: &mut Report) -> Option<Tree> {
    let options = ParsingOptions { allow_dtd: false, ..ParsingOptions::default() };
    let document = match Document::parse_with_options(text, options) {
        Ok(document) => document,
        Err(error) => {
            explain(text, &error, report);
            return None;
        }
    };
    let root = document.root_element();
    if root.tag_name().name() != ROOT.name {
        let found = shown(root.tag_name().name());
        report
            .error(
                code::UNKNOWN_ELEMENT,
                name_span(&root),
                format!("the root element is {found}, not `mujoco`"),
            )
            .help("a model is written as `<mujoco> … </mujoco>`");
        return None;
    }

    let mut tree = Tree::default();
    let mut stack = vec![(root, &ROOT, None)];
    while let Some((xml, element, parent)) = stack.pop() {
        if report.is_full() {
            return None;
        }
        let index = tree.nodes.len();
        if let Some(node) = parent.and_then(|p: usize| tree.nodes.get_mut(p)) {
            node.children.push(index);
        }
        let attributes = attributes(text, &xml, element, report);
        tree.nodes.push(Node { element, parent, span: name_span(&xml), attributes, children: Vec::new() });

        let below: Vec<_> =
            children(&xml, element, report).into_iter().map(|(x, e)| (x, e, Some(index))).collect();
        stack.extend(below.into_iter().rev());
    }
    Some(tree)
}

type Xml<'a, 'i> = roxmltree::Node<'a, 'i>;

/// Bytes of the name in the start tag.
fn name_span(xml: &Xml) -> Range<usize> {
    let start = xml.range().start + 1;
    start..start + xml.tag_name().name().len()
}

/// The child elements that the schema knows and accepts.
fn children<'a, 'i>(
    xml: &Xml<'a, 'i>,
    element: &'static Element,
    report: &mut Report,
) -> Vec<(Xml<'a, 'i>, &'static Element)> {
    let mut list: Vec<(Xml<'a, 'i>, &'static Element)> = Vec::new();
    let mut seen: Vec<&'static str> = Vec::new();
    for child in xml.children() {
        if child.is_text() {
            stray_text(&child, element, report);
        }
        if report.is_full() {
            break;
        }
        if !child.is_element() {
            continue;
        }
        let name = child.tag_name().name();
        let span = name_span(&child);
        if child.tag_name().namespace().is_some() {
            report.error(
                code::UNKNOWN_ELEMENT,
                span,
                format!("the element {} is in an XML namespace", shown(name)),
            );
            continue;
        }
        let Some(known) = element.child(name) else {
            unknown_element(name, span, element, report);
            continue;
        };
        if known.status == Status::Unsupported {
            report.incomplete = true;
            report
                .error(code::NOT_SUPPORTED, span, format!("`{name}` is not supported yet"))
                .why("leaving it out silently would change what the model computes");
            continue;
        }
        if known.once && seen.contains(&known.name) {
            report
                .error(
                    code::REPEATED_ELEMENT,
                    span,
                    format!("a second `{name}` in the same `{}`", element.name),
                )
                .help("merge its attributes into the first");
            continue;
        }
        if known.once {
            seen.push(known.name);
        }
        list.push((child, known));
    }
    list
}

/// Text between elements means nothing and is passed over, unless it looks like a tag without its `<`.
fn stray_text(xml: &Xml, element: &Element, report: &mut Report) {
    let text = xml.text().unwrap_or("");
    let Some(first) = text.trim().lines().next() else { return };
    if !text.contains(['=', '>']) {
        return;
    }
    let start = xml.range().start + (text.len() - text.trim_start().len());
    let end = (start + first.trim_end().len()).min(xml.range().end);
    report
        .error(code::TEXT, start..end, format!("text between the elements of `{}`", element.name))
        .why("it looks like a tag, but without its `<` it would be passed over")
        .help("begin the tag with `<`, or write the text as a comment, <!-- … -->");
}

fn unknown_element(name: &str, span: Range<usize>, element: &'static Element, report: &mut Report) {
    report.incomplete = true;
    let places = parents_of(name);
    if !places.is_empty() {
        let list: Vec<_> = places.iter().map(|p| format!("`{p}`")).collect();
        report
            .error(code::MISPLACED_ELEMENT, span, format!("`{name}` cannot stand in `{}`", element.name))
            .help(format!("it belongs into {}", list.join(" or ")));
        return;
    }
    let error = report.error(
        code::UNKNOWN_ELEMENT,
        span,
        format!("there is no element {} in `{}`", shown(name), element.name),
    );
    if let Some(near) = closest(name, element.children.iter().map(|c| c.name)) {
        error.help(format!("did you mean `{near}`?"));
    }
}

/// The attributes that the schema knows, with their values read.
fn attributes(text: &str, xml: &Xml, element: &'static Element, report: &mut Report) -> Vec<Attribute> {
    let mut list = Vec::new();
    // Attributes that are refused, and whether a keyword already is: a capsule's `fromto` needs no finding of
    // its own when the capsule has one.
    let (mut refused, mut refused_word) = (Vec::new(), false);
    for a in xml.attributes() {
        let Some(attr) = element.attribute(a.name()).filter(|_| a.namespace().is_none()) else {
            unknown_attribute(a.name(), a.range_qname(), element, report);
            continue;
        };
        let span = a.range_value();
        let value = match (attr.status, values::parse(attr.kind, a.value())) {
            (Status::Unsupported, _) => {
                refused.push((attr.name, a.range_qname()));
                Value::Bad
            }
            (_, Err(p)) => {
                refused_word |= p.code == code::NOT_SUPPORTED;
                // Inside the value only when the text was not changed by character references.
                let exact = text.get(span.clone()) == Some(a.value());
                let at = match p.at {
                    Some(at) if exact => span.start + at.start..span.start + at.end,
                    _ => span.clone(),
                };
                let error =
                    report.error(p.code, at, format!("`{}` of {} {}", attr.name, element.name, p.message));
                if let Some(help) = p.help {
                    error.help(help);
                }
                Value::Bad
            }
            (Status::Only(default), Ok(value)) if !same_as(attr, &value, default) => {
                report
                    .error(
                        code::NOT_SUPPORTED,
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
    for (name, span) in refused.into_iter().filter(|_| !refused_word) {
        report
            .error(code::NOT_SUPPORTED, span, format!("`{name}` of {} is not supported yet", element.name))
            .why("ignoring it would change what the model computes");
    }
    list
}

/// Whether a value is the default; of a list, whether the numbers that are given are.
fn same_as(attr: &Attr, value: &Value, default: &str) -> bool {
    let equal = |a: &[f64], b: &[f64]| a.iter().zip(b).all(|(x, y)| x == y);
    match (value, values::parse(attr.kind, default)) {
        (Value::Reals(a), Ok(Value::Reals(b))) => equal(a, &b),
        (a, Ok(b)) => *a == b,
        (_, Err(_)) => false,
    }
}

fn unknown_attribute(name: &str, span: Range<usize>, element: &'static Element, report: &mut Report) {
    let message = format!("{} has no attribute {}", element.name, shown(name));
    let error = report.error(code::UNKNOWN_ATTRIBUTE, span, message);
    if let Some(near) = closest(name, element.attributes().map(|a| a.name)) {
        error.help(format!("did you mean `{near}`?"));
    } else if element.attributes().next().is_none() {
        error.help(format!("`{}` takes no attributes", element.name));
    }
}

/// A syntax error of the XML in plain words.
fn explain(text: &str, error: &Error, report: &mut Report) {
    let at = match error {
        Error::UnclosedRootNode | Error::UnexpectedEndOfStream | Error::NoRootNode => text.len(),
        _ => offset(text, error.pos().row, error.pos().col),
    };
    let end = text.get(at..).and_then(|rest| rest.chars().next()).map_or(at, |c| at + c.len_utf8());
    let (message, help) = match error {
        Error::UnexpectedCloseTag(open, close, _) => (
            format!("`<{open}>` is closed by `</{close}>`"),
            format!("close it with `</{open}>` first; tags close in the reverse order of opening"),
        ),
        Error::UnclosedRootNode => (
            "the text ends inside an element that was opened and never closed".into(),
            "every `<name>` needs a `</name>`; an element without content ends with `/>`".into(),
        ),
        Error::NoRootNode => {
            ("the text holds no element".into(), "a model is written as `<mujoco> … </mujoco>`".into())
        }
        Error::DuplicatedAttribute(name, _) => {
            (format!("the attribute {} stands twice in one tag", shown(name)), "keep one of them".into())
        }
        Error::InvalidAttributeValue(_) => {
            ("a `<` inside an attribute's value".into(), "close the quotes of the attribute before it".into())
        }
        Error::UnknownEntityReference(..) | Error::MalformedEntityReference(_) => (
            "a `&` that does not begin `&amp;`, `&lt;`, `&gt;`, `&quot;` or `&apos;`".into(),
            "write `&amp;` for the character itself".into(),
        ),
        Error::InvalidChar2("a whitespace", ..) => (
            "the value of an attribute ends here, but text follows it".into(),
            "close the quotes of the value before it, or put a space between two attributes".into(),
        ),
        Error::InvalidComment(_) => {
            ("`--` inside a comment".into(), "a comment may not hold two hyphens in a row".into())
        }
        Error::UnexpectedEndOfStream => {
            ("the text ends inside a tag, a value or a comment".into(), "complete the last tag".into())
        }
        other => {
            let words = other.to_string();
            // The place is given by the diagnostic itself.
            let words = words.rsplit_once(" at ").map_or(words.as_str(), |(before, _)| before);
            (format!("not well-formed XML: {words}"), "compare this tag with a working one".into())
        }
    };
    report.error(code::XML, at..end, message).help(help);
}

/// The byte of a line and column that count from 1, the column in characters.
fn offset(text: &str, row: u32, col: u32) -> usize {
    let line_start = match row {
        0 | 1 => 0,
        _ => text.match_indices('\n').nth(row as usize - 2).map_or(text.len(), |(i, _)| i + 1),
    };
    let line = text.get(line_start..).unwrap_or("");
    line_start + line.char_indices().nth(col.saturating_sub(1) as usize).map_or(line.len(), |(i, _)| i)
}
