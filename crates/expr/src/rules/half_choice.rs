use labspec_finding::{Example, Layer, Rule, Severity};

/// A choice lacks one of its two values.
pub const HALF_CHOICE: &Rule = &Rule {
    code: "half-choice",
    severity: Severity::Error,
    layer: Layer::Program,
    summary: "a choice lacks one of its two values",
    why: "JavaScript refuses the whole text: a choice is written `test ? a : b`",
    bad: Example::OfHost,
    good: Example::OfHost,
};
