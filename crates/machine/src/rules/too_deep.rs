use labspec_finding::{Example, Layer, Rule, Severity};

/// An expression is nested too deeply.
pub const TOO_DEEP: &Rule = &Rule {
    code: "too-deep",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Program,
    summary: "an expression is nested too deeply",
    why: "limits keep the page responsive for any input",
    bad: Example::Long("", "(", 300, "data.time"),
    good: Example::Expression("(data.time)"),
};
