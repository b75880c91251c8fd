use labspec_finding::{Example, Layer, Rule, Severity};

/// A statement behind a `return`, a `break` or a `continue`.
pub const UNREACHABLE: &Rule = &Rule {
    code: "never-reached",
    severity: Severity::Warning,
    layer: Layer::Program,
    summary: "a statement behind a `return`, a `break` or a `continue`",
    why: "it never happens",
    bad: Example::OfHost,
    good: Example::OfHost,
};
