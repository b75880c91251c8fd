use labspec_finding::{Example, Layer, Rule, Severity};

/// The name of a `for … of` loop is not declared.
pub const LOOP_WITHOUT_CONST: &Rule = &Rule {
    code: "loop-without-const",
    severity: Severity::Error,
    layer: Layer::Program,
    summary: "the name of a `for … of` loop is not declared",
    why: "it would be a variable of all texts",
    bad: Example::OfHost,
    good: Example::OfHost,
};
