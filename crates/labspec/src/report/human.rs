//! Findings for people: code, location, the source line with the marked span, why, and help.
//!
//! Lines of lessons can be kilobytes long, so only a window around each span is printed. The location above it is that in
//! the file. Rendered with annotate-snippets, in the style of rustc.

use super::file_of;
use crate::finding::{Finding, Severity};
use crate::printable::{printable, printable_line};
use crate::source::SourceFile;
use annotate_snippets::{AnnotationKind, Element, Level, Origin, Renderer, Snippet};
use std::ops::Range;

/// Number of characters on each side of a span, and maximum number of characters of the span itself.
const CONTEXT: usize = 48;
/// Maximum number of characters of a line that is printed completely.
const MAX_WHOLE_LINE: usize = 110;

/// All findings, each followed by an empty line. With `colour`, the text contains escape sequences for terminals.
pub fn human(findings: &[Finding], files: &[&SourceFile], colour: bool) -> String {
    let renderer = if colour { Renderer::styled() } else { Renderer::plain() };
    let renderer = renderer.term_width(MAX_WHOLE_LINE + 40);
    let mut text = String::new();
    for finding in findings {
        text.push_str(&one(finding, files, &renderer));
        text.push_str("\n\n");
    }
    text
}

fn one(finding: &Finding, files: &[&SourceFile], renderer: &Renderer) -> String {
    let level = match finding.severity {
        Severity::Error => Level::ERROR,
        Severity::Warning => Level::WARNING,
        Severity::Note => Level::NOTE,
    };
    let mut group = level
        .primary_title(printable(&finding.message).into_owned())
        .id(finding.code)
        .elements(place(files, &finding.path, &finding.span, AnnotationKind::Primary, None));
    for related in &finding.related {
        let label = printable(&related.label).into_owned();
        group =
            group.elements(place(files, &related.path, &related.span, AnnotationKind::Context, Some(label)));
    }
    if let Some(why) = &finding.why {
        group = group.element(Level::NOTE.with_name("why").message(printable(why).into_owned()));
    }
    if let Some(help) = &finding.help {
        group = group.element(Level::HELP.message(printable(help).into_owned()));
    }
    let drawn = renderer.render(&[group]);
    drawn.lines().filter(|line| !is_nameless(line)).collect::<Vec<_>>().join("\n")
}

/// Whether this is the header line of a snippet without a path. The location is already printed above it, because a snippet
/// from the middle of a long line has no column information.
fn is_nameless(line: &str) -> bool {
    let mut visible = String::new();
    let mut in_escape = false;
    for c in line.chars() {
        match c {
            '\u{1b}' => in_escape = true,
            'm' if in_escape => in_escape = false,
            _ if in_escape => {}
            _ => visible.push(c),
        }
    }
    visible.trim() == ":::"
}

/// The location of a span, and a window of its line.
fn place<'a>(
    files: &[&SourceFile],
    path: &str,
    span: &Range<usize>,
    kind: AnnotationKind,
    label: Option<String>,
) -> Vec<Element<'a>> {
    let Some(file) = file_of(files, path) else {
        return vec![Origin::path(printable(path).into_owned()).into()];
    };
    let position = file.position(span.start);
    let origin = Origin::path(printable(path).into_owned()).line(position.line).char_column(position.column);
    let line = file.line_span(position.line).unwrap_or(0..0);
    let (text, mark) =
        window(file.slice(line.clone()), &(file.floor(span.start)..file.floor(span.end)), line.start);
    let mark = kind.span(mark);
    let mark = match label {
        Some(label) => mark.label(label),
        None => mark,
    };
    vec![origin.into(), Snippet::source(text).line_start(position.line).annotation(mark).into()]
}

/// The part of a line around a span of the file, with … where it was truncated, and the span within it. A span that extends
/// beyond the line is clipped.
fn window(line: &str, span: &Range<usize>, line_start: usize) -> (String, Range<usize>) {
    let start = span.start.saturating_sub(line_start).min(line.len());
    let end = span.end.saturating_sub(line_start).clamp(start, line.len());
    let (before, inside) = (line.get(..start).unwrap_or(""), line.get(start..end).unwrap_or(""));
    let after = line.get(end..).unwrap_or("");
    if line.chars().take(MAX_WHOLE_LINE + 1).count() <= MAX_WHOLE_LINE {
        return written([before, inside, after]);
    }
    let left: Vec<char> = before.chars().rev().take(CONTEXT).collect();
    let mut begin = String::new();
    if left.iter().map(|c| c.len_utf8()).sum::<usize>() < before.len() {
        begin.push('…');
    }
    begin.extend(left.iter().rev());
    let excerpt: String = inside.chars().take(CONTEXT).collect();
    let mut end = String::new();
    if excerpt.len() == inside.len() {
        end.extend(after.chars().take(CONTEXT));
        if end.len() < after.len() {
            end.push('…');
        }
    } else {
        end.push('…');
    }
    written([&begin, &excerpt, &end])
}

/// The three parts of a line, safe to print, and the range of the middle one.
fn written(parts: [&str; 3]) -> (String, Range<usize>) {
    let [before, inside, after] = parts.map(printable_line);
    let mark = before.len()..before.len() + inside.len();
    ([before, inside, after].concat(), mark)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::finding::InFile;
    use crate::rules;

    #[test]
    fn long_lines_are_shortened_around_the_mark() {
        let text = format!("first\n{}\"exprr\"{}\n", "ä ".repeat(1000), " tail".repeat(1000));
        let file = SourceFile::new("long.md", text.as_str());
        let offset = text.find("exprr").unwrap();
        let finding = Finding::new(rules::UNKNOWN_KEY, offset..offset + 5, "no key `exprr`")
            .help("did you mean `expr`?")
            .at(&file);
        let rendered = human(&[finding], &[&file], false);
        assert!(rendered.lines().all(|l| l.chars().count() < 130), "{rendered}");
        insta::assert_snapshot!(rendered);
    }

    #[test]
    fn spans_over_lines_and_past_the_end_are_printed() {
        let file = SourceFile::new("a.md", "one\ntwo");
        for span in [0..7, 2..5, 7..7, 90..100, 3..3] {
            let finding = Finding::new(rules::UNKNOWN_KEY, span, "x").at(&file);
            assert!(human(&[finding], &[&file], true).contains("unknown-key"));
        }
        let empty = SourceFile::new("e.md", "");
        assert!(
            human(&[Finding::new(rules::UNKNOWN_KEY, 0..0, "x\u{1b}[2J").at(&empty)], &[&empty], false)
                .contains("e.md:1:1")
        );
    }
}
