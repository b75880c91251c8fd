use labspec_finding::{Example, Layer, Rule, Severity};

/// An opening bracket is missing.
pub const MISSING_BRACKET: &Rule = &Rule {
    code: "missing-bracket",
    severity: Severity::Error,
    layer: Layer::Program,
    summary: "an opening bracket is missing",
    why: "JavaScript refuses the whole text: conditions stand in parentheses, bodies of functions in braces",
    bad: Example::OfHost,
    good: Example::OfHost,
};
