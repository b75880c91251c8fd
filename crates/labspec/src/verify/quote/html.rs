//! HTML as a reader sees it: without tags, comments and what is hidden, entities decoded.

use super::hidden::Hidden;
use super::tags::{read_tag, tag_end};
use crate::source::SourceMap;

/// The shown text of a piece of HTML, with the way back.
pub(super) fn strip(html: &str) -> (String, SourceMap) {
    let (mut text, mut map) = (String::with_capacity(html.len()), SourceMap::default());
    let mut at = 0;
    let mut hidden = Hidden::default();
    while let Some(rest) = html.get(at..).filter(|rest| !rest.is_empty()) {
        let plain = rest.find(['<', '&']).unwrap_or(rest.len());
        if plain > 0 {
            if !hidden.is_on() {
                text.push_str(rest.get(..plain).unwrap_or(""));
                map.push_verbatim(at..at + plain);
            }
            at += plain;
            continue;
        }
        let decoded =
            if rest.starts_with('&') { entity(rest).map(|(c, n)| (Some(c), n)) } else { read_tag(rest) };
        let Some((c, length)) = decoded else {
            // A lone `<` or `&` is shown as it stands.
            if !hidden.is_on() {
                text.push_str(rest.get(..1).unwrap_or(""));
                map.push_verbatim(at..at + 1);
            }
            at += 1;
            continue;
        };
        let unseen = match rest.starts_with('<') {
            true => hidden.take_tag(rest.get(..tag_end(rest)).unwrap_or("")),
            false => hidden.is_on(),
        };
        if let Some(c) = c.filter(|_| !unseen) {
            text.push(c);
            map.push_whole(c.len_utf8(), at..at + length);
        }
        at += length;
    }
    (text, map)
}

/// Entities that stand in texts with numbers.
const ENTITIES: [(&str, char); 44] = [
    ("nbsp", '\u{a0}'),
    ("thinsp", '\u{2009}'),
    ("ensp", '\u{2002}'),
    ("emsp", '\u{2003}'),
    ("hairsp", '\u{200a}'),
    ("numsp", '\u{2007}'),
    ("shy", '\u{ad}'),
    ("zwnj", '\u{200c}'),
    ("zwj", '\u{200d}'),
    ("minus", '\u{2212}'),
    ("ndash", '–'),
    ("mdash", '—'),
    ("times", '×'),
    ("middot", '·'),
    ("sdot", '⋅'),
    ("plusmn", '±'),
    ("pm", '±'),
    ("approx", '≈'),
    ("asymp", '≈'),
    ("sim", '∼'),
    ("cong", '≅'),
    ("frac12", '½'),
    ("half", '½'),
    ("frac14", '¼'),
    ("frac34", '¾'),
    ("sup1", '¹'),
    ("sup2", '²'),
    ("sup3", '³'),
    ("deg", '°'),
    ("micro", 'µ'),
    ("mu", 'μ'),
    ("pi", 'π'),
    ("Omega", 'Ω'),
    ("percnt", '%'),
    ("permil", '‰'),
    ("hellip", '…'),
    ("le", '≤'),
    ("ge", '≥'),
    ("lt", '<'),
    ("gt", '>'),
    ("amp", '&'),
    ("quot", '"'),
    ("apos", '\''),
    ("equals", '='),
];

/// The character of the entity that `text` begins with, and its length.
fn entity(text: &str) -> Option<(char, usize)> {
    // The longest name is short; a far `;` belongs to something else.
    let end = text.bytes().take(12).position(|b| b == b';')?;
    let name = text.get(1..end)?;
    let c = match name.strip_prefix('#') {
        Some(code) => {
            let hex = code.strip_prefix(['x', 'X']);
            let number = match hex {
                Some(digits) => u32::from_str_radix(digits, 16),
                None => code.parse(),
            };
            char::from_u32(number.ok()?).filter(|&c| c != '\0')?
        }
        None => ENTITIES.iter().find(|(n, _)| *n == name)?.1,
    };
    Some((c, end + 1))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shown(html: &str) -> String {
        strip(html).0
    }

    #[test]
    fn only_what_a_page_shows_is_left() {
        assert_eq!(shown("<p>it takes <b>0.442</b>&nbsp;s</p>"), "\u{1}it takes 0.442\u{a0}s\u{1}");
        assert_eq!(shown("a < b && c<d title=\"1 > 0\">e</d>"), "a < b && c\u{1}e\u{1}");
        assert_eq!(shown("x<!-- 0.442 s -->y<script>0.442</script>z"), "xy\u{1}\u{1}z");
        assert_eq!(shown("10<sup>&minus;3</sup> m<sub>1</sub><br>"), "10^\u{2212}3 m_1 ");
        assert_eq!(shown("&#x2212;1&#8239;m &unknown; &amp;lt;"), "\u{2212}1\u{202f}m &unknown; &lt;");
        assert_eq!(shown("0.5<span hidden> m</span> s<template>3</template>"), "0.5 s");
        assert_eq!(shown("<table><td>1</td><td>2"), "\u{1}\u{1}1\u{1}\u{1}2");
        for broken in ["<", "<a", "<!--", "</", "&", "&#;", "<script>", "<a href='", "&#x110000;", "<é>"] {
            shown(broken);
        }
    }

    #[test]
    fn places_are_kept() {
        let html = "<b>0.442</b>&nbsp;s";
        let (text, map) = strip(html);
        assert_eq!(text, "0.442\u{a0}s");
        assert_eq!(&html[map.span(0..text.len())], "0.442</b>&nbsp;s");
    }
}
