//! Limits that must hold before a text reaches the XML parser: size, nesting, elements, attributes.
//!
//! The scan understands just enough of XML to count tags. A text that is not well-formed passes it and is
//! explained by the parser.

use super::diagnostic::{Report, code};
use super::{MAX_ATTRIBUTES, MAX_DEPTH, MAX_ELEMENTS, MAX_TEXT};

/// Checks the limits of a text whose spans begin at `base`; `elements` counts those of all texts of a model.
/// `false` after reporting the first limit that is exceeded.
pub(crate) fn within_limits(text: &str, base: usize, elements: &mut usize, report: &mut Report) -> bool {
    let size = report.bytes();
    if size > MAX_TEXT {
        let message = format!("the model has {size} bytes, at most {MAX_TEXT} are read");
        report.error(code::LIMIT, base..base, message);
        return false;
    }
    let bytes = text.as_bytes();
    let (mut at, mut depth) = (0, 0usize);
    while let Some(open) = find(bytes, at, b"<") {
        let rest = bytes.get(open..).unwrap_or_default();
        at = if rest.starts_with(b"<!--") {
            after(bytes, open + 4, b"-->")
        } else if rest.starts_with(b"<![CDATA[") {
            after(bytes, open + 9, b"]]>")
        } else if rest.starts_with(b"<?") {
            after(bytes, open + 2, b"?>")
        } else if rest.starts_with(b"<!") {
            report
                .error(
                    code::XML,
                    base + open..base + open + 2,
                    "a document type or entity is declared, which a model has no use for",
                )
                .why("entities could make a small file expand without bound")
                .help("remove the `<!…>` declaration");
            return false;
        } else if rest.starts_with(b"</") {
            depth = depth.saturating_sub(1);
            after(bytes, open + 2, b">")
        } else {
            let tag = tag(bytes, open + 1);
            *elements += 1;
            let name = base + open..base + open + 1;
            if tag.attributes > MAX_ATTRIBUTES {
                report.error(
                    code::LIMIT,
                    name,
                    format!("an element has more than {MAX_ATTRIBUTES} attributes"),
                );
                return false;
            }
            if let Some(at) = tag.namespace {
                report
                    .error(
                        code::XML,
                        base + at..base + at + 5,
                        "an XML namespace is declared, which a model has no use for",
                    )
                    .help("remove the `xmlns` attribute");
                return false;
            }
            if !tag.closed {
                depth += 1;
            }
            if depth > MAX_DEPTH {
                report
                    .error(code::LIMIT, name, format!("elements are nested more than {MAX_DEPTH} deep"))
                    .help("a kinematic chain this long can be cut into several trees");
                return false;
            }
            if *elements > MAX_ELEMENTS {
                report.error(code::LIMIT, name, format!("the model has more than {MAX_ELEMENTS} elements"));
                return false;
            }
            tag.end
        };
    }
    true
}

struct Tag {
    end: usize,
    attributes: usize,
    closed: bool,
    /// Where a namespace is declared.
    namespace: Option<usize>,
}

/// A start tag from its name on: to the `>` outside of quotes.
fn tag(bytes: &[u8], start: usize) -> Tag {
    let (mut quote, mut attributes, mut last, mut namespace) = (None, 0, b'<', None);
    for (i, &b) in bytes.iter().enumerate().skip(start) {
        match quote {
            Some(q) if b == q => quote = None,
            Some(_) => {}
            None => match b {
                b'"' | b'\'' => quote = Some(b),
                b'=' => attributes += 1,
                b'>' => return Tag { end: i + 1, attributes, closed: last == b'/', namespace },
                b'x' if last.is_ascii_whitespace()
                    && bytes.get(i..).is_some_and(|b| b.starts_with(b"xmlns")) =>
                {
                    namespace = namespace.or(Some(i));
                }
                _ => {}
            },
        }
        last = b;
    }
    Tag { end: bytes.len(), attributes, closed: true, namespace }
}

fn find(bytes: &[u8], from: usize, what: &[u8]) -> Option<usize> {
    bytes.get(from..)?.windows(what.len()).position(|w| w == what).map(|i| from + i)
}

fn after(bytes: &[u8], from: usize, what: &[u8]) -> usize {
    find(bytes, from, what).map_or(bytes.len(), |i| i + what.len())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn code_of(text: &str) -> Option<&'static str> {
        let mut report = Report::new();
        let base = report.source(None, text.into());
        within_limits(text, base, &mut 0, &mut report);
        report.finish().first().map(|d| d.code)
    }

    #[test]
    fn hostile_sizes_are_refused_before_parsing() {
        assert_eq!(code_of("<a b='>' c=\"<\"/><!-- <<< --><d></d>"), None);
        assert_eq!(code_of(&"<a>".repeat(MAX_DEPTH + 1)), Some(code::LIMIT));
        assert_eq!(code_of(&"<a/>".repeat(MAX_ELEMENTS + 1)), Some(code::LIMIT));
        assert_eq!(code_of(&format!("<a {}/>", "x='' ".repeat(MAX_ATTRIBUTES + 1))), Some(code::LIMIT));
        assert_eq!(code_of("<!DOCTYPE x [<!ENTITY a 'b'>]><a/>"), Some(code::XML));
        assert_eq!(code_of("<a b='"), None);
        assert_eq!(code_of("<a  xmlns:b='c'/>"), Some(code::XML));
    }
}
