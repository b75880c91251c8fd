use labspec_finding::{Example, Layer, Rule, Severity};

/// A declaration reuses a name that already has a meaning.
pub const NAME_TAKEN: &Rule = &Rule {
    code: "name-taken",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Program,
    summary: "a declaration reuses a name that already has a meaning",
    why: "JavaScript rejects it, or the new name hides the one that a reader expects",
    bad: Example::Statements("let x = 1; let ⟦x⟧ = 2; ctx.x = x"),
    good: Example::Statements("let x = 1; x = 2; ctx.x = x"),
};
