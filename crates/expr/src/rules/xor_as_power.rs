use labspec_finding::{Example, Layer, Rule, Severity};

/// `^` between numbers.
pub const XOR_AS_POWER: &Rule = &Rule {
    code: "xor-as-power",
    severity: Severity::Warning,
    layer: Layer::Program,
    summary: "`^` between numbers",
    why: "it is the bitwise exclusive or, and not a power: `3 ^ 2` is 1",
    bad: Example::OfHost,
    good: Example::OfHost,
};
