use labspec_finding::{Example, Layer, Rule, Severity};

/// The head of a `for` lacks one of its three parts.
pub const LOOP_HEAD: &Rule = &Rule {
    code: "loop-head",
    severity: Severity::Error,
    layer: Layer::Program,
    summary: "the head of a `for` lacks one of its three parts",
    why: "JavaScript refuses the whole text: a start, a condition and a step stand there",
    bad: Example::OfHost,
    good: Example::OfHost,
};
