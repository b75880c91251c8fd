use labspec_finding::{Example, Layer, Rule, Severity};

/// The result of a function that gives nothing back is used.
pub const NO_RESULT: &Rule = &Rule {
    code: "no-result",
    severity: Severity::Error,
    layer: Layer::Program,
    summary: "the result of a function that gives nothing back is used",
    why: "it is undefined, and a computation with it gives NaN",
    bad: Example::Statements("ctx.x = ⟦mj.mj_step(model, data)⟧ + 1"),
    good: Example::Statements("mj.mj_forward(model, data); ctx.x = data.time + 1"),
};
