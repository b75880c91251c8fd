use labspec_finding::{Example, Layer, Rule, Severity};

/// A suppression gives no reason.
pub const ALLOWANCE_WITHOUT_REASON: &Rule = &Rule {
    code: "allowance-without-reason",
    severity: Severity::Error,
    layer: Layer::Structure,
    summary: "a suppression gives no reason",
    why: "a later reader cannot tell whether the reason still holds; without a reason nothing is suppressed",
    bad: Example::Lesson("# Fall\n\n⟦<!-- labspec allow listing-line-breaks -->⟧\n\nA ball falls.\n"),
    good: Example::Lesson("# Fall\n\nA ball falls.\n"),
};
