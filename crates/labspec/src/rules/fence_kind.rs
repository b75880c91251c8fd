use labspec_finding::{Example, Layer, Rule, Severity};

/// A quiz in a lab fence, or the other way round.
pub const FENCE_KIND: &Rule = &Rule {
    code: "fence-kind",
    severity: Severity::Error,
    layer: Layer::Source,
    summary: "a fence says `lab` but holds a quiz, or the other way round",
    why: "the page reads it as what the fence says and shows an empty block",
    bad: Example::Lesson(
        "⟦```lab simlab⟧\n{\"id\": \"fall\", \"questions\": [{\"kind\": \"open\", \"q\": \"Why?\"}]}\n```\n",
    ),
    good: Example::Lesson(
        "```quiz\n{\"id\": \"fall\", \"questions\": [{\"kind\": \"open\", \"q\": \"Why?\"}]}\n```\n",
    ),
};
