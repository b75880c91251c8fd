use labspec_finding::{Example, Layer, Rule, Severity};

/// A function of the host fails.
pub const HOST_CALL: &Rule = &Rule {
    code: "call-failed",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Program,
    summary: "a called function fails",
    why: "JavaScript throws and stops the whole text",
    bad: Example::Statements("⟦mj.mj_resetDataKeyframe(model, data, 5)⟧"),
    good: Example::Statements("if (data.time > 5) mj.mj_resetData(model, data)"),
};
