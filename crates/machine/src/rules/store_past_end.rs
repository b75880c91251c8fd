use labspec_finding::{Example, Layer, Rule, Severity};

/// An assignment writes an element past the end.
pub const STORE_PAST_END: &Rule = &Rule {
    code: "store-past-end",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Program,
    summary: "an assignment writes an element past the end",
    why: "nothing is stored, and the page shows no error",
    bad: Example::Statements("let i = 7; i += Math.round(data.time) + 1; ⟦data.qpos[i] = 1⟧"),
    good: Example::Statements("let i = 7; data.qpos[i] = 1"),
};
