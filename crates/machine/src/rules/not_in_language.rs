use labspec_finding::{Example, Layer, Rule, Severity};

/// The language deliberately leaves out a construct of JavaScript.
pub const NOT_IN_LANGUAGE: &Rule = &Rule {
    code: "not-in-language",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Program,
    summary: "the language deliberately leaves out a construct of JavaScript",
    why: "a text must come to an end, touch only what it is given, and give the same numbers everywhere",
    bad: Example::Statements("⟦eval⟧('data.time')"),
    good: Example::Statements("ctx.t = data.time"),
};
