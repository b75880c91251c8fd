use labspec_finding::{Example, Layer, Rule, Severity};

/// A lab or a quiz without any fence.
pub const FENCE_MISSING: &Rule = &Rule {
    code: "fence-missing",
    severity: Severity::Error,
    layer: Layer::Source,
    summary: "a lab or a quiz stands in the text without a fence",
    why: "students read the JSON instead of using what it describes",
    bad: Example::Lesson(
        "Now a question.\n\n⟦{⟧\"id\": \"fall\", \"questions\": [{\"kind\": \"open\", \"q\": \"Why?\"}]}\n",
    ),
    good: Example::Lesson(
        "Now a question.\n\n```quiz\n{\"id\": \"fall\", \"questions\": [{\"kind\": \"open\", \"q\": \"Why?\"}]}\n```\n",
    ),
};
