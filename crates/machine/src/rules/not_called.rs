use labspec_finding::{Example, Layer, Rule, Severity};

/// A function is named but not called.
pub const NOT_CALLED: &Rule = &Rule {
    code: "not-called",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Program,
    summary: "a function is named but not called",
    why: "nothing happens, or the page shows the source of the function",
    bad: Example::Statements("⟦mj.mj_forward⟧"),
    good: Example::Statements("mj.mj_forward(model, data)"),
};
