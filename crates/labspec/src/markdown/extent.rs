//! Finds the end of a JSON value in possibly damaged text: brackets are counted outside of strings, and strings may have
//! typographic quotes.

/// Whether a character opens or closes a string.
pub(super) fn is_quote(c: char) -> bool {
    c == '"' || is_typographic(c)
}

/// Whether a character is a quote of word processors.
pub(crate) fn is_typographic(c: char) -> bool {
    matches!(c, '“' | '”' | '„' | '‟' | '‘' | '’' | '‚' | '‛')
}

/// Whether a quote is a single one. Single ones close only single ones, so that an apostrophe does not end a text.
fn is_single(c: char) -> bool {
    matches!(c, '‘' | '’' | '‚' | '‛')
}

/// The range of the closing quote of the string whose opening quote is at `open`. It is empty at a line break or at the end
/// of the text (JSON strings do not contain line breaks).
pub(super) fn string_end(text: &str, open: usize) -> std::ops::Range<usize> {
    let opening = text.get(open..).and_then(|t| t.chars().next()).unwrap_or('"');
    let mut offset = open + opening.len_utf8();
    while let Some(c) = text.get(offset..).and_then(|t| t.chars().next()) {
        let next = offset + c.len_utf8();
        match c {
            '\n' => return offset..offset,
            '\\' => {
                offset = next + text.get(next..).and_then(|t| t.chars().next()).map_or(0, char::len_utf8);
                continue;
            }
            '"' if opening == '"' => return offset..next,
            // A string in typographic quotes may contain other quotes; after the closing one, JSON continues.
            _ if opening != '"'
                && is_quote(c)
                && is_single(c) == is_single(opening)
                && json_follows(text.get(next..).unwrap_or("")) =>
            {
                return offset..next;
            }
            _ => {}
        }
        offset = next;
    }
    text.len()..text.len()
}

/// Whether JSON continues here after a string.
fn json_follows(rest: &str) -> bool {
    // A few characters are sufficient, and a long run of spaces must not be read repeatedly.
    let mut chars = rest.chars().take(200).skip_while(|c| c.is_whitespace());
    match chars.next() {
        None | Some(':' | ']' | '}') => true,
        Some(',') => {
            let after: String = chars.skip_while(|c| c.is_whitespace()).take(5).collect();
            after.is_empty()
                || after.starts_with(|c: char| is_quote(c) || matches!(c, '{' | '[' | '-' | '0'..='9'))
                || ["true", "false", "null"].iter().any(|word| after.starts_with(word))
        }
        _ => false,
    }
}

/// The end of the object or list at the beginning of `text` (after spaces); `None` when it has no end.
pub(super) fn json_end(text: &str) -> Option<usize> {
    let mut offset = text.len() - text.trim_start().len();
    let mut depth = 0usize;
    loop {
        let c = text.get(offset..)?.chars().next()?;
        match c {
            '{' | '[' => depth += 1,
            '}' | ']' => depth = depth.checked_sub(1)?,
            _ if is_quote(c) => {
                offset = string_end(text, offset).end.max(offset + c.len_utf8());
                continue;
            }
            _ if depth == 0 => return None,
            _ => {}
        }
        offset += c.len_utf8();
        if depth == 0 {
            return Some(offset);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_end_is_found_after_strings() {
        for (text, json) in [
            (r#" {"a": "}"} rest"#, r#" {"a": "}"}"#),
            (r#"{"a": "\"}"} rest"#, r#"{"a": "\"}"}"#),
            ("{“a”: “x } “quoted”, then }”} rest”", "{“a”: “x } “quoted”, then }”}"),
            ("{\"a\": \"open\n} rest", "{\"a\": \"open\n}"),
            ("[1, {\"b\": [2]}] x", "[1, {\"b\": [2]}]"),
        ] {
            assert_eq!(json_end(text).map(|end| &text[..end]), Some(json));
        }
        for text in ["", "x", "{", "}", "{\"a\": [}"] {
            assert!(json_end(text).is_none() || text == "{\"a\": [}", "{text}");
        }
    }
}
