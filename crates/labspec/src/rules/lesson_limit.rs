use labspec_finding::{Example, Layer, Rule, Severity};

/// A lesson beyond the limits.
pub const LESSON_LIMIT: &Rule = &Rule {
    code: "lesson-limit",
    severity: Severity::Error,
    layer: Layer::Source,
    summary: "a lesson is too large, has too many fences, or too many mistakes to list",
    why: "limits keep a checker responsive whatever it is given",
    bad: Example::Repeated("```text\nz = 1 m\n```\n\n", 2001),
    good: Example::Repeated("```text\nz = 1 m\n```\n\n", 20),
};
