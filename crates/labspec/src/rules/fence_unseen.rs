use crate::markdown::Opener;
use labspec_finding::{Example, Finding, Layer, Rule, Severity};

/// Markdown does not read an opening line as a fence.
pub const FENCE_UNSEEN: &Rule = &Rule {
    code: "fence-unseen",
    severity: Severity::Error,
    exceptions: &[(Severity::Warning, "if the block is indented like code")],
    layer: Layer::Source,
    summary: "Markdown does not read an opening line as a fence",
    why: "a fence line must not contain another backtick and must not be inside HTML; the page shows the block as text",
    bad: Example::Lesson("<div>\n⟦```lab simlab⟧\n{\"model\": \"ball\"}\n```\n</div>\n"),
    good: Example::Lesson("<div>\n\n```lab simlab\n{\"model\": \"ball\"}\n```\n\n</div>\n"),
};

/// Reports a fence inside an indented code block.
pub(crate) fn indented(open: &Opener) -> Finding {
    Finding::new(FENCE_UNSEEN, open.head.clone(), "a lab or a quiz is indented like code, so it is not read")
        .why("Markdown shows lines with four spaces of indentation as they are")
        .help("remove the indentation, down to that of its list")
        .severity(Severity::Warning)
}

/// Reports an opening line that Markdown does not read as a fence.
pub(crate) fn unseen(open: &Opener) -> Finding {
    Finding::new(FENCE_UNSEEN, open.head.clone(), "Markdown does not read this line as a fence")
        .help("put an empty line above it, and only the kind of the fence on the line itself")
}
