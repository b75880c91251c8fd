//! Converts XML to plain elements: names, attributes and positions, without their meaning.
//!
//! All elements are in one list and refer to their children by index. Depth therefore uses no stack, and texts of several
//! files can be combined.

use crate::mjcf::gather::listed;
use std::ops::Range;

use roxmltree::{Document, Error, Node, ParsingOptions};

use super::diagnostic::{Diagnostics, shorten_name};
use super::scan::Prepared;
use crate::mjcf::rules;

/// An attribute as written in the text.
#[derive(Debug)]
pub(crate) struct XmlAttribute {
    pub(crate) name: String,
    /// The value with its character references resolved.
    pub(crate) value: String,
    pub(crate) name_span: Range<usize>,
    /// Bytes of the value, without quotes.
    pub(crate) value_span: Range<usize>,
    /// Whether the value is a verbatim part of the text, so that each part of it has a position.
    pub(crate) exact: bool,
    pub(crate) namespace: bool,
}

/// An element as written in the text.
#[derive(Debug)]
pub(crate) struct XmlElement {
    pub(crate) name: String,
    /// Bytes of the name in the start tag.
    pub(crate) span: Range<usize>,
    pub(crate) namespace: bool,
    pub(crate) attributes: Vec<XmlAttribute>,
    pub(crate) children: Vec<usize>,
}

impl XmlElement {
    /// The value of an attribute.
    pub(crate) fn attribute(&self, name: &str) -> Option<&XmlAttribute> {
        self.attributes.iter().find(|a| a.name == name && !a.namespace)
    }
}

/// Prints elements as text. The contents of an `include` replace it.
pub(crate) fn print(list: &[XmlElement], root: usize) -> String {
    enum XmlPart {
        Start(usize),
        End(usize),
    }
    let mut text = String::new();
    let mut open = vec![XmlPart::Start(root)];
    while let Some(piece) = open.pop() {
        let (XmlPart::Start(index) | XmlPart::End(index)) = piece;
        let Some(element) = list.get(index) else { continue };
        let plain = element.name != "include" && !element.namespace;
        if let XmlPart::End(_) = piece {
            text.extend(plain.then(|| format!("</{}>", element.name)));
            continue;
        }
        if plain {
            text.push('<');
            text.push_str(&element.name);
            for a in element.attributes.iter().filter(|a| !a.namespace) {
                text.push_str(&format!(" {}=\"{}\"", a.name, escaped(&a.value)));
            }
            text.push('>');
        }
        open.push(XmlPart::End(index));
        open.extend(element.children.iter().rev().map(|c| XmlPart::Start(*c)));
    }
    text
}

/// A value, escaped for use between quotes.
fn escaped(value: &str) -> String {
    let mut text = String::with_capacity(value.len());
    for c in value.chars() {
        match c {
            '&' => text.push_str("&amp;"),
            '<' => text.push_str("&lt;"),
            '"' => text.push_str("&quot;"),
            '\n' | '\r' | '\t' => text.push(' '),
            c => text.push(c),
        }
    }
    text
}

/// Appends the elements of a text to a list and returns the index of the root. The spans of the elements start at `base` and
/// count bytes of the text as written. `None`, with an error in the report, if the text is not XML.
pub(crate) fn parse(
    prepared: &Prepared,
    base: usize,
    list: &mut Vec<XmlElement>,
    report: &mut Diagnostics,
) -> Option<usize> {
    let text = &*prepared.text;
    let options = ParsingOptions { allow_dtd: false, ..ParsingOptions::default() };
    let document = match Document::parse_with_options(text, options) {
        Ok(document) => document,
        Err(error) => {
            explain(prepared, base, &error, report);
            return None;
        }
    };
    let root = list.len();
    let mut stack = vec![(document.root_element(), None)];
    while let Some((xml, parent)) = stack.pop() {
        let index = list.len();
        if let Some(parent) = parent.and_then(|p: usize| list.get_mut(p)) {
            parent.children.push(index);
        }
        list.push(element(prepared, base, &xml));
        let below: Vec<_> = listed(xml.children().filter(Node::is_element).map(|x| (x, Some(index))));
        stack.extend(below.into_iter().rev());
    }
    Some(root)
}

fn element(prepared: &Prepared, base: usize, xml: &Node) -> XmlElement {
    let text = &*prepared.text;
    let shifted = |span: Range<usize>| base + prepared.written(span.start)..base + prepared.written(span.end);
    let name = xml.tag_name();
    let start = base + prepared.written(xml.range().start + 1);
    let attribute = |a: roxmltree::Attribute| XmlAttribute {
        name: a.name().to_string(),
        value: a.value().to_string(),
        name_span: shifted(a.range_qname()),
        value_span: shifted(a.range_value()),
        exact: text.get(a.range_value()) == Some(a.value()),
        namespace: a.namespace().is_some(),
    };
    XmlElement {
        name: name.name().to_string(),
        span: start..start + name.name().len(),
        namespace: name.namespace().is_some(),
        attributes: listed(xml.attributes().map(attribute)),
        children: Vec::new(),
    }
}

/// Reports a syntax error of the XML in plain words.
fn explain(prepared: &Prepared, base: usize, error: &Error, report: &mut Diagnostics) {
    let text = &*prepared.text;
    let start = match error {
        Error::UnclosedRootNode | Error::UnexpectedEndOfStream | Error::NoRootNode => text.len(),
        _ => offset(text, error.pos().row, error.pos().col),
    };
    let end = text.get(start..).and_then(|rest| rest.chars().next()).map_or(start, |c| start + c.len_utf8());
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
            ("the text has no element".into(), "write a model as `<mujoco> … </mujoco>`".into())
        }
        Error::DuplicatedAttribute(name, _) => (
            format!("the attribute {} appears twice in one tag", shorten_name(name)),
            "keep one of them".into(),
        ),
        Error::InvalidAttributeValue(_) => (
            "the value of an attribute contains a `<`".into(),
            "close the quotes of the attribute before it".into(),
        ),
        Error::UnknownEntityReference(..) | Error::MalformedEntityReference(_) => (
            "a `&` does not begin `&amp;`, `&lt;`, `&gt;`, `&quot;` or `&apos;`".into(),
            "write `&amp;` for the character itself".into(),
        ),
        Error::InvalidChar2("a whitespace", ..) => (
            "the value of an attribute ends here, but text follows it".into(),
            "close the quotes of the value before it, or put a space between two attributes".into(),
        ),
        Error::InvalidComment(_) => {
            ("a comment contains `--`".into(), "remove the two hyphens in a row".into())
        }
        Error::UnexpectedEndOfStream => {
            ("the text ends inside a tag, a value or a comment".into(), "complete the last tag".into())
        }
        other => {
            let words = other.to_string();
            // The diagnostic has its own position.
            let words = words.rsplit_once(" at ").map_or(words.as_str(), |(before, _)| before);
            (format!("not well-formed XML: {words}"), "compare this tag with a working one".into())
        }
    };
    let (start, end) = (prepared.written(start), prepared.written(end));
    report.error(rules::XML, base + start..base + end, message).help(help);
}

/// The byte offset of a line and a column. Both count from 1, the column in characters.
fn offset(text: &str, row: u32, col: u32) -> usize {
    let line_start = match row {
        0 | 1 => 0,
        _ => text.match_indices('\n').nth(row as usize - 2).map_or(text.len(), |(i, _)| i + 1),
    };
    let line = text.get(line_start..).unwrap_or("");
    line_start + line.char_indices().nth(col.saturating_sub(1) as usize).map_or(line.len(), |(i, _)| i)
}
