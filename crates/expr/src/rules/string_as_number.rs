use labspec_finding::{Example, Layer, Rule, Severity};

/// A string stands where a number is needed.
pub const STRING_AS_NUMBER: &Rule = &Rule {
    code: "string-as-number",
    severity: Severity::Warning,
    layer: Layer::Program,
    summary: "a string stands where a number is needed",
    why: "JavaScript converts it silently: `\"2\" + 1` is \"21\"",
    bad: Example::OfHost,
    good: Example::OfHost,
};
