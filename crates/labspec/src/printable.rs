//! Makes text from lessons, models and file names safe to print.
//!
//! A terminal executes control characters, reorders text at bidirectional marks and prints nothing for invisible ones: a
//! title that contains them could print a verdict over the true one. Each of them is replaced by its escape: `\u{1b}`.

use std::borrow::Cow;
use std::path::Path;

/// A text for one line of output, with invisible characters and control characters written as escapes.
pub fn printable(text: &str) -> Cow<'_, str> {
    escape_hidden(text, is_hidden, |c, out| out.extend(c.escape_default()))
}

/// Like [`printable`], for a whole output with line breaks.
pub fn printable_lines(text: &str) -> Cow<'_, str> {
    escape_hidden(text, |c| c != '\n' && is_hidden(c), |c, out| out.extend(c.escape_default()))
}

/// Like [`printable`], for a line of a lesson, which may contain tabs.
#[cfg(feature = "report")]
pub(super) fn printable_line(text: &str) -> Cow<'_, str> {
    escape_hidden(text, |c| c != '\t' && is_hidden(c), |c, out| out.extend(c.escape_default()))
}

/// A path in the form that is printed.
pub fn printable_path(path: &Path) -> String {
    printable(&path.display().to_string()).into_owned()
}

/// Equivalent JSON in which such characters are escaped: `\u009b`.
pub fn printable_json(json: &str) -> Cow<'_, str> {
    // Outside of strings, the only such characters in JSON are line breaks.
    escape_hidden(
        json,
        |c| c != '\n' && is_hidden(c),
        |c, out| {
            for unit in c.encode_utf16(&mut [0; 2]) {
                out.push_str(&format!("\\u{unit:04x}"));
            }
        },
    )
}

/// A text with a capital letter at its beginning.
pub fn capital(text: &str) -> String {
    let mut chars = text.chars();
    chars.next().map(|c| c.to_uppercase().to_string()).unwrap_or_default() + chars.as_str()
}

/// `1 lab`, `2 labs`.
pub fn counted(n: usize, one: &str) -> String {
    if n == 1 { format!("1 {one}") } else { format!("{n} {one}s") }
}

fn escape_hidden(
    text: &str,
    hidden: impl Fn(char) -> bool,
    write: impl Fn(char, &mut String),
) -> Cow<'_, str> {
    if !text.contains(&hidden) {
        return Cow::Borrowed(text);
    }
    let mut out = String::with_capacity(text.len() + 16);
    for c in text.chars() {
        if hidden(c) { write(c, &mut out) } else { out.push(c) }
    }
    Cow::Owned(out)
}

/// Control characters, bidirectional marks, line separators, and invisible characters. Variation selectors after emoji
/// (U+FE00 to U+FE0F) are excluded.
fn is_hidden(c: char) -> bool {
    c.is_control()
        || matches!(c,
            '\u{ad}' | '\u{34f}' | '\u{61c}' | '\u{115f}' | '\u{1160}' | '\u{17b4}' | '\u{17b5}'
            | '\u{180b}'..='\u{180f}' | '\u{200b}'..='\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2060}'..='\u{206f}'
            | '\u{3164}' | '\u{feff}' | '\u{ffa0}' | '\u{fff0}'..='\u{fffb}' | '\u{1bca0}'..='\u{1bca3}'
            | '\u{1d173}'..='\u{1d17a}' | '\u{e0000}'..='\u{e0fff}')
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn terminal_control_characters_are_escaped() {
        for (text, printed) in [
            ("plain – “α” ⚠️ 日本", "plain – “α” ⚠️ 日本"),
            ("a\u{1b}[2Jb", "a\\u{1b}[2Jb"),
            ("refuted\rverified", "refuted\\rverified"),
            ("two\nlines\t.", "two\\nlines\\t."),
            ("\u{9b}31m\u{7f}\0", "\\u{9b}31m\\u{7f}\\u{0}"),
            ("\u{202e}deifirev\u{2066}\u{200f}\u{61c}", "\\u{202e}deifirev\\u{2066}\\u{200f}\\u{61c}"),
            ("a\u{2028}b\u{200b}c\u{feff}\u{e0041}", "a\\u{2028}b\\u{200b}c\\u{feff}\\u{e0041}"),
        ] {
            assert_eq!(printable(text), printed);
        }
        assert_eq!(printable_lines("a\nb\r\u{1b}"), "a\nb\\r\\u{1b}");
    }

    #[test]
    fn json_keeps_its_meaning() {
        let value = serde_json::json!({"a\u{9b}": ["\u{202e}x\u{e0041}\n\u{1b}", 1.5]});
        let json = serde_json::to_string_pretty(&value).unwrap();
        let printed = printable_json(&json);
        assert!(printed.is_ascii(), "{printed}");
        assert_eq!(serde_json::from_str::<serde_json::Value>(&printed).unwrap(), value);
    }
}
