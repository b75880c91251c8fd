use labspec_finding::{Example, Layer, Rule, Severity};

/// A number that is not written as the language writes numbers.
pub const BAD_NUMBER: &Rule = &Rule {
    code: "bad-number",
    severity: Severity::Error,
    layer: Layer::Program,
    summary: "a number that is not written as the language writes numbers",
    why: "JavaScript refuses the whole text",
    bad: Example::Expression("⟦2data⟧.qpos[7]"),
    good: Example::Expression("2 * data.qpos[7]"),
};
