use labspec_finding::{Example, Layer, Rule, Severity};

/// A function gets too few or too many arguments.
pub const ARGUMENT_COUNT: &Rule = &Rule {
    code: "argument-count",
    severity: Severity::Error,
    exceptions: &[(
        Severity::Warning,
        "if the call still runs: an argument is ignored, or a function of the lesson gets `undefined`",
    )],
    layer: Layer::Program,
    summary: "a function gets too few or too many arguments",
    why: "JavaScript passes undefined for a missing argument and ignores an extra one",
    bad: Example::Expression("⟦Math.sin()⟧"),
    good: Example::Expression("Math.sin(data.time)"),
};
