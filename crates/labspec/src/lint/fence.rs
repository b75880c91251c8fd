//! Fences that are damaged, missing or mislabelled. What counts as damage is decided in `markdown/`.

use crate::finding::{Finding, Severity};
use crate::markdown::{BlockKind, MAX_BLOCKS, MAX_MARKUP, Opener, Problem};
use crate::rules;
use std::ops::Range;

/// What is said about damaged fences.
pub(super) fn to_finding(text: &str, problem: &Problem) -> Finding {
    match problem {
        Problem::TooMuchMarkup => {
            Finding::new(rules::LESSON_LIMIT, 0..0, "this lesson is not checked at all")
                .why(format!("it has more than {MAX_MARKUP} characters of markup"))
                .help("split the lesson")
        }
        Problem::TooManyBlocks(from) => {
            Finding::new(rules::LESSON_LIMIT, *from..*from, "the rest of the lesson is not checked")
                .why(format!("the lesson has more than {MAX_BLOCKS} fences, or too many damaged ones"))
                .help("split the lesson, or fix the first fences and check again")
        }
        Problem::Misspelt { open, right } => misspelt(open, right),
        Problem::TextOnLine { open, rest, kind } => text_on_line(text, open, rest.clone(), kind),
        Problem::Unclosed { open, end, resume, kind } => unclosed(text, open, *end, *resume, kind),
        Problem::Missing { object, kind } => missing(text, object, kind),
        Problem::Unseen(open) => unseen(open),
        Problem::Indented(open) => indented(open),
    }
}

/// A fence without its closing line: `end` is where its content ends, `resume` where the lesson goes on.
fn unclosed(text: &str, open: &Opener, end: usize, resume: Option<usize>, kind: &BlockKind) -> Finding {
    let closing = open.closing();
    let finding = Finding::new(rules::FENCE_UNCLOSED, open.head.clone(), "this fence is never closed");
    match kind {
        BlockKind::Code { .. } => {
            let finding = match resume {
                Some(at) => {
                    let line = text.get(at..).and_then(|t| t.lines().next()).unwrap_or("");
                    finding.related(
                        at..at + line.trim_end().len(),
                        "it runs into this line, which begins another block",
                    )
                }
                None => finding.why("everything to the end of the file counts as code"),
            };
            finding.help(format!(
                "add a line {closing} after the last line of the listing; a fence that shows another fence needs a longer mark, {closing}{}",
                closing.chars().next().unwrap_or('`')
            ))
        }
        _ => finding
            .related(end..end, "its content ends here")
            .help(format!("add a line {closing} below that place"))
            .fix(end..end, line_below(text, end, &open.prefix(text), &closing)),
    }
}

/// A fence that was meant to be another kind.
fn misspelt(open: &Opener, right: &str) -> Finding {
    Finding::new(rules::FENCE_NAME, open.head.clone(), "the kind of this fence is misspelt")
        .help(format!("write {}{right}", open.closing()))
        .fix(open.head.clone(), format!("{}{right}", open.closing()))
}

/// Content on the opening line, beginning at `rest`.
fn text_on_line(text: &str, open: &Opener, rest: Range<usize>, kind: &BlockKind) -> Finding {
    let what = match kind {
        BlockKind::Code { .. } => "a listing begins on the opening line of its fence",
        _ => "JSON begins on the opening line of its fence",
    };
    let first = text.get(rest.clone()).and_then(|t| t.chars().next()).map_or(0, char::len_utf8);
    let head = text.get(open.head.clone()).unwrap_or("");
    Finding::new(rules::FENCE_LINE, rest.start..rest.start + first, what)
        .help(format!("break the line after \"{}\"", crate::json::read::shorten(head)))
        .fix(open.head.end..rest.start, format!("\n{}", open.prefix(text)))
}

/// A lab or a quiz without a fence.
fn missing(text: &str, object: &Range<usize>, kind: &BlockKind) -> Finding {
    let (what, fence) = match kind {
        BlockKind::Quiz => ("a quiz", "```quiz"),
        _ => ("a lab", "```lab simlab"),
    };
    Finding::new(
        rules::FENCE_MISSING,
        object.start..object.start + 1,
        format!("{what} is not inside a fence"),
    )
    .related(object.end..object.end, "it ends here")
    .help(format!("put a line {fence} above it and a line ``` below it"))
    .fix(object.clone(), {
        let line = text.get(..object.start).map_or(0, |t| t.rfind('\n').map_or(0, |i| i + 1));
        let indent = text.get(line..object.start).unwrap_or("");
        let json = text.get(object.clone()).unwrap_or("");
        format!("{fence}\n{indent}{json}{}", line_below(text, object.end, indent, "```"))
    })
}

/// A line to put in behind what ends at `end`; what follows there goes to the line after it.
fn line_below(text: &str, end: usize, prefix: &str, line: &str) -> String {
    let rest = text.get(end..).and_then(|t| t.lines().next()).unwrap_or("");
    let after = if rest.trim().is_empty() { String::new() } else { format!("\n{prefix}") };
    format!("\n{prefix}{line}{after}")
}

/// A fence inside of an indented code block.
fn indented(open: &Opener) -> Finding {
    Finding::new(
        rules::FENCE_UNSEEN,
        open.head.clone(),
        "a lab or a quiz is indented like code, so it is not read",
    )
    .why("Markdown shows lines with four spaces of indentation as they are")
    .help("remove the indentation, down to that of its list")
    .severity(Severity::Warning)
}

/// A fence that Markdown does not see.
fn unseen(open: &Opener) -> Finding {
    Finding::new(rules::FENCE_UNSEEN, open.head.clone(), "Markdown does not read this line as a fence")
        .help("put an empty line above it, and only the kind of the fence on the line itself")
}
