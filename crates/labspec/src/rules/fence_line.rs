use crate::json::read::shorten;
use crate::markdown::{BlockKind, Opener};
use labspec_finding::{Example, Finding, Layer, Rule, Severity};
use std::ops::Range;

/// The opening line of a fence contains JSON or code.
pub const FENCE_LINE: &Rule = &Rule {
    code: "fence-line",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Source,
    summary: "the opening line of a fence contains JSON or code",
    why: "the page reads that line as the kind of the fence, so the content on it is lost",
    bad: Example::Lesson("```lab simlab ⟦{⟧\"model\": \"ball\"}\n```\n"),
    good: Example::Lesson("```lab simlab\n{\"model\": \"ball\"}\n```\n"),
};

/// Reports content on the opening line that begins at `rest`.
pub(crate) fn text_on_line(text: &str, open: &Opener, rest: Range<usize>, kind: &BlockKind) -> Finding {
    let what = match kind {
        BlockKind::Code { .. } => "a listing begins on the opening line of its fence",
        _ => "JSON begins on the opening line of its fence",
    };
    let first = text.get(rest.clone()).and_then(|t| t.chars().next()).map_or(0, char::len_utf8);
    let head = text.get(open.head.clone()).unwrap_or("");
    Finding::new(FENCE_LINE, rest.start..rest.start + first, what)
        .help(format!("break the line after \"{}\"", shorten(head)))
        .fix(open.head.end..rest.start, format!("\n{}", open.prefix(text)))
}
