use labspec_finding::{Example, Layer, Rule, Severity};

/// A string is not closed or contains an invalid escape.
pub const BAD_STRING: &Rule = &Rule {
    code: "bad-string",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Program,
    summary: "a string is not closed or contains an invalid escape",
    why: "everything that follows is read as part of the string",
    bad: Example::Expression("data.body(⟦'ball).xpos[2]⟧"),
    good: Example::Expression("data.body('ball').xpos[2]"),
};
