use labspec_finding::{Example, Layer, Rule, Severity};

/// A comment that does not end.
pub const UNCLOSED_COMMENT: &Rule = &Rule {
    code: "unclosed-comment",
    severity: Severity::Error,
    layer: Layer::Program,
    summary: "a comment that does not end",
    why: "all that follows is read as part of the comment",
    bad: Example::OfHost,
    good: Example::OfHost,
};
