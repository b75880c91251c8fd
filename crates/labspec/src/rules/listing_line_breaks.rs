use crate::lint::CodeLine;
use crate::source::Text;
use labspec_finding::{Example, Finding, Layer, Rule, Severity};

/// A Python listing has lost its line breaks.
pub const LISTING_LINE_BREAKS: &Rule = &Rule {
    code: "listing-line-breaks",
    severity: Severity::Warning,
    exceptions: &[],
    layer: Layer::Source,
    summary: "a Python listing has lost its line breaks",
    why: "several statements are on one line, which Python does not accept",
    bad: Example::Lesson("```python\ndef fall(h): z = 1.0 ⟦v = 0.0 return z - v * h⟧\n```\n"),
    good: Example::Lesson("```python\ndef fall(h):\n    z = 1.0\n    v = 0.0\n    return z - v * h\n```\n"),
};

/// Reports a line with more statements than a line can have.
pub(crate) fn check_line(body: &Text, line: &CodeLine<'_>) -> Option<Finding> {
    let from = line.start + second_assignment(line.bare)?;
    let span = body.span_of(from..line.content.end);
    Some(
        Finding::new(LISTING_LINE_BREAKS, span, "several statements are on one line")
            .help("put every statement on its own line, indented below the `def`"),
    )
}

/// The start of the second assignment of a `def` line, outside brackets. At most one can follow it.
fn second_assignment(bare: &str) -> Option<usize> {
    if !bare.trim_start().starts_with("def ") || bare.contains(';') {
        return None;
    }
    let (mut depth, mut count) = (0i32, 0);
    for (offset, c) in bare.char_indices() {
        match c {
            '(' | '[' | '{' => depth += 1,
            ')' | ']' | '}' => depth -= 1,
            '=' if depth == 0 && bare.get(offset.saturating_sub(1)..offset + 2) == Some(" = ") => {
                count += 1;
                if count == 2 {
                    // Skips the assigned name backwards.
                    let name = bare.get(..offset)?.trim_end();
                    return Some(name.rfind(' ').map_or(0, |space| space + 1));
                }
            }
            _ => {}
        }
    }
    None
}
