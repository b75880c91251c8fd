use labspec_finding::{Example, Layer, Rule, Severity};

/// A name is computed where a literal string is required.
pub const COMPUTED_NAME: &Rule = &Rule {
    code: "computed-name",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Program,
    summary: "a name is computed where a literal string is required",
    why: "the named object could change during the run, so nothing could check it",
    bad: Example::Expression("data.body(⟦ball⟧).xpos[2]"),
    good: Example::Expression("data.body('ball').xpos[2]"),
};
