use labspec_finding::{Example, Layer, Rule, Severity};

/// An angle is converted twice.
pub const CONVERTED_TWICE: &Rule = &Rule {
    code: "converted-twice",
    severity: Severity::Warning,
    exceptions: &[],
    layer: Layer::Program,
    summary: "an angle is converted twice between degrees and radians",
    why: "the second conversion divides by 57.3 again: 45 degrees become 0.0137 rad",
    bad: Example::Statements("data.ctrl[0] = ⟦lib.rad(lib.rad(10 * data.time))⟧"),
    good: Example::Statements("data.ctrl[0] = lib.rad(10 * data.time)"),
};
