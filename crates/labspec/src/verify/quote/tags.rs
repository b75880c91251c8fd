//! Tags of HTML: what a page shows in place of one, and where it ends.

use std::ops::Range;

/// Stands between two pieces of text that a page shows apart, such as two cells. No quote holds it.
pub(super) const APART: char = '\u{1}';

/// Tags that change how text looks and not where it stands.
const INLINE: [&str; 28] = [
    "a", "abbr", "b", "bdi", "bdo", "big", "cite", "code", "data", "del", "dfn", "em", "font", "i", "ins",
    "kbd", "label", "mark", "q", "s", "samp", "small", "span", "strong", "time", "u", "var", "wbr",
];

/// What is shown instead of the tag or comment that `text` begins with, and its length. `None` when it is none.
pub(super) fn read_tag(text: &str) -> Option<(Option<char>, usize)> {
    if let Some(rest) = text.strip_prefix("<!--") {
        return Some((None, rest.find("-->").map_or(text.len(), |end| 4 + end + 3)));
    }
    let rest = text.strip_prefix('<')?;
    let closing = rest.starts_with('/');
    let rest = rest.strip_prefix('/').unwrap_or(rest);
    if !rest.starts_with(|c: char| c.is_ascii_alphabetic() || (!closing && matches!(c, '!' | '?'))) {
        return None;
    }
    let length = rest.find(|c: char| !c.is_ascii_alphanumeric()).unwrap_or(rest.len());
    let name = rest.get(..length).unwrap_or("").to_ascii_lowercase();
    let end = tag_end(text);
    Some(match name.as_str() {
        // What a page runs or keeps is never shown.
        "script" | "style" | "template" | "title" if !closing => {
            let inside = text.get(end..).unwrap_or("");
            (Some(APART), end + element_end(inside, &name))
        }
        "sup" => (Some('^').filter(|_| !closing), end),
        "sub" => (Some('_').filter(|_| !closing), end),
        "br" => (Some(' '), end),
        name if INLINE.contains(&name) => (None, end),
        _ => (Some(APART), end),
    })
}

/// Length of the tag that `text` begins with; a `>` inside of quotes does not end it.
pub(super) fn tag_end(text: &str) -> usize {
    let mut quote = None;
    for (i, c) in text.char_indices() {
        match (quote, c) {
            (None, '>') => return i + 1,
            (None, '"' | '\'') => quote = Some(c),
            (Some(open), _) if open == c => quote = None,
            _ => {}
        }
    }
    text.len()
}

/// Where the closing tag of a script or a style begins.
fn element_end(text: &str, name: &str) -> usize {
    text.match_indices("</")
        .find(|(i, _)| {
            let word: Range<usize> = i + 2..i + 2 + name.len();
            text.get(word).is_some_and(|w| w.eq_ignore_ascii_case(name))
        })
        .map_or(text.len(), |(i, _)| i)
}
