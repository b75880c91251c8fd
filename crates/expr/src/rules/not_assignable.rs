use labspec_finding::{Example, Layer, Rule, Severity};

/// Something stands left of `=` that cannot hold a value.
pub const NOT_ASSIGNABLE: &Rule = &Rule {
    code: "not-assignable",
    severity: Severity::Error,
    layer: Layer::Program,
    summary: "something stands left of `=` that cannot hold a value",
    why: "JavaScript refuses the whole text, or nothing is stored",
    bad: Example::OfHost,
    good: Example::OfHost,
};
