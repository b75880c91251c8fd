use crate::source::BadText;
use labspec_finding::{Example, Finding, Layer, Rule, Severity};

/// A file is not UTF-8.
pub const NOT_UTF8: &Rule = &Rule {
    code: "not-utf8",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Source,
    summary: "a file is not UTF-8",
    why: "a page reads lessons as UTF-8, so letters outside ASCII appear as �",
    bad: Example::Files(&[("lesson.md", b"A fall of 5 \xe2\x9f\xa6\xb5\xe2\x9f\xa7m.\n")]),
    good: Example::Files(&[("lesson.md", b"A fall of 5 \xc2\xb5m.\n")]),
};

/// Reports a text that is not UTF-8. The caller sets the path.
pub fn not_utf8(bad: BadText) -> Finding {
    let (span, message) = match bad {
        BadText::Utf16 => (0..0, "this file is UTF-16".to_string()),
        BadText::Byte { offset, byte } => {
            let old = if byte >= 0xa0 {
                format!("; in Latin-1 it is `{}`", char::from(byte))
            } else {
                String::new()
            };
            (offset..offset + 1, format!("a byte here is not UTF-8 (0x{byte:02X}{old})"))
        }
    };
    Finding::error(NOT_UTF8, span, message)
        .why("a page reads lessons as UTF-8, so it shows such characters as �")
        .help("save the file as UTF-8")
}
