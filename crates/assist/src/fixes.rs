//! Edits that resolve findings: the fix, all safe fixes, or suppression with a reason.

use super::document::Document;
use super::item::{Edit, FixKind, TextFix};
use labspec::bind::scene::Models;
use labspec::check::{self, CheckLevel};
use labspec::finding::{Applicability, Finding};
use labspec::lint::reload_lesson;
use labspec::repair::{CheckedText, repair as repair_text, traces};
use labspec::source::SourceFile;
use labspec::spec::{FileKind, Lesson, kind_of};
use std::ops::Range;
use std::path::Path;

/// The fix of a finding of this text, unless it is only an example.
pub fn fix(file: &SourceFile, f: &Finding) -> Option<TextFix> {
    let fix = f.fix.as_ref()?;
    let (old, new) = (shorten(file.slice(fix.span.clone())), shorten(&fix.text));
    let change = match (old.is_empty(), new.is_empty()) {
        (true, _) => format!("write `{new}`"),
        (_, true) => format!("delete `{old}`"),
        _ => format!("write `{new}` instead of `{old}`"),
    };
    let (title, kind) = match fix.applicability {
        Applicability::Safe => (change, FixKind::Safe),
        Applicability::Unsafe => (format!("{change} (a guess)"), FixKind::Guess),
        Applicability::Display => return None,
    };
    Some(TextFix { title, kind, edit: Edit { span: fix.span.clone(), text: fix.text.clone() } })
}

/// A text that fits into a menu.
fn shorten(text: &str) -> String {
    let line = text.lines().next().unwrap_or("");
    let cut: String = line.chars().take(40).collect();
    if cut.len() < text.len() { format!("{cut}…") } else { cut }
}

/// One edit that applies all verified safe fixes of a lesson.
pub fn fix_all(document: &Document, lesson: &Lesson, models: &Models) -> Option<TextFix> {
    let is_safe = |f: &Finding| f.fix.as_ref().is_some_and(|fix| fix.applicability == Applicability::Safe);
    if !document.findings.iter().any(is_safe) {
        return None;
    }
    let level = CheckLevel { programs: true, ..CheckLevel::STATIC };
    let load = |text: &str| reload_lesson(lesson, text, models.folder());
    let check_text = |text: &str| {
        let lesson = load(text);
        let broken = lesson.broken.len();
        CheckedText::new(text.to_string(), check::check_lesson(lesson, models, level).findings, broken)
    };
    let old = lesson.file.text();
    // Findings that require runs of the labs are not computed again.
    let current = CheckedText::new(old.to_string(), check_text(old).findings, lesson.broken.len());
    let (new, made) = repair_text(current, false, &check_text, &|text| traces(&load(text), models));
    if made == 0 {
        return None;
    }
    let (span, text) = changed(old, &new);
    Some(TextFix {
        title: "apply all safe fixes".to_string(),
        kind: FixKind::Safe,
        edit: Edit { span, text },
    })
}

/// The range in which two texts differ, and the replacement from the second one.
fn changed(old: &str, new: &str) -> (Range<usize>, String) {
    let start: usize =
        old.chars().zip(new.chars()).take_while(|(a, b)| a == b).map(|(c, _)| c.len_utf8()).sum();
    let (old_rest, new_rest) = (old.get(start..).unwrap_or(""), new.get(start..).unwrap_or(""));
    let same = old_rest.chars().rev().zip(new_rest.chars().rev()).take_while(|(a, b)| a == b);
    let end: usize = same.map(|(c, _)| c.len_utf8()).sum();
    (start..old.len() - end, new_rest.get(..new_rest.len() - end).unwrap_or("").to_string())
}

/// The edit that suppresses a warning or a note. It adds the code to the `lint` of the lab, the question or the quiz, where the author
/// writes the reason; for prose, it inserts a comment before the text.
pub fn suppression(lesson: &Lesson, f: &Finding) -> Option<TextFix> {
    let file = &lesson.file;
    if f.is_error() || lesson.is_broken(&f.span) {
        return None;
    }
    let holds = |span: &Range<usize>| span.start <= f.span.start && f.span.start < span.end;
    let labs = lesson.all_labs().into_iter().map(|lab| (lab.span.clone(), lab.lint.clone()));
    let questions = lesson.quizzes.iter().flat_map(|quiz| {
        let whole = std::iter::once((quiz.span.clone(), quiz.lint.clone()));
        whole.chain(quiz.numbered().map(|(_, q)| (q.span.clone(), q.lint.clone())))
    });
    let object =
        labs.chain(questions).filter(|(span, _)| holds(span)).min_by_key(|(span, _)| span.end - span.start);
    let (offset, text) = match object {
        Some((_, Some(lint))) => {
            // Adds a code to an existing list.
            let (_, last) = lint.codes.last()?;
            (last.end + 1, format!(", \"{}\"", f.code))
        }
        Some((span, None)) => {
            let inside = file.slice(span.start + 1..span.end);
            let gap = inside.get(..inside.find(['"', '}'])?)?;
            let comma = if inside.trim_start().starts_with('}') { "" } else { "," };
            (span.start + 1, format!("{gap}\"lint\": {{\"allow\": [\"{}\"], \"why\": \"\"}}{comma}", f.code))
        }
        None if kind_of(Path::new(&**file.path())) == FileKind::Lesson => {
            let end = line_end(file);
            (comment_place(lesson, f.span.start)?, format!("<!-- labspec allow {}:  -->{end}", f.code))
        }
        None => return None,
    };
    let title = format!("suppress `{}` here, with a reason", f.code);
    Some(TextFix { title, kind: FixKind::Suppression, edit: Edit { span: offset..offset, text } })
}

/// The start of the line before which a comment about a byte of the text is valid: that of its block or its paragraph.
pub fn comment_place(lesson: &Lesson, byte: usize) -> Option<usize> {
    let file = &lesson.file;
    let line = file.position(byte).line;
    let empty = |line: usize| file.line_span(line).is_none_or(|span| file.slice(span).trim().is_empty());
    let block = lesson.scan.blocks.iter().find(|b| b.span.start <= byte && byte < b.span.end);
    let first = block.map(|b| file.position(b.span.start).line);
    let first = first.unwrap_or_else(|| (1..=line).rev().find(|l| *l == 1 || empty(l - 1)).unwrap_or(line));
    Some(file.line_span(first)?.start)
}

/// The line end of a text.
pub fn line_end(file: &SourceFile) -> &'static str {
    if file.text().contains("\r\n") { "\r\n" } else { "\n" }
}
