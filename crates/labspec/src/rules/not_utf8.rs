use labspec_finding::{Example, Layer, Rule, Severity};

/// A file is not UTF-8.
pub const NOT_UTF8: &Rule = &Rule {
    code: "not-utf8",
    severity: Severity::Error,
    layer: Layer::Source,
    summary: "a file is not UTF-8",
    why: "a page reads lessons as UTF-8, so letters beyond plain English appear as a black diamond",
    bad: Example::Files(&[("lesson.md", b"A fall of 5 \xe2\x9f\xa6\xb5\xe2\x9f\xa7m.\n")]),
    good: Example::Files(&[("lesson.md", b"A fall of 5 \xc2\xb5m.\n")]),
};
