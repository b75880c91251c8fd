use labspec_finding::{Example, Layer, Rule, Severity};

/// A comment is not closed.
pub const UNCLOSED_COMMENT: &Rule = &Rule {
    code: "unclosed-comment",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Program,
    summary: "a comment is not closed",
    why: "everything that follows is read as part of the comment",
    bad: Example::Expression("data.time ⟦/*⟧ in s"),
    good: Example::Expression("data.time /* in s */"),
};
