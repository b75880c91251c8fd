use labspec_finding::{Example, Layer, Rule, Severity};

/// A function gets an argument of the wrong kind.
pub const ARGUMENT_TYPE: &Rule = &Rule {
    code: "argument-type",
    severity: Severity::Error,
    layer: Layer::Program,
    summary: "a function gets an argument of the wrong kind",
    why: "JavaScript throws there, or computes with what it makes of the argument",
    bad: Example::Statements("mj.mj_forward(⟦data⟧, model)"),
    good: Example::Statements("mj.mj_forward(model, data)"),
};
