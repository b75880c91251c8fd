use crate::markdown::Opener;
use labspec_finding::{Example, Finding, Layer, Rule, Severity};

/// The JSON of a lab or a quiz is in a fence of another language.
pub const FENCE_LISTING: &Rule = &Rule {
    code: "fence-listing",
    severity: Severity::Warning,
    exceptions: &[],
    layer: Layer::Source,
    summary: "the JSON of a lab or a quiz is in a fence of another language",
    why: "the page shows the JSON as a listing, and nothing in it is checked",
    bad: Example::Lesson("⟦```json⟧\n{\"model\": \"ball\", \"plots\": []}\n```\n"),
    good: Example::Lesson("```lab simlab\n{\"model\": \"ball\", \"plots\": []}\n```\n"),
};

/// Reports a fence of another language with the JSON of a lab or a quiz.
pub(crate) fn listed(open: &Opener, right: &str) -> Finding {
    let what = if right == "quiz" { "quiz" } else { "lab" };
    Finding::new(
        FENCE_LISTING,
        open.head.clone(),
        format!("this fence contains the JSON of a {what}, but it is a listing"),
    )
    .help(format!("write {}{right}, or suppress this finding if the listing is intended", open.closing()))
    .guess(open.head.clone(), format!("{}{right}", open.closing()))
}
