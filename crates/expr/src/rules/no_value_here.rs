use labspec_finding::{Example, Layer, Rule, Severity};

/// `value` is used where no control gives one.
pub const NO_VALUE_HERE: &Rule = &Rule {
    code: "no-value-here",
    severity: Severity::Error,
    layer: Layer::Program,
    summary: "`value` is used where no control gives one",
    why: "there is no such name: JavaScript throws there",
    bad: Example::Expression("⟦value⟧ * 2"),
    good: Example::Expression("data.time * 2"),
};
