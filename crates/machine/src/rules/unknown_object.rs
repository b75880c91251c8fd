use labspec_finding::{Example, Layer, Rule, Severity};

/// The model has no object of this name.
pub const UNKNOWN_OBJECT: &Rule = &Rule {
    code: "unknown-object",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Program,
    summary: "the model has no object of this name",
    why: "JavaScript throws",
    bad: Example::Expression("data.body(⟦'bal'⟧).xpos[2]"),
    good: Example::Expression("data.body('ball').xpos[2]"),
};
