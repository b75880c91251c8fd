//! The visible text of HTML: without tags, comments and hidden elements, with decoded entities.

use super::hidden::HiddenElement;
use crate::markdown::html::{HtmlTag, HtmlToken, tokens};
use crate::source::{SourceMap, Text};

/// Separates two pieces of text that a page displays apart, such as two cells. No quote contains it.
pub(super) const TEXT_SEPARATOR: char = '\u{1}';

/// Tags that change the style of text and not its position.
const INLINE: [&str; 37] = [
    "a",
    "abbr",
    "b",
    "bdi",
    "bdo",
    "big",
    "cite",
    "code",
    "data",
    "del",
    "dfn",
    "em",
    "font",
    "i",
    "ins",
    "kbd",
    "label",
    "math",
    "mi",
    "mn",
    "mo",
    "mrow",
    "mspace",
    "mstyle",
    "mtext",
    "semantics",
    "mark",
    "q",
    "s",
    "samp",
    "small",
    "span",
    "strong",
    "time",
    "u",
    "var",
    "wbr",
];

/// The character that replaces a tag in the visible text.
pub(super) fn mark(tag: &HtmlTag) -> Option<char> {
    match tag.name.as_str() {
        "sup" => Some('^').filter(|_| !tag.closing),
        "sub" => Some('_').filter(|_| !tag.closing),
        "br" => Some(' '),
        // The numbers in them are parts of a formula.
        "msqrt" | "mroot" | "mfrac" | "msup" | "msub" | "msubsup" | "munder" | "mover" => {
            Some('√').filter(|_| !tag.closing)
        }
        name => Some(TEXT_SEPARATOR).filter(|_| !INLINE.contains(&name)),
    }
}

/// The visible text of a piece of HTML, with its source map.
pub(super) fn strip(html: &str) -> (String, SourceMap) {
    strip_after(html, &mut HiddenElement::default())
}

/// The visible part of a text of HTML.
pub(super) fn visible_text(html: &Text, hidden: &mut HiddenElement) -> Text {
    let (value, map) = strip_after(html.as_str(), hidden);
    Text { value, map: map.then(&html.map) }
}

/// Like [`strip`], where `hidden` may contain an element that is still open.
fn strip_after(html: &str, hidden: &mut HiddenElement) -> (String, SourceMap) {
    let (mut text, mut map) = (String::with_capacity(html.len()), SourceMap::default());
    for token in tokens(html) {
        match token {
            HtmlToken::Tag(tag) => {
                // Elements such as scripts separate the text around them.
                let parts = matches!(tag.name.as_str(), "script" | "style" | "title");
                let unseen = hidden.take_tag(&tag);
                if let Some(c) = mark(&tag).filter(|_| parts || !unseen) {
                    text.push(c);
                    map.push_whole(c.len_utf8(), tag.span);
                }
            }
            HtmlToken::Text(_) | HtmlToken::Decoded(..) if hidden.is_on() => {}
            HtmlToken::Text(span) => {
                text.push_str(html.get(span.clone()).unwrap_or(""));
                map.push_verbatim(span);
            }
            HtmlToken::Decoded(decoded, span) => {
                text.push_str(&decoded);
                map.push_whole(decoded.len(), span);
            }
        }
    }
    (text, map)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn stripped(html: &str) -> String {
        strip(html).0
    }

    #[test]
    fn only_rendered_text_remains() {
        assert_eq!(stripped("<p>it takes <b>0.442</b>&nbsp;s</p>"), "\u{1}it takes 0.442\u{a0}s\u{1}");
        assert_eq!(stripped("a < b && c<d title=\"1 > 0\">e</d>"), "a < b && c\u{1}e\u{1}");
        assert_eq!(stripped("x<!-- 0.442 s -->y<script>0.442</script>z"), "xy\u{1}\u{1}z");
        assert_eq!(stripped("10<sup>&minus;3</sup> m<sub>1</sub><br>"), "10^\u{2212}3 m_1 ");
        assert_eq!(stripped("&#x2212;1&#8239;m &unknown; &amp;lt;"), "\u{2212}1\u{202f}m &unknown; &lt;");
        assert_eq!(stripped("0.5<span hidden> m</span> s<template>3</template>"), "0.5 s");
        assert_eq!(stripped("<table><td>1</td><td>2"), "\u{1}\u{1}1\u{1}\u{1}2");
        assert_eq!(stripped("<math><msqrt><mn>3.96</mn></msqrt></math> m/s"), "√3.96 m/s");
        assert_eq!(stripped("<math><mn>3.96</mn></math> m/s"), "3.96 m/s");
        for broken in ["<", "<a", "<!--", "</", "&", "&#;", "<script>", "<a href='", "&#x110000;", "<é>"] {
            stripped(broken);
        }
    }

    #[test]
    fn byte_ranges_are_kept() {
        let html = "<b>0.442</b>&nbsp;s";
        let (text, map) = strip(html);
        assert_eq!(text, "0.442\u{a0}s");
        assert_eq!(&html[map.span(0..text.len())], "0.442</b>&nbsp;s");
    }
}
