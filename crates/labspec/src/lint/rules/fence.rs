//! Fences that are damaged, missing or mislabelled. What counts as damage is decided in `markdown/`.

use crate::finding::{Finding, Severity};
use crate::markdown::{BlockKind, Opener};
use labspec_finding::{Example, Layer, Rule};
use std::ops::Range;

/// A fence without its closing line.
pub static UNCLOSED: Rule = Rule {
    code: "fence-unclosed",
    severity: Severity::Error,
    layer: Layer::Source,
    summary: "the closing line of a fence is missing",
    why: "everything below it counts as part of the fence: text, labs and quizzes disappear from the page",
    bad: Example::Lesson("```lab simlab\n{\"model\": \"ball\"}\n\nNow press play.\n"),
    good: Example::Lesson("```lab simlab\n{\"model\": \"ball\"}\n```\n\nNow press play.\n"),
};

/// JSON or code on the opening line.
pub static ON_LINE: Rule = Rule {
    code: "fence-line",
    severity: Severity::Error,
    layer: Layer::Source,
    summary: "JSON or code stands on the opening line of a fence",
    why: "what stands on that line is the name of the fence's kind, not its content, so it is lost",
    bad: Example::Lesson("```lab simlab {\"model\": \"ball\"}\n```\n"),
    good: Example::Lesson("```lab simlab\n{\"model\": \"ball\"}\n```\n"),
};

/// A lab or a quiz without any fence.
pub static MISSING: Rule = Rule {
    code: "fence-missing",
    severity: Severity::Error,
    layer: Layer::Source,
    summary: "a lab or a quiz stands in the text without a fence",
    why: "students read the JSON instead of using what it describes",
    bad: Example::Lesson(
        "Now a question.\n\n{\"id\": \"fall\", \"questions\": [{\"kind\": \"open\", \"q\": \"Why?\"}]}\n",
    ),
    good: Example::Lesson(
        "Now a question.\n\n```quiz\n{\"id\": \"fall\", \"questions\": [{\"kind\": \"open\", \"q\": \"Why?\"}]}\n```\n",
    ),
};

/// A fence that Markdown does not see.
pub static UNSEEN: Rule = Rule {
    code: "fence-unseen",
    severity: Severity::Error,
    layer: Layer::Source,
    summary: "Markdown does not take an opening line for a fence",
    why: "a fence line must hold no further backtick and must not stand inside of HTML; the block is shown as text",
    bad: Example::Lesson("<div>\n```lab simlab\n{\"model\": \"ball\"}\n```\n</div>\n"),
    good: Example::Lesson("<div>\n\n```lab simlab\n{\"model\": \"ball\"}\n```\n\n</div>\n"),
};

/// A quiz in a lab fence, or the other way round.
pub static WRONG_FENCE: Rule = Rule {
    code: "fence-kind",
    severity: Severity::Error,
    layer: Layer::Source,
    summary: "a fence says `lab` but holds a quiz, or the other way round",
    why: "the page reads it as what the fence says and shows an empty block",
    bad: Example::Lesson(
        "```lab simlab\n{\"id\": \"fall\", \"questions\": [{\"kind\": \"open\", \"q\": \"Why?\"}]}\n```\n",
    ),
    good: Example::Lesson(
        "```quiz\n{\"id\": \"fall\", \"questions\": [{\"kind\": \"open\", \"q\": \"Why?\"}]}\n```\n",
    ),
};

/// A fence whose kind is misspelt.
pub static MISSPELT: Rule = Rule {
    code: "fence-name",
    severity: Severity::Error,
    layer: Layer::Source,
    summary: "the kind of a fence is misspelt",
    why: "the page shows the JSON as a listing, or finds no such widget",
    bad: Example::Lesson("```Lab simlab\n{\"model\": \"ball\", \"plots\": []}\n```\n"),
    good: Example::Lesson("```lab simlab\n{\"model\": \"ball\", \"plots\": []}\n```\n"),
};

/// A JSON file that holds neither a lab nor a quiz.
pub static UNKNOWN_SPEC: Rule = Rule {
    code: "unknown-spec",
    severity: Severity::Error,
    layer: Layer::Source,
    summary: "a JSON file holds neither a lab nor a quiz",
    why: "nothing in it can be shown",
    bad: Example::Json(r#"{"title": "Falling"}"#),
    good: Example::Json(r#"{"title": "Falling", "model": "ball"}"#),
};

/// A lesson beyond the limits.
pub static LIMIT: Rule = Rule {
    code: "lesson-limit",
    severity: Severity::Error,
    layer: Layer::Source,
    summary: "a lesson is too large, has too many fences, or too many mistakes to list",
    why: "limits keep a checker responsive whatever it is given",
    bad: Example::Repeated("```text\nz = 1 m\n```\n\n", 2001),
    good: Example::Repeated("```text\nz = 1 m\n```\n\n", 20),
};

pub(in crate::lint) const RULES: &[&Rule] =
    &[&UNCLOSED, &ON_LINE, &MISSING, &UNSEEN, &WRONG_FENCE, &MISSPELT, &UNKNOWN_SPEC, &LIMIT];

/// A fence without its closing line: `end` is where its content ends, `resume` where the lesson goes on.
pub(crate) fn unclosed(
    text: &str,
    open: &Opener,
    end: usize,
    resume: Option<usize>,
    kind: &BlockKind,
) -> Finding {
    let closing = open.closing();
    let finding = Finding::new(&UNCLOSED, open.head.clone(), "this fence is never closed");
    match kind {
        BlockKind::Code { .. } => {
            let finding = match resume {
                Some(at) => {
                    let line = text.get(at..).and_then(|t| t.lines().next()).unwrap_or("");
                    finding.related(
                        at..at + line.trim_end().len(),
                        "it runs into this line, which begins something else",
                    )
                }
                None => finding.why("everything to the end of the file counts as code"),
            };
            finding.help(format!(
                "put a line {closing} behind the last line of the listing; a fence that shows another fence needs a longer mark, {closing}{}",
                closing.chars().next().unwrap_or('`')
            ))
        }
        _ => finding
            .related(end..end, "its content ends here")
            .help(format!("put a line {closing} below that place"))
            .fix(end..end, line_below(text, end, &open.prefix(text), &closing)),
    }
}

/// A fence that was meant to be another kind.
pub(crate) fn misspelt(open: &Opener, right: &str) -> Finding {
    Finding::new(&MISSPELT, open.head.clone(), "the kind of this fence is misspelt")
        .help(format!("write {}{right}", open.closing()))
        .fix(open.head.clone(), format!("{}{right}", open.closing()))
}

/// Content on the opening line, beginning at `rest`.
pub(crate) fn text_on_line(text: &str, open: &Opener, rest: Range<usize>, kind: &BlockKind) -> Finding {
    let what = match kind {
        BlockKind::Code { .. } => "a listing begins on the line of its fence",
        _ => "JSON begins on the line of its fence",
    };
    let first = text.get(rest.clone()).and_then(|t| t.chars().next()).map_or(0, char::len_utf8);
    let head = text.get(open.head.clone()).unwrap_or("");
    Finding::new(&ON_LINE, rest.start..rest.start + first, what)
        .help(format!("break the line behind \"{}\"", crate::json::read::shorten(head)))
        .fix(open.head.end..rest.start, format!("\n{}", open.prefix(text)))
}

/// A lab or a quiz without a fence.
pub(crate) fn missing(text: &str, object: &Range<usize>, kind: &BlockKind) -> Finding {
    let (what, fence) = match kind {
        BlockKind::Quiz => ("a quiz", "```quiz"),
        _ => ("a lab", "```lab simlab"),
    };
    Finding::new(&MISSING, object.start..object.start + 1, format!("{what} without a fence"))
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
pub(crate) fn indented(open: &Opener) -> Finding {
    Finding::new(&UNSEEN, open.head.clone(), "a lab or a quiz that is indented like code: it is not read")
        .why("Markdown shows lines that are indented by four spaces as they are")
        .help("take the indentation away, down to that of the list it stands in")
        .severity(Severity::Warning)
}

/// A fence that Markdown does not see.
pub(crate) fn unseen(open: &Opener) -> Finding {
    Finding::new(&UNSEEN, open.head.clone(), "Markdown does not see a fence here")
        .help("put an empty line above it, and only the kind of the fence on the line itself")
}
