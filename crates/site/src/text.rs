//! Texts of lessons as parts of a page: as text, as attributes, and as JSON inside a script element.

pub(crate) use labspec::report::html::escape;
use std::fmt::Write;

/// JSON for a script element: nothing in it ends the element or opens another one.
pub(crate) fn json_in_script(json: &str) -> String {
    json.replace('<', "\\u003c")
        .replace('>', "\\u003e")
        .replace('\u{2028}', "\\u2028")
        .replace('\u{2029}', "\\u2029")
}

/// An address as the value of an attribute: bytes that are not part of addresses are percent escapes.
pub(crate) fn address(path: &str) -> String {
    let mut out = String::with_capacity(path.len());
    for &byte in path.as_bytes() {
        match byte {
            b'a'..=b'z' | b'A'..=b'Z' | b'0'..=b'9' | b'-' | b'_' | b'.' | b'~' | b'/' => {
                out.push(char::from(byte))
            }
            byte => {
                let _ = write!(out, "%{byte:02X}");
            }
        }
    }
    out
}

/// Letters and digits in lower case, by which an anchor is compared with a heading: sites write the rest in their own ways.
pub(crate) fn letters(text: &str) -> String {
    text.chars().filter(|c| c.is_alphanumeric()).flat_map(char::to_lowercase).collect()
}

/// A part of an id: letters and digits in lower case, joined by hyphens.
pub(crate) fn slug(text: &str) -> String {
    let mut out = String::new();
    for c in text.chars().flat_map(char::to_lowercase) {
        if c.is_alphanumeric() {
            out.push(c);
        } else if !out.ends_with('-') && !out.is_empty() {
            out.push('-');
        }
        if out.len() > 80 {
            break;
        }
    }
    out.trim_end_matches('-').to_string()
}

/// The first characters of a text, at the end of a word where possible.
pub(crate) fn shortened(text: &str, most: usize) -> String {
    if text.chars().count() <= most {
        return text.to_string();
    }
    let head: String = text.chars().take(most).collect();
    let end = head.rfind(' ').filter(|end| *end > most / 2).unwrap_or(head.len());
    format!("{} …", head.get(..end).unwrap_or(&head).trim_end())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn texts_act_on_nothing() {
        assert_eq!(escape("<b a=\"'\">&\tx\n\u{202e}y"), "&lt;b a=&quot;&#39;&quot;&gt;&amp;\tx\n\\u{202e}y");
        assert_eq!(json_in_script("\"</script><!--\""), "\"\\u003c/script\\u003e\\u003c!--\"");
        assert_eq!(address("a b/ü\"<.md"), "a%20b/%C3%BC%22%3C.md");
    }

    #[test]
    fn ids_are_made_of_letters() {
        assert_eq!(slug("How soft is a floor?"), "how-soft-is-a-floor");
        assert_eq!(slug("  \"x\" "), "x");
        assert_eq!(slug("?!"), "");
        assert_eq!(letters("1.2 A-b"), "12ab");
        assert_eq!(shortened("one two three", 9), "one two …");
    }
}
