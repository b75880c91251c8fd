use labspec_finding::{Example, Layer, Rule, Severity};

/// A lab or a quiz is not inside a fence.
pub const FENCE_MISSING: &Rule = &Rule {
    code: "fence-missing",
    severity: Severity::Error,
    layer: Layer::Source,
    summary: "a lab or a quiz is not inside a fence",
    why: "students see the JSON instead of the lab or the quiz",
    bad: Example::Lesson(
        "Now a question.\n\n⟦{⟧\"id\": \"fall\", \"questions\": [{\"kind\": \"open\", \"q\": \"Why?\"}]}\n",
    ),
    good: Example::Lesson(
        "Now a question.\n\n```quiz\n{\"id\": \"fall\", \"questions\": [{\"kind\": \"open\", \"q\": \"Why?\"}]}\n```\n",
    ),
};
