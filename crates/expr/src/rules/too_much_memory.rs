use labspec_finding::{Example, Layer, Rule, Severity};

/// Lists and records that take too much memory.
pub const MEMORY: &Rule = &Rule {
    code: "too-much-memory",
    severity: Severity::Error,
    layer: Layer::Program,
    summary: "lists and records that take too much memory",
    why: "the page of a student would stand still",
    bad: Example::Statements("ctx.all = []; for (let i = 0; i < 1e7; i++) ⟦ctx.all.push([i, i, i])⟧"),
    good: Example::Statements("ctx.all = [data.time]"),
};
