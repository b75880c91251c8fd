use labspec_finding::{Example, Layer, Rule, Severity};

/// A block declares a variable again.
pub const LOST_DECLARATION: &Rule = &Rule {
    code: "lost-declaration",
    severity: Severity::Warning,
    exceptions: &[],
    layer: Layer::Program,
    summary: "a block declares a variable again, and nothing reads the new one",
    why: "`let` makes a new variable, which ends with its block: the outer variable keeps its value",
    bad: Example::Statements("let f = 0; if (data.time > 0.05) { let ⟦f⟧ = 5 } data.ctrl[0] = f"),
    good: Example::Statements("let f = 0; if (data.time > 0.05) { f = 5 } data.ctrl[0] = f"),
};
