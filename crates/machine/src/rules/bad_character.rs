use labspec_finding::{Example, Layer, Rule, Severity};

/// A character has no meaning in the language.
pub const BAD_CHARACTER: &Rule = &Rule {
    code: "bad-character",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Program,
    summary: "a character has no meaning in the language",
    why: "JavaScript rejects the whole text",
    bad: Example::Expression("data.qpos[7] ⟦×⟧ 2"),
    good: Example::Expression("data.qpos[7] * 2"),
};
