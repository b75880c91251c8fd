use labspec_finding::{Example, Layer, Rule, Severity};

/// A comparison contains a text that `+` joins.
pub const JOINED_FIRST: &Rule = &Rule {
    code: "joined-first",
    severity: Severity::Warning,
    exceptions: &[],
    layer: Layer::Program,
    summary: "a comparison applies to the text that `+` joins",
    why: "`+` binds more tightly than a comparison: the joined text is compared, and a text with words is neither smaller nor larger than a number",
    bad: Example::Expression("⟦'it moves ' + data.qvel[2] > 0⟧ ? 'up' : 'down'"),
    good: Example::Expression("'it moves ' + (data.qvel[2] > 0 ? 'up' : 'down')"),
};
