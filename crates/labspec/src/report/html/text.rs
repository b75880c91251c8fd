//! Escapes text of lessons for a page: it is displayed as text and has no other effect.

use crate::printable::printable_line;
use std::borrow::Cow;

/// Maximum number of characters of a text. A longer text is truncated, which the page states.
const MAX_TEXT: usize = 2000;

/// A text on one line, as content of an element. Its writing direction is isolated.
pub(super) fn text(text: &str) -> String {
    let visible = plain(text);
    if visible.is_empty() { visible } else { format!("<bdi>{visible}</bdi>") }
}

/// Like [`text`], for places without tags: attributes and the title.
pub(super) fn plain(text: &str) -> String {
    let words: Vec<&str> = cut(text).split_whitespace().collect();
    let mut out = escape(&words.join(" "));
    out.push_str(&rest(text));
    out
}

/// A piece of code, with its lines.
pub(super) fn code(text: &str) -> String {
    let lines: Vec<String> = cut(text.trim()).lines().map(|line| escape(&line.replace('\t', "  "))).collect();
    format!("<code>{}{}</code>", lines.join("\n"), rest(text.trim()))
}

/// The part of a text that is displayed.
pub(super) fn cut(text: &str) -> &str {
    let end = text.char_indices().nth(MAX_TEXT).map_or(text.len(), |(offset, _)| offset);
    text.get(..end).unwrap_or("")
}

pub(super) fn rest(text: &str) -> String {
    let left = text.get(cut(text).len()..).map_or(0, |rest| rest.chars().count());
    if left == 0 { String::new() } else { format!(" … ({left} more characters)") }
}

/// Escapes a text for the content of an element or a quoted attribute. Invisible characters are written as escapes; tabs and line
/// breaks stay, the latter as `\n`.
pub fn escape(text: &str) -> String {
    let mut out = String::with_capacity(text.len() + 16);
    for (i, line) in text.split('\n').enumerate() {
        if i > 0 {
            out.push('\n');
        }
        for c in printable_line(line.strip_suffix('\r').unwrap_or(line)).chars() {
            match c {
                '&' => out.push_str("&amp;"),
                '<' => out.push_str("&lt;"),
                '>' => out.push_str("&gt;"),
                '"' => out.push_str("&quot;"),
                '\'' => out.push_str("&#39;"),
                // Noncharacters of Unicode.
                '\u{fffe}' | '\u{ffff}' => out.extend(c.escape_default()),
                c => out.push(c),
            }
        }
    }
    out
}

/// Paths without their common folder, so that a page does not reveal the machine.
pub(super) struct Names {
    folder: String,
}

impl Names {
    /// The names of these files.
    pub(super) fn shorten_paths<'p>(mut paths: impl Iterator<Item = &'p str>) -> Names {
        let folder_of = |path: &str| path.rfind(['/', '\\']).map_or(0, |separator| separator + 1);
        let Some(first) = paths.next() else { return Names { folder: String::new() } };
        let mut folder = first.get(..folder_of(first)).unwrap_or("");
        for path in paths {
            while !path.starts_with(folder) {
                let outer = folder.trim_end_matches(['/', '\\']);
                folder = outer.get(..folder_of(outer)).unwrap_or("");
            }
        }
        Names { folder: folder.to_string() }
    }

    /// A path in the form that the page displays.
    pub(super) fn short<'p>(&self, path: &'p str) -> &'p str {
        let inside = path.strip_prefix(self.folder.as_str()).unwrap_or(path);
        if inside.starts_with(['/', '\\']) { inside.rsplit(['/', '\\']).next().unwrap_or("") } else { inside }
    }

    /// A sentence with the paths in it shortened.
    pub(super) fn shorten<'t>(&self, text: &'t str) -> Cow<'t, str> {
        let whole = self.folder.len() > 1 && self.folder.starts_with(['/', '\\']);
        if whole && text.contains(&self.folder) {
            Cow::Owned(text.replace(&self.folder, ""))
        } else {
            Cow::Borrowed(text)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn escaped_text_has_no_effect() {
        assert_eq!(plain("<b a=\"'\">&"), "&lt;b a=&quot;&#39;&quot;&gt;&amp;");
        assert_eq!(plain("a\u{202e}b\u{0}c\u{ffff}"), "a\\u{202e}b\\u{0}c\\u{ffff}");
        assert_eq!(plain(" two\n lines\t"), "two lines");
        assert_eq!(code("a\n\tb < c"), "<code>a\n  b &lt; c</code>");
        assert_eq!(text("x"), "<bdi>x</bdi>");
        assert_eq!(escape("a\t<\r\n\u{202e}b\rc\n"), "a\t&lt;\n\\u{202e}b\\rc\n");
    }

    #[test]
    fn long_text_is_cut_between_characters() {
        let long = plain(&"é<".repeat(MAX_TEXT));
        assert!(long.ends_with("é&lt; … (2000 more characters)"), "{}", &long[long.len() - 60..]);
        assert_eq!(plain(&"é".repeat(MAX_TEXT)).chars().count(), MAX_TEXT);
    }

    #[test]
    fn common_prefixes_of_paths_are_removed() {
        let names = Names::shorten_paths(["/home/me/course/a.md", "/home/me/course/b/c.md"].into_iter());
        assert_eq!(names.short("/home/me/course/b/c.md"), "b/c.md");
        assert_eq!(names.short("/home/me/models/x.xml"), "x.xml");
        assert_eq!(names.shorten("no /home/me/course/a.md"), "no a.md");
        assert_eq!(Names::shorten_paths(["a.md"].into_iter()).short("a.md"), "a.md");
        assert_eq!(Names::shorten_paths(["a/x.md", "b/x.md"].into_iter()).short("b/x.md"), "b/x.md");
        assert_eq!(Names::shorten_paths(std::iter::empty()).short("/root/a.md"), "a.md");
    }
}
