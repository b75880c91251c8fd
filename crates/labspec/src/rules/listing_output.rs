use labspec_finding::{Example, Layer, Rule, Severity};

/// Decided by `compare_output` in `listings/outcome.rs`.
pub const LISTING_OUTPUT: &Rule = &Rule {
    code: "listing-output",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Claim,
    summary: "the output in the lesson is not what the listing prints (`labspec check --listings`)",
    why: "a student who runs the program sees another output",
    bad: Example::Lesson(
        "```python\nprint(f\"t = {(2 * 0.95 / 9.81) ** 0.5:.4f} s\")\n```\nOutput:\n```text\nt = ⟦0.4410⟧ s\n```\n",
    ),
    good: Example::Lesson(
        "```python\nprint(f\"t = {(2 * 0.95 / 9.81) ** 0.5:.4f} s\")\n```\nOutput:\n```text\nt = 0.4401 s\n```\n",
    ),
};
