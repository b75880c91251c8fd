use labspec_finding::{Example, Layer, Rule, Severity};

/// The lesson states numbers with units that no `verify` quotes.
pub const NUMBERS_UNCLAIMED: &Rule = &Rule {
    code: "numbers-unclaimed",
    severity: Severity::Note,
    layer: Layer::Claim,
    summary: "the lesson states numbers with units that no `verify` quotes",
    why: "every check recomputes a quoted number; a number that is not quoted may become wrong when the model changes",
    bad: Example::Lesson(
        "It touches the floor after ⟦0.442 s⟧, at 4.43 m/s, and falls 1 m.\n\n```lab simlab\n{\"model\": \"ball\", \"readouts\": [{\"label\": \"height (m)\", \"expr\": \"data.qpos[2]\"}]}\n```\n",
    ),
    good: Example::Lesson(
        "It touches the floor soon.\n\n```lab simlab\n{\"model\": \"ball\", \"readouts\": [{\"label\": \"height (m)\", \"expr\": \"data.qpos[2]\"}]}\n```\n",
    ),
};
