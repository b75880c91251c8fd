use labspec_finding::{Example, Layer, Rule, Severity};

/// Lists and records that take too much memory.
pub const MEMORY: &Rule = &Rule {
    code: "too-much-memory",
    severity: Severity::Error,
    layer: Layer::Program,
    summary: "lists and records that take too much memory",
    why: "whoever waits for it would wait forever",
    bad: Example::Statements("ctx.all = []; for (let i = 0; i < 1e7; i++) ⟦ctx.all.push([i, i, i])⟧"),
    good: Example::Statements("ctx.all = [data.time]"),
};
