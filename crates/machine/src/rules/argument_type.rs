use labspec_finding::{Example, Layer, Rule, Severity};

/// A function gets an argument of the wrong type.
pub const ARGUMENT_TYPE: &Rule = &Rule {
    code: "argument-type",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Program,
    summary: "a function gets an argument of the wrong type",
    why: "JavaScript throws, or computes with what it converts the argument to",
    bad: Example::Statements("mj.mj_forward(⟦data⟧, model)"),
    good: Example::Statements("mj.mj_forward(model, data)"),
};
