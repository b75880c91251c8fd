//! Decodes a JSON string and remembers where every byte came from.

use crate::source::SourceMap;

/// The text of a string literal and the map to its source. `raw` stands between the quotes; the map is
/// relative to the first byte of `raw`. `None` when an escape is wrong (half of a surrogate pair).
pub(super) fn decode(raw: &str) -> Option<(String, SourceMap)> {
    let (mut value, mut map) = (String::with_capacity(raw.len()), SourceMap::default());
    let mut at = 0;
    while let Some(rest) = raw.get(at..).filter(|rest| !rest.is_empty()) {
        let plain = rest.find('\\').unwrap_or(rest.len());
        if plain > 0 {
            value.push_str(rest.get(..plain)?);
            map.push_verbatim(at..at + plain);
            at += plain;
            continue;
        }
        let (c, len) = escape(rest)?;
        value.push(c);
        map.push_whole(c.len_utf8(), at..at + len);
        at += len;
    }
    Some((value, map))
}

/// The character of the escape that `text` begins with, and its length in bytes.
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
            // Beyond U+FFFF, JSON writes UTF-16: a high and a low surrogate.
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn escapes_decode_with_their_places() {
        let (value, map) = decode(r#"a\u00e9\n\ud83d\ude00b"#).unwrap();
        assert_eq!(value, "aé\n😀b");
        let b = value.find('b').unwrap();
        assert_eq!(map.span(b..b + 1), 21..22);
        assert_eq!(map.span(1..3), 1..7);
    }

    #[test]
    fn half_a_pair_is_no_character() {
        assert_eq!(decode(r"\ud83d"), None);
        assert_eq!(decode(r"\ude00\ud83d"), None);
        assert_eq!(decode(r"\u12é"), None);
    }
}
