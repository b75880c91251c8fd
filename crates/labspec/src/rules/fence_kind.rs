use labspec_finding::{Example, Finding, Layer, Rule, Severity};
use std::ops::Range;

/// A `lab` fence holds a quiz, or a `quiz` fence holds a lab.
pub const FENCE_KIND: &Rule = &Rule {
    code: "fence-kind",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Source,
    summary: "a `lab` fence holds a quiz, or a `quiz` fence holds a lab",
    why: "the page reads the content as the kind that the fence names, and shows an empty block",
    bad: Example::Lesson(
        "⟦```lab simlab⟧\n{\"id\": \"fall\", \"questions\": [{\"kind\": \"open\", \"q\": \"Why?\"}]}\n```\n",
    ),
    good: Example::Lesson(
        "```quiz\n{\"id\": \"fall\", \"questions\": [{\"kind\": \"open\", \"q\": \"Why?\"}]}\n```\n",
    ),
};

/// Reports a fence of the wrong kind.
pub(crate) fn holds(span: Range<usize>, message: &str, kind: &str, right: &str) -> Finding {
    Finding::new(FENCE_KIND, span.clone(), message).help(format!("write ```{kind}")).fix(span, right)
}
