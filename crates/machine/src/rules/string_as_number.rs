use labspec_finding::{Example, Layer, Rule, Severity};

/// A string is used where a number is required.
pub const STRING_AS_NUMBER: &Rule = &Rule {
    code: "string-as-number",
    severity: Severity::Warning,
    exceptions: &[],
    layer: Layer::Program,
    summary: "a string is used where a number is required",
    why: "JavaScript converts it silently: `\"2\" + 1` is \"21\"",
    bad: Example::Expression("data.time - ⟦'1'⟧"),
    good: Example::Expression("data.time - 1"),
};
