use labspec_finding::{Example, Layer, Rule, Severity};

/// Decided by `failure_finding` in `listings/outcome.rs`.
pub const LISTING_FAILS: &Rule = &Rule {
    code: "listing-fails",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Run,
    summary: "a listing ends with an error, or exceeds a limit (`labspec check --listings`)",
    why: "a student who runs the program does not see the output of the lesson",
    bad: Example::Lesson(
        "```python\nheights = [1.0, 0.5]\n⟦print(heights[2])⟧\n```\nOutput:\n```text\n0.5\n```\n",
    ),
    good: Example::Lesson(
        "```python\nheights = [1.0, 0.5]\nprint(heights[1])\n```\nOutput:\n```text\n0.5\n```\n",
    ),
};
