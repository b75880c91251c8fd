use labspec_finding::{Example, Layer, Rule, Severity};

/// The kind of a fence is misspelt.
pub const FENCE_NAME: &Rule = &Rule {
    code: "fence-name",
    severity: Severity::Error,
    layer: Layer::Source,
    summary: "the kind of a fence is misspelt",
    why: "the page shows the JSON as a listing, or finds no such widget",
    bad: Example::Lesson("⟦```Lab simlab⟧\n{\"model\": \"ball\", \"plots\": []}\n```\n"),
    good: Example::Lesson("```lab simlab\n{\"model\": \"ball\", \"plots\": []}\n```\n"),
};
