use labspec_finding::{Example, Layer, Rule, Severity};

/// An expression mixes `??` with `||` or `&&` without brackets.
pub const AMBIGUOUS_DEFAULT: &Rule = &Rule {
    code: "ambiguous-default",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Program,
    summary: "an expression mixes `??` with `||` or `&&` without brackets",
    why: "JavaScript rejects it, because it has two possible meanings",
    bad: Example::Expression("data.time ?? 0 ⟦||⟧ 1"),
    good: Example::Expression("data.time || 1"),
};
