use labspec_finding::{Example, Layer, Rule, Severity};

/// An expression reads a member or an element of a value that has none.
pub const NO_PARTS: &Rule = &Rule {
    code: "no-parts",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Program,
    summary: "an expression reads a member or an element of a value that has none",
    why: "JavaScript throws and stops the whole text",
    bad: Example::Statements("ctx.a = ⟦ctx.nothing.x⟧"),
    good: Example::Statements("ctx.nothing = {x: 1}; ctx.a = ctx.nothing.x"),
};
