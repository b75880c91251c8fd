use labspec_finding::{Example, Layer, Rule, Severity};

/// `break` or `continue` is outside a loop.
pub const OUTSIDE_LOOP: &Rule = &Rule {
    code: "outside-of-loop",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Program,
    summary: "`break` or `continue` is outside a loop",
    why: "there is no loop to leave or to continue",
    bad: Example::Statements("if (data.time > 1) { ⟦break⟧ }"),
    good: Example::Statements("if (data.time > 1) { return }"),
};
