use super::fence_unclosed::line_below;
use crate::markdown::BlockKind;
use labspec_finding::{Example, Finding, Layer, Rule, Severity};
use std::ops::Range;

/// A lab or a quiz is not inside a fence.
pub const FENCE_MISSING: &Rule = &Rule {
    code: "fence-missing",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Source,
    summary: "a lab or a quiz is not inside a fence",
    why: "students see the JSON instead of the lab or the quiz",
    bad: Example::Lesson(
        "Now a question.\n\n⟦{⟧\"id\": \"fall\", \"questions\": [{\"kind\": \"open\", \"q\": \"Why?\"}]}\n",
    ),
    good: Example::Lesson(
        "Now a question.\n\n```quiz\n{\"id\": \"fall\", \"questions\": [{\"kind\": \"open\", \"q\": \"Why?\"}]}\n```\n",
    ),
};

/// Reports a lab or a quiz without a fence.
pub(crate) fn missing(text: &str, object: &Range<usize>, kind: &BlockKind) -> Finding {
    let (what, fence) = match kind {
        BlockKind::Quiz => ("a quiz", "```quiz"),
        _ => ("a lab", "```lab simlab"),
    };
    Finding::new(FENCE_MISSING, object.start..object.start + 1, format!("{what} is not inside a fence"))
        .related(object.end..object.end, "it ends here")
        .help(format!("put a line {fence} above it and a line ``` below it"))
        .fix(object.clone(), {
            let line = text.get(..object.start).map_or(0, |t| t.rfind('\n').map_or(0, |i| i + 1));
            let indent = text.get(line..object.start).unwrap_or("");
            let json = text.get(object.clone()).unwrap_or("");
            format!("{fence}\n{indent}{json}{}", line_below(text, object.end, indent, "```"))
        })
}
