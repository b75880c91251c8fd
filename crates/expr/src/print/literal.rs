//! Printing of numbers and strings.

use crate::number;

/// A number without a sign; an infinite one is printed so that it is parsed as infinite again.
pub(super) fn number_text(x: f64) -> String {
    if x.is_infinite() { "1e999".into() } else { number::to_text(x) }
}

/// Whether a key can be printed without quotes.
pub(super) fn is_word(key: &str) -> bool {
    key.starts_with(|c: char| c.is_ascii_alphabetic() || c == '_' || c == '$')
        && key.chars().all(|c| c.is_ascii_alphanumeric() || c == '_' || c == '$')
}

/// Prints a string in single quotes, which need no escapes in JSON, unless it contains single quotes and no double quotes.
pub(super) fn quote(text: &str, out: &mut String) {
    let mark = if text.contains('\'') && !text.contains('"') { '"' } else { '\'' };
    out.push(mark);
    for c in text.chars() {
        match c {
            '\\' => out.push_str("\\\\"),
            c if c == mark => out.extend(['\\', c]),
            '\n' => out.push_str("\\n"),
            '\t' => out.push_str("\\t"),
            '\r' => out.push_str("\\r"),
            c if c.is_control() || matches!(c, '\u{2028}' | '\u{2029}') => {
                out.push_str(&format!("\\u{{{:x}}}", u32::from(c)));
            }
            c => out.push(c),
        }
    }
    out.push(mark);
}

pub(super) fn template_text(text: &str, out: &mut String) {
    for c in text.chars() {
        match c {
            '`' | '\\' | '$' => out.extend(['\\', c]),
            '\n' => out.push('\n'),
            c if c.is_control() => out.push_str(&format!("\\u{{{:x}}}", u32::from(c))),
            c => out.push(c),
        }
    }
}
