//! A scan of the text before the XML parser. It checks the limits (size, nesting, elements, attributes). It skips text
//! between elements with a warning, and inserts a missing blank between two attributes.
//!
//! The scan parses only as much of XML as it needs to count tags. It accepts a text that is not well-formed; the parser reports
//! the error.

use std::borrow::Cow;
use std::ops::Range;

use super::diagnostic::Diagnostics;
use crate::mjcf::rules;
use crate::mjcf::{MAX_ALL_ATTRIBUTES, MAX_ATTRIBUTES, MAX_DEPTH, MAX_ELEMENTS, MAX_TEXT};

/// Counts over all texts of a model so far.
#[derive(Debug, Default)]
pub(crate) struct TextCounts {
    elements: usize,
    attributes: usize,
}

/// A text that the XML parser can read.
#[derive(Debug)]
pub(crate) struct Prepared<'t> {
    pub(crate) text: Cow<'t, str>,
    /// The byte offsets, in the text as written, before which a blank was inserted.
    inserted: Vec<usize>,
}

impl Prepared<'_> {
    /// Converts a byte offset in the prepared text to one in the text as written.
    pub(crate) fn written(&self, byte: usize) -> usize {
        if self.inserted.is_empty() {
            return byte;
        }
        // The nth blank is n bytes after its offset in the text as written.
        let (mut low, mut high) = (0, self.inserted.len());
        while low < high {
            let n = (low + high) / 2;
            if self.inserted.get(n).is_some_and(|offset| offset + n < byte) { low = n + 1 } else { high = n }
        }
        byte - low
    }
}

/// The changes of a text before it is parsed.
#[derive(Debug, Default)]
struct TextChanges {
    /// Ranges that are replaced by blanks.
    blanks: Vec<Range<usize>>,
    /// The offsets at which a blank is missing.
    inserted: Vec<usize>,
}

/// Checks the limits of a text whose spans start at `base`. Returns the text with blanks in place of meaningless text between
/// elements, and with missing blanks between attributes inserted, as MuJoCo 3.14.0 reads such texts (measured:
/// `golden/cases.py`). `None`, with an error in the report, at the first limit that is exceeded.
pub(crate) fn prepare<'t>(
    text: &'t str,
    base: usize,
    counts: &mut TextCounts,
    report: &mut Diagnostics,
) -> Option<Prepared<'t>> {
    let mut changes = TextChanges::default();
    if !within_limits(text, base, counts, &mut changes, report) {
        return None;
    }
    let TextChanges { blanks, inserted } = changes;
    let mut text =
        if blanks.is_empty() { Cow::Borrowed(text) } else { Cow::Owned(replace_by_blanks(text, &blanks)) };
    if !inserted.is_empty() {
        let (mut out, mut offset) = (String::with_capacity(text.len() + inserted.len()), 0);
        for &place in &inserted {
            out.push_str(text.get(offset..place).unwrap_or(""));
            out.push(' ');
            offset = place;
        }
        out.push_str(text.get(offset..).unwrap_or(""));
        text = Cow::Owned(out);
    }
    Some(Prepared { text, inserted })
}

/// The text with these ranges replaced by blanks. The ranges are on character boundaries, and line breaks stay.
fn replace_by_blanks(text: &str, places: &[Range<usize>]) -> String {
    let (mut out, mut offset) = (String::with_capacity(text.len()), 0);
    for place in places {
        out.push_str(text.get(offset..place.start).unwrap_or(""));
        let passed = text.get(place.clone()).unwrap_or("").bytes();
        out.extend(passed.map(|b| if b == b'\n' { '\n' } else { ' ' }));
        offset = place.end;
    }
    out.push_str(text.get(offset..).unwrap_or(""));
    out
}

/// Skips the text of a range, with a warning if it is not blank.
fn skip_text(
    text: &str,
    range: Range<usize>,
    base: usize,
    changes: &mut TextChanges,
    report: &mut Diagnostics,
) {
    let Some(between) = text.get(range.clone()) else { return };
    // A text may start with a byte order mark.
    let between = between.strip_prefix('\u{feff}').filter(|_| range.start == 0).unwrap_or(between);
    let start = range.end - between.trim_start().len();
    let first = between.trim().lines().next().unwrap_or("").trim_end();
    if first.is_empty() {
        return;
    }
    changes.blanks.push(start..range.end);
    report
        .warning(
            rules::TEXT,
            base + start..base + start + first.len(),
            "this text between elements has no effect",
        )
        .why("MuJoCo ignores it too; it is often a tag that lost its `<`, or an extra `>`")
        .help("begin a tag with `<`, write a remark as a comment, <!-- … -->, or remove the text");
}

/// Whether the limits are observed. Necessary changes are appended to `changes`.
fn within_limits(
    text: &str,
    base: usize,
    counts: &mut TextCounts,
    changes: &mut TextChanges,
    report: &mut Diagnostics,
) -> bool {
    let size = report.bytes();
    if size > MAX_TEXT {
        let message = format!("the model has {size} bytes, but the limit is {MAX_TEXT}");
        report.error(rules::LIMIT, base..base, message);
        return false;
    }
    let bytes = text.as_bytes();
    let (mut offset, mut depth, mut ended) = (0, 0usize, false);
    while let Some(open) = find(bytes, offset, b"<") {
        // Text directly after the root element is an error in MuJoCo too. The parser reports it.
        if !ended {
            skip_text(text, offset..open, base, changes, report);
        }
        let rest = bytes.get(open..).unwrap_or_default();
        offset = if rest.starts_with(b"<!--") {
            ended = false;
            after(bytes, open + 4, b"-->")
        } else if rest.starts_with(b"<![CDATA[") {
            let end = after(bytes, open + 9, b"]]>");
            skip_text(text, open..end, base, changes, report);
            ended = false;
            end
        } else if rest.starts_with(b"<?") {
            after(bytes, open + 2, b"?>")
        } else if rest.starts_with(b"<!") {
            refuse_declaration(base + open, report);
            return false;
        } else if rest.starts_with(b"</") {
            depth = depth.saturating_sub(1);
            ended |= depth == 0;
            after(bytes, open + 2, b">")
        } else {
            let tag = tag(bytes, open + 1);
            if !tag.closed {
                depth += 1;
            }
            ended |= depth == 0;
            if !tag_within_limits(&tag, base + open, base, depth, counts, report) {
                return false;
            }
            changes.inserted.extend(&tag.joined);
            tag.end
        };
    }
    if !ended && depth == 0 && counts.elements > 0 {
        skip_text(text, offset..text.len(), base, changes, report);
    }
    true
}

/// Reports a declaration of a document type or an entity, which starts with two characters.
fn refuse_declaration(offset: usize, report: &mut Diagnostics) {
    report
        .error(rules::XML, offset..offset + 2, "the model declares a document type or an entity")
        .why("entities could make a small file expand without bound")
        .help("remove the `<!…>` declaration");
}

/// Whether the limits are observed, including the element that starts with the tag at `open`, `depth` levels deep.
fn tag_within_limits(
    tag: &ScannedTag,
    open: usize,
    base: usize,
    depth: usize,
    counts: &mut TextCounts,
    report: &mut Diagnostics,
) -> bool {
    counts.elements += 1;
    counts.attributes += tag.attributes;
    for &offset in &tag.joined {
        report
            .warning(rules::TEXT, base + offset..base + offset, "a space is missing between two attributes")
            .help("put a space here");
    }
    let name = open..open + 1;
    if tag.attributes > MAX_ATTRIBUTES {
        report.error(rules::LIMIT, name, format!("an element has more than {MAX_ATTRIBUTES} attributes"));
    } else if let Some(offset) = tag.namespace {
        report
            .error(rules::XML, base + offset..base + offset + 5, "the model declares an XML namespace")
            .help("remove the `xmlns` attribute");
    } else if depth > MAX_DEPTH {
        report
            .error(rules::LIMIT, name, format!("elements are nested more than {MAX_DEPTH} deep"))
            .help("split the kinematic chain into several trees");
    } else if counts.elements > MAX_ELEMENTS {
        report.error(rules::LIMIT, name, format!("the model has more than {MAX_ELEMENTS} elements"));
    } else if counts.attributes > MAX_ALL_ATTRIBUTES {
        let message = format!("the model has more than {MAX_ALL_ATTRIBUTES} attributes");
        report.error(rules::LIMIT, name, message);
    } else {
        return true;
    }
    false
}

struct ScannedTag {
    end: usize,
    attributes: usize,
    closed: bool,
    /// The offset at which a namespace is declared.
    namespace: Option<usize>,
    /// The offsets at which an attribute starts directly after the quotes of another.
    joined: Vec<usize>,
}

/// A start tag from its name to the `>` outside of quotes.
fn tag(bytes: &[u8], start: usize) -> ScannedTag {
    let (mut quote, mut attributes, mut last, mut namespace) = (None, 0, b'<', None);
    let mut joined = Vec::new();
    for (i, &b) in bytes.iter().enumerate().skip(start) {
        match quote {
            Some(q) if b == q => {
                quote = None;
                if begins_attribute(bytes.get(i + 1..).unwrap_or_default()) {
                    joined.push(i + 1);
                }
            }
            Some(_) => {}
            None => match b {
                b'"' | b'\'' => quote = Some(b),
                b'=' => attributes += 1,
                b'>' => {
                    return ScannedTag { end: i + 1, attributes, closed: last == b'/', namespace, joined };
                }
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
    ScannedTag { end: bytes.len(), attributes, closed: true, namespace, joined }
}

/// Whether the bytes start with a name, an equals sign and a quote.
fn begins_attribute(bytes: &[u8]) -> bool {
    let name = bytes.iter().take_while(|b| b.is_ascii_alphanumeric() || **b == b'_').count();
    let mut rest = bytes.iter().skip(name).filter(|b| !b.is_ascii_whitespace());
    bytes.first().is_some_and(u8::is_ascii_alphabetic)
        && rest.next() == Some(&b'=')
        && rest.next().is_some_and(|b| matches!(b, b'"' | b'\''))
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
        let mut report = Diagnostics::new();
        let base = report.source(None, text.into());
        prepare(text, base, &mut TextCounts::default(), &mut report);
        report.finish().first().map(|d| d.code)
    }

    #[test]
    fn hostile_sizes_are_refused_before_parsing() {
        assert_eq!(code_of("<a b='>' c=\"<\"/><!-- <<< --><d></d>"), None);
        assert_eq!(code_of(&"<a>".repeat(MAX_DEPTH + 1)), Some(rules::LIMIT.code));
        assert_eq!(code_of(&"<a/>".repeat(MAX_ELEMENTS + 1)), Some(rules::LIMIT.code));
        assert_eq!(code_of(&format!("<a {}/>", "x='' ".repeat(MAX_ATTRIBUTES + 1))), Some(rules::LIMIT.code));
        assert_eq!(code_of("<!DOCTYPE x [<!ENTITY a 'b'>]><a/>"), Some(rules::XML.code));
        assert_eq!(code_of("<a b='"), None);
        assert_eq!(code_of("<a  xmlns:b='c'/>"), Some(rules::XML.code));
    }

    #[test]
    fn text_between_elements_becomes_blanks_of_the_same_length() {
        for (text, expected) in [
            ("<a><b/>> <c/></a>", "<a><b/>  <c/></a>"),
            ("é<a>\n x=\"1\"\n é/></a>", "  <a>\n      \n     </a>"),
            ("<a><![CDATA[<b/>]]>&no;</a>", "<a>                    </a>"),
            ("<a> \n </a>", "<a> \n </a>"),
            // Text after the root is an error, so it is not replaced.
            ("<a/>>", "<a/>>"),
            ("<a></a>x<!-- y -->z", "<a></a>x<!-- y --> "),
            ("<a b='>'>x</a", "<a b='>'> </a"),
        ] {
            let mut report = Diagnostics::new();
            let base = report.source(None, text.into());
            let blanked = prepare(text, base, &mut TextCounts::default(), &mut report).unwrap();
            assert_eq!(blanked.text, expected);
            assert!(report.is_clean());
        }
    }

    #[test]
    fn blanks_between_attributes_move_no_place() {
        let text = "<a b='1'c=\"2\"d ='3'>x<e f='1'2'/></a>";
        let mut report = Diagnostics::new();
        let base = report.source(None, text.into());
        let prepared = prepare(text, base, &mut TextCounts::default(), &mut report).unwrap();
        assert_eq!(prepared.text, "<a b='1' c=\"2\" d ='3'> <e f='1'2'/></a>");
        for (byte, c) in prepared.text.char_indices().filter(|(_, c)| !c.is_whitespace()) {
            let written = prepared.written(byte);
            assert_eq!(text.get(written..).and_then(|rest| rest.chars().next()), Some(c), "{byte} {written}");
        }
        assert_eq!(report.finish().len(), 3);
    }
}
