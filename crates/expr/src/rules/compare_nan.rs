use labspec_finding::{Example, Layer, Rule, Severity};

/// A comparison with NaN.
pub const COMPARE_NAN: &Rule = &Rule {
    code: "compare-nan",
    severity: Severity::Warning,
    layer: Layer::Program,
    summary: "a comparison with NaN",
    why: "NaN equals nothing, not even itself",
    bad: Example::OfHost,
    good: Example::OfHost,
};
