use labspec_finding::{Example, Layer, Rule, Severity};

/// `^` is used between numbers.
pub const XOR_AS_POWER: &Rule = &Rule {
    code: "xor-as-power",
    severity: Severity::Warning,
    exceptions: &[],
    layer: Layer::Program,
    summary: "`^` is used between numbers",
    why: "`^` is the bitwise exclusive or, not a power: `3 ^ 2` is 1",
    bad: Example::Expression("⟦data.qpos[7] ^ 2⟧"),
    good: Example::Expression("data.qpos[7] ** 2"),
};
