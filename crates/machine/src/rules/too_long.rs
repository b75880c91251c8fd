use labspec_finding::{Example, Layer, Rule, Severity};

/// The source text is too long.
pub const TOO_LONG: &Rule = &Rule {
    code: "too-long",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Program,
    summary: "the source text is too long",
    why: "limits keep the page responsive for any input",
    bad: Example::Long("data.time", " + data.time", 6000, ""),
    good: Example::Expression("data.time"),
};
