//! Decodes the inside of a string, with a source map of every byte.

use crate::finding::Fix;
use crate::source::{SourceMap, Text};
use std::ops::Range;

/// The decoded inside of a string.
pub(super) struct Decoded {
    /// The text.
    pub(super) value: String,
    /// Maps the text to the bytes of the inside.
    pub(super) map: SourceMap,
    /// The errors in it, and their ranges.
    pub(super) faults: Vec<(Range<usize>, StringFault)>,
}

/// Text that JSON does not allow inside a string.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum StringFault {
    /// A backslash before a letter that is not an escape; usually LaTeX.
    Escape(char),
    /// An escaped quote that needs no backslash in JSON: `\'`.
    Needless(char),
    /// `\u` with half of a surrogate pair.
    Half,
    /// A control character.
    Control(char),
    /// A line break.
    Line,
    /// A backslash at the end of a line: JavaScript joins the two lines.
    Joined,
    /// A double quote.
    Quote,
}

/// Decodes `raw`, the text between quotes. Errors are decoded as the probably intended text.
pub(super) fn decode(raw: &str) -> Decoded {
    let mut d =
        Decoded { value: String::with_capacity(raw.len()), map: SourceMap::default(), faults: Vec::new() };
    let mut offset = 0;
    while let Some(rest) = raw.get(offset..).filter(|rest| !rest.is_empty()) {
        let plain = rest.find(|c: char| c == '\\' || c == '"' || c < ' ').unwrap_or(rest.len());
        if plain > 0 {
            d.verbatim(raw, offset..offset + plain);
            offset += plain;
            continue;
        }
        offset += d.special(raw, offset, rest);
    }
    d
}

impl Decoded {
    fn verbatim(&mut self, raw: &str, range: Range<usize>) {
        self.value.push_str(raw.get(range.clone()).unwrap_or(""));
        self.map.push_verbatim(range);
    }

    fn whole(&mut self, c: char, range: Range<usize>) {
        self.value.push(c);
        self.map.push_whole(c.len_utf8(), range);
    }

    /// Decodes the special character at `offset`; returns its length.
    fn special(&mut self, raw: &str, offset: usize, rest: &str) -> usize {
        let mut chars = rest.chars();
        let first = chars.next().unwrap_or(' ');
        if first != '\\' {
            let fault = match first {
                '"' => StringFault::Quote,
                '\n' | '\r' => StringFault::Line,
                c => StringFault::Control(c),
            };
            let length = if rest.starts_with("\r\n") { 2 } else { 1 };
            self.faults.push((offset..offset + length, fault));
            self.verbatim(raw, offset..offset + length);
            return length;
        }
        if let Some((c, length)) = escape(rest) {
            self.whole(c, offset..offset + length);
            return length;
        }
        let Some(c) = chars.next() else {
            // A backslash at the very end has nothing to escape.
            self.faults.push((offset..offset + 1, StringFault::Escape('\\')));
            self.verbatim(raw, offset..offset + 1);
            return 1;
        };
        let length = 1 + c.len_utf8();
        match c {
            '\n' | '\r' => {
                let length = if rest.starts_with("\\\r\n") { 3 } else { length };
                self.faults.push((offset..offset + length, StringFault::Joined));
                length
            }
            '\'' | '`' => {
                self.faults.push((offset..offset + length, StringFault::Needless(c)));
                self.whole(c, offset..offset + length);
                length
            }
            'u' if rest.get(2..6).and_then(hex).is_some() => {
                self.faults.push((offset..offset + 6, StringFault::Half));
                self.whole('\u{fffd}', offset..offset + 6);
                6
            }
            _ => {
                // The letter after the backslash is read as itself.
                self.faults.push((offset..offset + length, StringFault::Escape(c)));
                self.verbatim(raw, offset..offset + 1);
                1
            }
        }
    }
}

/// The character of the escape at the beginning of `text`, and its length in bytes.
fn escape(text: &str) -> Option<(char, usize)> {
    let simple = |c| Some((c, 2));
    match text.as_bytes().get(1)? {
        b'"' => simple('"'),
        b'\\' => simple('\\'),
        b'/' => simple('/'),
        b'b' => simple('\u{8}'),
        b'f' => simple('\u{c}'),
        b'n' => simple('\n'),
        b'r' => simple('\r'),
        b't' => simple('\t'),
        b'u' => {
            let high = hex(text.get(2..6)?)?;
            if !(0xd800..0xe000).contains(&high) {
                return Some((char::from_u32(high)?, 6));
            }
            // JSON writes characters beyond U+FFFF in UTF-16: a high and a low surrogate.
            let low = text.get(6..12)?.strip_prefix("\\u").and_then(hex)?;
            if high >= 0xdc00 || !(0xdc00..0xe000).contains(&low) {
                return None;
            }
            Some((char::from_u32(0x10000 + ((high - 0xd800) << 10) + (low - 0xdc00))?, 12))
        }
        _ => None,
    }
}

fn hex(digits: &str) -> Option<u32> {
    digits.bytes().all(|b| b.is_ascii_hexdigit()).then(|| u32::from_str_radix(digits, 16).ok())?
}

/// A text in the form of the inside of a JSON string: with escapes, without quotes.
pub fn encode(text: &str) -> String {
    let quoted = serde_json::Value::from(text).to_string();
    quoted.get(1..quoted.len().saturating_sub(1)).unwrap_or("").to_string()
}

/// A text as a JSON string, including quotes.
pub(super) fn quoted(text: &str) -> String {
    format!("\"{}\"", encode(text))
}

/// The fix that replaces a part of a text in JSON.
pub(crate) fn fix_in(text: &Text, part: Range<usize>, replacement: &str) -> Fix {
    Fix::safe(text.span_of(part), encode(replacement))
}

/// The fix that replaces a part of a code text in JSON. Its quotes are single ones, as in most lessons, unless the text
/// already uses double ones.
pub(crate) fn fix_in_code(text: &Text, part: Range<usize>, replacement: &str) -> Fix {
    let doubles = text.value.contains('"');
    let plain =
        !replacement.contains(['\'', '\\', '`']) && replacement.matches('"').count().is_multiple_of(2);
    let replacement = if plain && !doubles { replacement.replace('"', "'") } else { replacement.to_string() };
    fix_in(text, part, &replacement)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn escapes_decode_with_their_places() {
        let d = decode(r#"a\u00e9\n\ud83d\ude00b"#);
        assert_eq!((d.value.as_str(), d.faults.len()), ("aé\n😀b", 0));
        let b = d.value.find('b').unwrap();
        assert_eq!(d.map.span(b..b + 1), 21..22);
        assert_eq!(d.map.span(1..3), 1..7);
    }

    #[test]
    fn invalid_json_escapes_keep_their_intended_meaning() {
        for (raw, value, fault) in [
            (r"\ud83d", "\u{fffd}", StringFault::Half),
            (r"\ude00", "\u{fffd}", StringFault::Half),
            (r"\u12é", r"\u12é", StringFault::Escape('u')),
            (r"$\alpha$", r"$\alpha$", StringFault::Escape('a')),
            (r"it\'s", "it's", StringFault::Needless('\'')),
            ("a\tb", "a\tb", StringFault::Control('\t')),
            ("a\r\nb", "a\r\nb", StringFault::Line),
            ("a\\\nb", "ab", StringFault::Joined),
            ("a\"b", "a\"b", StringFault::Quote),
        ] {
            let d = decode(raw);
            assert_eq!((d.value.as_str(), d.faults.len(), d.faults[0].1), (value, 1, fault), "{raw}");
            assert_eq!(d.map.derived_len(), d.value.len(), "{raw}");
        }
    }

    #[test]
    fn a_text_is_encoded_for_the_string_that_contains_it() {
        assert_eq!(encode("a \"b\" \\tau\n"), r#"a \"b\" \\tau\n"#);
    }
}
