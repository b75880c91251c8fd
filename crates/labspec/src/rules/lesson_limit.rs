use labspec_finding::{Example, Layer, Rule, Severity};

/// Decided by `limit` in `lint/load.rs`.
pub const LESSON_LIMIT: &Rule = &Rule {
    code: "lesson-limit",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Source,
    summary: "a lesson is too large, or has too many fences or too many mistakes to list",
    why: "limits keep the checker responsive for any input",
    bad: Example::Repeated("```text\nz = 1 m\n```\n\n", 2001),
    good: Example::Repeated("```text\nz = 1 m\n```\n\n", 20),
};
