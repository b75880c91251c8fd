use labspec_finding::{Example, Layer, Rule, Severity};

/// Something stands where it has no place.
pub const MISPLACED: &Rule = &Rule {
    code: "misplaced",
    severity: Severity::Error,
    layer: Layer::Program,
    summary: "something stands where it has no place",
    why: "JavaScript refuses the whole text",
    bad: Example::Statements("⟦else⟧ { ctx.a = 1 }"),
    good: Example::Statements("if (data.time > 1) { ctx.a = 0 } else { ctx.a = 1 }"),
};
