use labspec_finding::{Example, Layer, Rule, Severity};

/// A name that is computed where a literal string must stand.
pub const COMPUTED_NAME: &Rule = &Rule {
    code: "computed-name",
    severity: Severity::Error,
    layer: Layer::Program,
    summary: "a name that is computed where a literal string must stand",
    why: "which object is meant could change in the run, and nobody could check it",
    bad: Example::Expression("data.body(⟦ball⟧).xpos[2]"),
    good: Example::Expression("data.body('ball').xpos[2]"),
};
