use crate::spec::Allowance;
use labspec_finding::{Example, Finding, Layer, Rule, Severity};

/// A suppression gives no reason.
pub const ALLOWANCE_WITHOUT_REASON: &Rule = &Rule {
    code: "allowance-without-reason",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Structure,
    summary: "a suppression gives no reason",
    why: "a later reader cannot tell whether the reason still holds; without a reason nothing is suppressed",
    bad: Example::Lesson("# Fall\n\n⟦<!-- labspec allow listing-line-breaks -->⟧\n\nA ball falls.\n"),
    good: Example::Lesson("# Fall\n\nA ball falls.\n"),
};

/// Reports a suppression that gives no reason.
pub(crate) fn check_reason(allowance: &Allowance) -> Option<Finding> {
    allowance.why.is_empty().then(|| {
        Finding::new(ALLOWANCE_WITHOUT_REASON, allowance.span.clone(), "this suppression gives no reason")
            .help("write the reason after the codes, as \"why\" or after a colon")
    })
}
