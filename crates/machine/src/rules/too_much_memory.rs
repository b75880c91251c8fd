use labspec_finding::{Example, Layer, Rule, Severity};

/// Lists and records take too much memory.
pub const MEMORY: &Rule = &Rule {
    code: "too-much-memory",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Program,
    summary: "lists and records take too much memory",
    why: "without a limit the page could hang",
    bad: Example::Statements("ctx.all = []; for (let i = 0; i < 1e7; i++) ⟦ctx.all.push([i, i, i])⟧"),
    good: Example::Statements("ctx.all = [data.time]"),
};
