use labspec_finding::{Example, Layer, Rule, Severity};

/// A number is malformed.
pub const BAD_NUMBER: &Rule = &Rule {
    code: "bad-number",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Program,
    summary: "a number is malformed",
    why: "JavaScript rejects the whole text",
    bad: Example::Expression("⟦2data⟧.qpos[7]"),
    good: Example::Expression("2 * data.qpos[7]"),
};
