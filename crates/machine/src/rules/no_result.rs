use labspec_finding::{Example, Layer, Rule, Severity};

/// An expression uses the result of a function that returns nothing.
pub const NO_RESULT: &Rule = &Rule {
    code: "no-result",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Program,
    summary: "an expression uses the result of a function that returns nothing",
    why: "the result is undefined, and a computation with it gives NaN",
    bad: Example::Statements("ctx.x = ⟦mj.mj_step(model, data)⟧ + 1"),
    good: Example::Statements("mj.mj_forward(model, data); ctx.x = data.time + 1"),
};
