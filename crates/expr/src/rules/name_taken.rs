use labspec_finding::{Example, Layer, Rule, Severity};

/// A declaration of a name that already means something.
pub const NAME_TAKEN: &Rule = &Rule {
    code: "name-taken",
    severity: Severity::Error,
    layer: Layer::Program,
    summary: "a declaration of a name that already means something",
    why: "JavaScript refuses it, or the new name hides what a reader expects",
    bad: Example::OfHost,
    good: Example::OfHost,
};
