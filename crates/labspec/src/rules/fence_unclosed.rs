use crate::markdown::{BlockKind, Opener};
use labspec_finding::{Example, Finding, Layer, Rule, Severity};

/// A fence has no closing line.
pub const FENCE_UNCLOSED: &Rule = &Rule {
    code: "fence-unclosed",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Source,
    summary: "a fence has no closing line",
    why: "the page reads everything below it as part of the fence: text, labs and quizzes disappear",
    bad: Example::Lesson("⟦```lab simlab⟧\n{\"model\": \"ball\"}\n\nNow press play.\n"),
    good: Example::Lesson("```lab simlab\n{\"model\": \"ball\"}\n```\n\nNow press play.\n"),
};

/// Reports a fence without its closing line. `end`: the end of its content; `resume`: where parsing of the lesson continues.
pub(crate) fn unclosed(
    text: &str,
    open: &Opener,
    end: usize,
    resume: Option<usize>,
    kind: &BlockKind,
) -> Finding {
    let closing = open.closing();
    let finding = Finding::new(FENCE_UNCLOSED, open.head.clone(), "this fence is never closed");
    match kind {
        BlockKind::Code { .. } => {
            let finding = match resume {
                Some(start) => {
                    let line = text.get(start..).and_then(|t| t.lines().next()).unwrap_or("");
                    finding.related(
                        start..start + line.trim_end().len(),
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

/// A line to insert after `end`. The text that follows `end` moves to the next line.
pub(super) fn line_below(text: &str, end: usize, prefix: &str, line: &str) -> String {
    let rest = text.get(end..).and_then(|t| t.lines().next()).unwrap_or("");
    let after = if rest.trim().is_empty() { String::new() } else { format!("\n{prefix}") };
    format!("\n{prefix}{line}{after}")
}
