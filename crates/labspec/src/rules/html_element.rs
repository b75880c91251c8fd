use crate::json::read::shorten;
use labspec_finding::{Example, Finding, Layer, Rule, Severity};
use std::ops::Range;

/// A text of a lab or a quiz has a tag that HTML does not have.
pub const HTML_ELEMENT: &Rule = &Rule {
    code: "html-element",
    severity: Severity::Warning,
    exceptions: &[],
    layer: Layer::Structure,
    summary: "a text of a lab or a quiz has a tag that HTML does not have",
    why: "a browser reads it as an unknown element, and does not show the text between `<` and `>`",
    bad: Example::Quiz(
        r#"{"id": "fall", "questions": [{"kind": "open", "q": "Is ⟦<strnog>⟧it the same?"}]}"#,
    ),
    good: Example::Quiz(
        r#"{"id": "fall", "questions": [{"kind": "open", "q": "Is <strong>it</strong> the same?"}]}"#,
    ),
};

/// Void elements, which have no content and no closing tag.
pub(super) const VOID: [&str; 13] =
    ["area", "base", "br", "col", "embed", "hr", "img", "input", "link", "meta", "source", "track", "wbr"];
/// Elements whose closing tag is optional: the next element, or the end of the parent, closes them.
pub(super) const SELF_CLOSING: [&str; 13] =
    ["p", "li", "dt", "dd", "tr", "td", "th", "thead", "tbody", "tfoot", "colgroup", "option", "optgroup"];
/// All other HTML elements that a lesson may use.
#[rustfmt::skip]
const KNOWN: [&str; 77] = [
    "a", "abbr", "address", "article", "aside", "audio", "b", "bdi", "bdo", "big", "blockquote", "button",
    "canvas", "caption", "center", "cite", "code", "data", "datalist", "del", "details", "dfn", "dialog",
    "div", "dl", "em", "fieldset", "figcaption", "figure", "font", "footer", "form", "h1", "h2", "h3", "h4",
    "h5", "h6", "header", "i", "iframe", "ins", "kbd", "label", "legend", "main", "map", "mark", "math",
    "meter", "nav", "ol", "output", "picture", "pre", "progress", "q", "s", "samp", "section", "select",
    "small", "span", "strong", "sub", "summary", "sup", "svg", "table", "template", "textarea", "time", "tt",
    "u", "ul", "var", "video",
];

/// Whether HTML has an element, except foreign and custom elements.
pub(super) fn is_element(name: &str) -> bool {
    VOID.contains(&name) || SELF_CLOSING.contains(&name) || KNOWN.contains(&name)
}

/// Reports an element that HTML does not have.
pub(super) fn unknown(span: Range<usize>, name: &str) -> Finding {
    Finding::new(HTML_ELEMENT, span, format!("HTML has no element `{}`", shorten(name)))
        .help("write `&lt;` for `<` if this is not an element")
}
