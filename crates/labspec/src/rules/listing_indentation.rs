use crate::lint::CodeLine;
use crate::source::Text;
use labspec_finding::{Example, Finding, Layer, Rule, Severity};
use std::ops::Range;

/// A Python listing has lost its indentation.
pub const LISTING_INDENTATION: &Rule = &Rule {
    code: "listing-indentation",
    severity: Severity::Warning,
    exceptions: &[],
    layer: Layer::Source,
    summary: "a Python listing has lost its indentation",
    why: "the line below a line that ends with a colon needs indentation; the listing does not run",
    bad: Example::Lesson("```python\nfor step in range(10):\n⟦print(step)⟧\n```\n"),
    good: Example::Lesson("```python\nfor step in range(10):\n    print(step)\n```\n"),
};

/// Reports a statement that is not indented although the line before opens a block. `opener`: that line.
pub(crate) fn check_line(
    body: &Text,
    line: &CodeLine<'_>,
    opener: Option<(usize, Range<usize>)>,
) -> Option<Finding> {
    let (_, span) = opener.filter(|(outer, _)| line.indent <= *outer)?;
    Some(
        Finding::new(LISTING_INDENTATION, body.span_of(line.content.clone()), "this line must be indented")
            .related(body.span_of(span), "the line that it belongs to")
            .help("indent the block by four spaces"),
    )
}
