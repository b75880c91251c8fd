//! Completions and hover texts in MJCF, from the schema of the compiler: elements, attributes, keywords and names.

use super::elements::{element_names, noun_of};
use super::item::{Completion, CompletionKind, Edit, Hover};
use super::tag::{Markup, OpenElements, Tag, Tags, word};
use labspec_core::xml::{Attr, AttributeType, Element, Status, schema_root};
use std::ops::Range;

/// What is at a byte of a model.
enum Spot<'x> {
    /// Text between tags.
    Content(Range<usize>),
    /// The name of an element.
    Name(Tag<'x>),
    /// The place of an attribute of a tag, with the name that is written there.
    Attribute(Tag<'x>, Range<usize>),
    /// The value of an attribute.
    Value(Tag<'x>, &'x str, Range<usize>),
    /// A comment, or literal text.
    Nothing,
}

/// The completions at a byte of a model.
pub(crate) fn completions(xml: &str, byte: usize) -> Vec<Completion> {
    let (open, spot) = spot_at(xml, byte);
    match spot {
        Spot::Nothing => Vec::new(),
        Spot::Content(typed) => children(open.names(), &typed, "<", false),
        Spot::Name(tag) if tag.is_end => {
            let innermost = open.names().last().into_iter();
            let closing =
                innermost.map(|name| completion(name, CompletionKind::Element, "the end of the element"));
            closing.map(|c| replacing(c, &tag.name_span())).collect()
        }
        Spot::Name(tag) => children(open.names(), &tag.name_span(), "", true),
        Spot::Attribute(tag, typed) => attributes(xml, open.names(), &tag, &typed),
        Spot::Value(tag, attribute, span) => values(xml, open.names(), &tag, attribute, &span),
    }
}

/// The hover text at a byte of a model.
pub(crate) fn hover(xml: &str, byte: usize) -> Option<Hover> {
    let (open, spot) = spot_at(xml, byte);
    match spot {
        Spot::Name(tag) => {
            let element = element_of(open.names(), tag.name)?;
            let names: Vec<&str> = element.attributes().map(|a| a.name).collect();
            let attributes = if names.is_empty() { "none".to_string() } else { names.join(", ") };
            let lines = [
                Some(format!("**{}**", element.name)),
                describe_status(element.status),
                Some(format!("Attributes: {attributes}")),
            ];
            let text = lines.into_iter().flatten().collect::<Vec<_>>().join("\n\n");
            Some(Hover { span: tag.name_span(), text })
        }
        Spot::Attribute(tag, span) => {
            let attribute = element_of(open.names(), tag.name)?.attribute(xml.get(span.clone())?)?;
            Some(Hover { span, text: describe_attribute(attribute) })
        }
        Spot::Value(tag, name, span) => {
            let attribute = element_of(open.names(), tag.name)?.attribute(name)?;
            Some(Hover { span, text: describe_attribute(attribute) })
        }
        Spot::Content(_) | Spot::Nothing => None,
    }
}

/// What is at a byte, and the elements that are open there.
fn spot_at(xml: &str, byte: usize) -> (OpenElements<'_>, Spot<'_>) {
    let mut open = OpenElements::default();
    let mut behind = 0;
    for markup in Tags::new(xml) {
        match markup {
            Markup::Other(span, finished) if span.start < byte && (byte < span.end || !finished) => {
                return (open, Spot::Nothing);
            }
            Markup::Other(span, _) => {
                if byte <= span.start {
                    break;
                }
                behind = span.end;
            }
            Markup::Tag(tag) if byte <= tag.start => break,
            Markup::Tag(tag) if byte < tag.end || (byte == tag.end && !tag.finished) => {
                let spot = spot_in(xml, tag, byte);
                return (open, spot);
            }
            Markup::Tag(tag) => {
                behind = tag.end;
                open.pass(&tag);
            }
        }
    }
    let before = xml.get(behind..byte).unwrap_or("");
    let start = byte - before.len() + before.trim_end_matches(char::is_alphanumeric).len();
    (open, Spot::Content(start..byte))
}

fn spot_in<'x>(xml: &'x str, tag: Tag<'x>, byte: usize) -> Spot<'x> {
    if byte <= tag.name_span().end {
        return if byte >= tag.name_span().start { Spot::Name(tag) } else { Spot::Nothing };
    }
    let value = tag.attributes.iter().find(|(_, span)| span.start <= byte && byte <= span.end).cloned();
    if let Some((attribute, span)) = value {
        return Spot::Value(tag, attribute, span);
    }
    let before = xml.get(tag.start..byte).unwrap_or("");
    let is_name = |c: char| c.is_alphanumeric() || matches!(c, '_' | '-' | ':' | '.');
    let start = tag.start + before.trim_end_matches(is_name).len();
    // An attribute starts after a blank.
    if tag.is_end || !xml.get(..start).is_some_and(|text| text.ends_with(char::is_whitespace)) {
        return Spot::Nothing;
    }
    let typed = word(xml.get(start..).unwrap_or("")).len();
    // A value whose quote is missing at the end.
    if has_open_quote(before) {
        return Spot::Nothing;
    }
    Spot::Attribute(tag, start..start + typed)
}

/// Whether a quote of a tag is not closed.
fn has_open_quote(tag: &str) -> bool {
    let mut open = None;
    for c in tag.chars().filter(|c| matches!(c, '"' | '\'')) {
        match open {
            None => open = Some(c),
            Some(quote) if quote == c => open = None,
            Some(_) => {}
        }
    }
    open.is_some()
}

/// The element at the end of a path of open elements.
fn element_at(open: &[&str]) -> Option<&'static Element> {
    let (root, below) = open.split_first()?;
    let root = Some(schema_root()).filter(|element| *root == element.name || *root == "mujocoinclude")?;
    below.iter().try_fold(root, |element, name| element.child(name))
}

/// The element with a name inside of open elements.
fn element_of(open: &[&str], name: &str) -> Option<&'static Element> {
    if open.is_empty() { element_at(&[name]) } else { element_at(open)?.child(name) }
}

fn completion(label: &str, kind: CompletionKind, detail: &str) -> Completion {
    Completion {
        label: label.to_string(),
        kind,
        detail: detail.to_string(),
        documentation: String::new(),
        filter: None,
        edit: Edit { span: 0..0, text: label.to_string() },
    }
}

fn replacing(c: Completion, span: &Range<usize>) -> Completion {
    Completion { edit: Edit { span: span.clone(), ..c.edit }, ..c }
}

/// The elements that can be inside of the open ones. `is_tag`: after a `<`, where the closing tag of the parent is possible as
/// well.
fn children(open: &[&str], span: &Range<usize>, before: &str, is_tag: bool) -> Vec<Completion> {
    let root = [schema_root()];
    let parent = element_at(open);
    let all: &[&'static Element] = match parent {
        Some(parent) => parent.children,
        None if open.is_empty() => &root,
        None => &[],
    };
    let supported = all.iter().filter(|element| element.status != Status::Unsupported);
    let mut items: Vec<Completion> = supported
        .map(|element| {
            let c = completion(element.name, CompletionKind::Element, "an element");
            let edit = Edit { span: span.clone(), text: format!("{before}{}", element.name) };
            Completion { documentation: describe_status(element.status).unwrap_or_default(), edit, ..c }
        })
        .collect();
    if let Some(name) = open.last().filter(|_| is_tag) {
        let end = format!("/{name}>");
        items.push(replacing(completion(&end, CompletionKind::Element, "the end of the element"), span));
    }
    items
}

/// The attributes that a tag does not have yet.
fn attributes(xml: &str, open: &[&str], tag: &Tag<'_>, typed: &Range<usize>) -> Vec<Completion> {
    let Some(element) = element_of(open, tag.name) else { return Vec::new() };
    let has_value = xml.get(typed.end..).is_some_and(|rest| rest.trim_start().starts_with('='));
    let written = |name: &str| {
        tag.attributes.iter().any(|(other, span)| *other == name && span.start > typed.end + 4)
            || tag.attributes.iter().any(|(other, span)| *other == name && span.end < typed.start)
    };
    let missing = element.attributes().filter(|a| a.status != Status::Unsupported && !written(a.name));
    let items = missing.map(|a| {
        let c = completion(a.name, CompletionKind::Attribute, &a.kind.describe());
        let text = if has_value { a.name.to_string() } else { format!("{}=\"\"", a.name) };
        let documentation = describe_status(a.status).unwrap_or_default();
        Completion { documentation, edit: Edit { span: typed.clone(), text }, ..c }
    });
    items.collect()
}

/// The values of an attribute: its keywords, or the names that the model defines.
fn values(xml: &str, open: &[&str], tag: &Tag<'_>, name: &str, span: &Range<usize>) -> Vec<Completion> {
    let Some(attribute) = element_of(open, tag.name).and_then(|element| element.attribute(name)) else {
        return Vec::new();
    };
    let of_noun = |noun: &str| {
        let defined =
            element_names(xml).all.into_iter().filter(|e| e.defines && e.noun == noun && e.span != *span);
        let mut names: Vec<String> = defined.map(|e| e.name).collect();
        names.sort();
        names.dedup();
        names
    };
    let (names, kind, detail) = match attribute.kind {
        AttributeType::Keywords(words) => {
            let supported = words.iter().filter(|w| w.supported).map(|w| w.text.to_string());
            (supported.collect(), CompletionKind::Value, format!("a value of `{name}`"))
        }
        AttributeType::Ref(noun) => (of_noun(noun), CompletionKind::Name, format!("a {noun} of this model")),
        AttributeType::Class => {
            (classes(xml), CompletionKind::Name, "a default class of this model".to_string())
        }
        AttributeType::Text => match named_kind(xml, tag, name) {
            Some(noun) => (of_noun(noun), CompletionKind::Name, format!("a {noun} of this model")),
            None => return Vec::new(),
        },
        AttributeType::Reals(..) | AttributeType::Ints(..) | AttributeType::Name(_) => return Vec::new(),
    };
    names.iter().map(|n| replacing(completion(n, kind, &detail), span)).collect()
}

/// The kind of object that `objname` or `refname` names: that of the attribute `objtype` or `reftype` beside it.
fn named_kind(xml: &str, tag: &Tag<'_>, name: &str) -> Option<&'static str> {
    let kind = format!("{}type", name.strip_suffix("name")?);
    let (_, span) = tag.attributes.iter().find(|(other, _)| *other == kind)?;
    noun_of(xml.get(span.clone())?)
}

/// The default classes that a model defines.
fn classes(xml: &str) -> Vec<String> {
    let mut all: Vec<String> = Tags::new(xml)
        .filter_map(|markup| match markup {
            Markup::Tag(tag) if tag.name == "default" && !tag.is_end => {
                let (_, span) = tag.attributes.iter().find(|(name, _)| *name == "class")?;
                Some(xml.get(span.clone())?.to_string())
            }
            _ => None,
        })
        .filter(|name| !name.is_empty())
        .collect();
    all.sort();
    all.dedup();
    all
}

fn describe_attribute(attribute: &Attr) -> String {
    let kind = format!("**{}**: {}", attribute.name, attribute.kind.describe());
    match describe_status(attribute.status) {
        Some(status) => format!("{kind}\n\n{status}"),
        None => kind,
    }
}

/// What the compiler does with it, unless it is read like in MuJoCo.
fn describe_status(status: Status) -> Option<String> {
    match status {
        Status::Supported => None,
        Status::Ignored(purpose) => Some(format!("Accepted without effect on a number: {purpose}.")),
        Status::Only(value) => Some(format!("Only `{value}` is supported.")),
        Status::Unsupported => Some("Not supported by this engine.".to_string()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// The labels of the completions at `|`, and the model after the one with this label is applied.
    fn offered(marked: &str, label: &str) -> (Vec<String>, String) {
        let (mut xml, byte) = (marked.replacen('|', "", 1), marked.find('|').unwrap());
        let all = completions(&xml, byte);
        if let Some(c) = all.iter().find(|c| c.label == label) {
            xml.replace_range(c.edit.span.clone(), &c.edit.text);
        }
        (all.into_iter().map(|c| c.label).collect(), xml)
    }

    #[test]
    fn completions_follow_the_schema() {
        for (marked, label, not, after) in [
            ("|", "mujoco", "body", "<mujoco"),
            ("<mujoco><wo|", "worldbody", "geom", "<mujoco><worldbody"),
            (
                "<mujoco><worldbody><|</worldbody>",
                "geom",
                "worldbody",
                "<mujoco><worldbody><geom</worldbody>",
            ),
            ("<mujoco><worldbody><|", "/worldbody>", "option", "<mujoco><worldbody></worldbody>"),
            ("<mujoco><worldbody>ge|", "geom", "option", "<mujoco><worldbody><geom"),
            ("<mujoco><worldbody><body></|", "body", "geom", "<mujoco><worldbody><body></body"),
            ("<mujoco><worldbody><geom si|/>", "size", "joint", "<mujoco><worldbody><geom size=\"\"/>"),
            (
                "<mujoco><worldbody><geom size='1' |/>",
                "type",
                "size",
                "<mujoco><worldbody><geom size='1' type=\"\"/>",
            ),
            (
                "<mujoco><worldbody><geom ty|='box'/>",
                "type",
                "damping",
                "<mujoco><worldbody><geom type='box'/>",
            ),
            (
                "<mujoco><worldbody><geom type='|'/>",
                "capsule",
                "sdf",
                "<mujoco><worldbody><geom type='capsule'/>",
            ),
            (
                "<mujoco><worldbody><joint name='a'/><joint name='b'/></worldbody><actuator><motor joint=\"|\"/>",
                "b",
                "motor",
                "<mujoco><worldbody><joint name='a'/><joint name='b'/></worldbody><actuator><motor joint=\"b\"/>",
            ),
            (
                "<mujoco><default><default class='red'/></default><worldbody><geom class='|'/>",
                "red",
                "geom",
                "<mujoco><default><default class='red'/></default><worldbody><geom class='red'/>",
            ),
            (
                "<mujoco><worldbody><site name='tip'/></worldbody><sensor><framepos objtype='site' objname='|'/>",
                "tip",
                "site",
                "<mujoco><worldbody><site name='tip'/></worldbody><sensor><framepos objtype='site' objname='tip'/>",
            ),
        ] {
            let (labels, text) = offered(marked, label);
            assert!(labels.iter().any(|l| l == label), "{marked}: {labels:?}");
            assert!(!labels.iter().any(|l| l == not), "{marked}: {labels:?}");
            assert_eq!(text, after, "{marked}");
        }
    }

    #[test]
    fn nothing_is_offered_outside_of_tags_and_for_numbers() {
        for nothing in [
            "<mujoco><!-- <|",
            "<mujoco><worldbody><geom pos='|0'/>",
            "<mujoco model='a|",
            "<mujoco><foo><|",
            "<mujoco><worldbody></ge|om x",
        ] {
            let (labels, _) = offered(nothing, "");
            assert!(labels.iter().all(|l| l.starts_with('/') || l == "worldbody"), "{nothing}: {labels:?}");
        }
    }

    #[test]
    fn hover_tells_types_and_what_is_ignored() {
        let explained = |marked: &str| {
            let (xml, byte) = (marked.replacen('|', "", 1), marked.find('|').unwrap());
            hover(&xml, byte).map(|h| (xml[h.span.clone()].to_string(), h.text))
        };
        let text = |marked| explained(marked).unwrap();
        assert_eq!(
            text("<mujoco><worldbody><geom si|ze='1'/>"),
            ("size".into(), "**size**: 1 to 3 numbers".into())
        );
        assert_eq!(text("<mujoco><worldbody><geom type='b|ox'/>").0, "box");
        assert!(text("<mujoco><worldbody><ge|om/>").1.contains("condim"));
        assert_eq!(explained("<mujoco><worldbody> |<geom/>"), None);
        assert_eq!(explained("<mujoco><nothing| here='1'/>"), None);
    }

    proptest! {
        /// No text causes a panic, and every edit is at characters of the text.
        #[test]
        fn any_text_at_any_offset(
            text in "[<>/='\"a! \\-é]{0,40}|(<mujoco>|<worldbody>|<body |<geom |type=|name=|'a'|/>|<!--|\\]\\]>|</body>|é){0,12}",
            offset in 0..80_usize,
        ) {
            let offset = (0..=offset.min(text.len())).rev().find(|offset| text.is_char_boundary(*offset)).unwrap_or(0);
            for c in completions(&text, offset) {
                prop_assert!(text.get(c.edit.span).is_some());
            }
            prop_assert!(hover(&text, offset).is_none_or(|h| text.get(h.span).is_some()));
        }
    }
}
