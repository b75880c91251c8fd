use labspec_finding::{Example, Layer, Rule, Severity};

/// An allowance that does not say why.
pub const ALLOWANCE_WITHOUT_REASON: &Rule = &Rule {
    code: "allowance-without-reason",
    severity: Severity::Error,
    layer: Layer::Structure,
    summary: "something is allowed without a reason",
    why: "whoever reads the lesson later cannot know whether the reason still holds; without one nothing is allowed",
    bad: Example::Lesson("# Fall\n\n⟦<!-- labspec allow listing-line-breaks -->⟧\n\nA ball falls.\n"),
    good: Example::Lesson("# Fall\n\nA ball falls.\n"),
};
