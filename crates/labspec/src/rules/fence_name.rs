use crate::markdown::Opener;
use labspec_finding::{Example, Finding, Layer, Rule, Severity};

/// The kind of a fence is misspelt.
pub const FENCE_NAME: &Rule = &Rule {
    code: "fence-name",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Source,
    summary: "the kind of a fence is misspelt",
    why: "the page shows the JSON as a listing, or finds no such widget",
    bad: Example::Lesson("⟦```Lab simlab⟧\n{\"model\": \"ball\", \"plots\": []}\n```\n"),
    good: Example::Lesson("```lab simlab\n{\"model\": \"ball\", \"plots\": []}\n```\n"),
};

/// Reports a fence whose kind is misspelt.
pub(crate) fn misspelt(open: &Opener, right: &str) -> Finding {
    Finding::new(FENCE_NAME, open.head.clone(), "the kind of this fence is misspelt")
        .help(format!("write {}{right}", open.closing()))
        .fix(open.head.clone(), format!("{}{right}", open.closing()))
}
