use labspec_finding::{Example, Layer, Rule, Severity};

/// `break` or `continue` outside of a loop.
pub const OUTSIDE_LOOP: &Rule = &Rule {
    code: "outside-of-loop",
    severity: Severity::Error,
    layer: Layer::Program,
    summary: "`break` or `continue` outside of a loop",
    why: "there is no loop that it could leave or go on with",
    bad: Example::OfHost,
    good: Example::OfHost,
};
