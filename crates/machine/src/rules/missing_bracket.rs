use labspec_finding::{Example, Layer, Rule, Severity};

/// An opening bracket is missing.
pub const MISSING_BRACKET: &Rule = &Rule {
    code: "missing-bracket",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Program,
    summary: "an opening bracket is missing",
    why: "JavaScript rejects the whole text: conditions need parentheses, function bodies need braces",
    bad: Example::Statements("if ⟦data⟧.time > 1 { ctx.a = 1 }"),
    good: Example::Statements("if (data.time > 1) { ctx.a = 1 }"),
};
