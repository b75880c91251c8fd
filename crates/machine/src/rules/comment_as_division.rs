use labspec_finding::{Example, Layer, Rule, Severity};

/// `//` begins a comment, and a number follows.
pub const COMMENT_AS_DIVISION: &Rule = &Rule {
    code: "comment-as-division",
    severity: Severity::Warning,
    exceptions: &[],
    layer: Layer::Program,
    summary: "`//` begins a comment where a whole division was meant",
    why: "`//` divides in Python; in JavaScript everything after it is ignored",
    bad: Example::Expression("10 * data.qpos[2] ⟦// 3⟧"),
    good: Example::Expression("Math.floor(10 * data.qpos[2] / 3)"),
};
