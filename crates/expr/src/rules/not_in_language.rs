use labspec_finding::{Example, Layer, Rule, Severity};

/// A construct of JavaScript that lessons do not have, on purpose.
pub const NOT_IN_LANGUAGE: &Rule = &Rule {
    code: "not-in-language",
    severity: Severity::Error,
    layer: Layer::Program,
    summary: "a construct of JavaScript that the language does not have, on purpose",
    why: "what a text computes must come to an end, touch nothing but what it is given, and give the same numbers everywhere",
    bad: Example::Statements("⟦eval⟧('data.time')"),
    good: Example::Statements("ctx.t = data.time"),
};
