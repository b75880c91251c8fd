use labspec_finding::{Example, Layer, Rule, Severity};

/// The head of a `for` lacks one of its three parts.
pub const LOOP_HEAD: &Rule = &Rule {
    code: "loop-head",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Program,
    summary: "the head of a `for` lacks one of its three parts",
    why: "JavaScript rejects the whole text: the head needs a start, a condition and a step",
    bad: Example::Statements("for (let i = 0, i ⟦<⟧ 3, i++) { ctx.a = i }"),
    good: Example::Statements("for (let i = 0; i < 3; i++) { ctx.a = i }"),
};
