use labspec_finding::{Example, Layer, Rule, Severity};

/// A string that does not end, or holds a broken escape.
pub const BAD_STRING: &Rule = &Rule {
    code: "bad-string",
    severity: Severity::Error,
    layer: Layer::Program,
    summary: "a string that does not end, or holds a broken escape",
    why: "all that follows is read as part of the string",
    bad: Example::OfHost,
    good: Example::OfHost,
};
