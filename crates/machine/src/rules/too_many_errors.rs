use labspec_finding::{Example, Layer, Rule, Severity};

/// A text has so many mistakes that the rest is skipped.
pub const TOO_MANY_ERRORS: &Rule = &Rule {
    code: "too-many-errors",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Program,
    summary: "a text has so many mistakes that the rest is skipped",
    why: "the first mistakes explain most of the others",
    bad: Example::Long("", "§ + ", 100, "1"),
    good: Example::Expression("data.time"),
};
