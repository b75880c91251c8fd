//! What an editor offers where something is found: its repair, all safe repairs, or to keep it with a reason.

use super::documents::Document;
use super::places;
use labspec::bind::scene::Models;
use labspec::check::{self, CheckLevel};
use labspec::finding::{Applicability, Finding, Fix};
use labspec::lint::reload_lesson;
use labspec::repair::{CheckedText, repair as repair_text, traces};
use labspec::spec::{FileKind, Lesson};
use serde_json::{Value, json};
use std::ops::Range;

/// What is offered for a range of a document. `only` are the kinds that are asked for, all of them when it is empty.
pub(super) fn actions(
    document: &Document,
    lesson: Option<&Lesson>,
    span: &Range<usize>,
    only: &[String],
    models: &Models,
) -> Value {
    let wanted =
        |kind: &str| only.is_empty() || only.iter().any(|o| kind == o || kind.starts_with(&format!("{o}.")));
    let touches = |f: &&Finding| f.span.start <= span.end && span.start <= f.span.end;
    let mut all = Vec::new();
    let here = || document.findings.iter().filter(touches);
    if wanted("quickfix") {
        for f in here() {
            all.extend(f.fix.as_ref().and_then(|fix| repair(document, f, fix)));
        }
        for f in here().filter(|f| !f.is_error()) {
            all.extend(lesson.and_then(|lesson| allow(document, lesson, f)));
        }
    }
    if wanted("source.fixAll") {
        all.extend(lesson.and_then(|lesson| everything(document, lesson, models)));
    }
    all.into()
}

/// The repair of a finding.
fn repair(document: &Document, f: &Finding, fix: &Fix) -> Option<Value> {
    let file = &document.file;
    let (old, new) = (short(file.slice(fix.span.clone())), short(&fix.text));
    let what = match (old.is_empty(), new.is_empty()) {
        (true, _) => format!("write `{new}`"),
        (_, true) => format!("delete `{old}`"),
        _ => format!("write `{new}` instead of `{old}`"),
    };
    let (title, preferred) = match fix.applicability {
        Applicability::Safe => (what, true),
        Applicability::Unsafe => (format!("{what} (a guess)"), false),
        Applicability::Display => return None,
    };
    Some(json!({
        "title": title,
        "kind": "quickfix",
        "diagnostics": [super::diagnostic::diagnostic(f, file, &document.uri)],
        "isPreferred": preferred,
        "edit": edit(document, &[(fix.span.clone(), fix.text.clone())]),
    }))
}

/// A text that fits into a menu.
fn short(text: &str) -> String {
    let line = text.lines().next().unwrap_or("");
    let cut: String = line.chars().take(40).collect();
    if cut.len() < text.len() { format!("{cut}…") } else { cut }
}

/// A change of the document, from its last place to its first.
fn edit(document: &Document, changes: &[(Range<usize>, String)]) -> Value {
    let file = &document.file;
    let edits: Vec<Value> = changes
        .iter()
        .map(|(span, text)| json!({"range": places::range(file, span), "newText": text}))
        .collect();
    let document = json!({"uri": document.uri, "version": document.version});
    json!({"documentChanges": [{"textDocument": document, "edits": edits}]})
}

/// All safe repairs that are proven, at once.
fn everything(document: &Document, lesson: &Lesson, models: &Models) -> Option<Value> {
    let is_safe = |f: &Finding| f.fix.as_ref().is_some_and(|fix| fix.applicability == Applicability::Safe);
    if !document.findings.iter().any(is_safe) {
        return None;
    }
    let depth = CheckLevel { programs: true, ..CheckLevel::STATIC };
    let load = |text: &str| reload_lesson(lesson, text, models.folder());
    let look = |text: &str| {
        let lesson = load(text);
        let broken = lesson.broken.len();
        CheckedText {
            text: text.to_string(),
            findings: check::check_lesson(lesson, models, depth).findings,
            broken,
        }
    };
    let old = lesson.file.text();
    // What only a run of the labs finds has been found already.
    let now =
        CheckedText { text: old.to_string(), findings: look(old).findings, broken: lesson.broken.len() };
    let (new, made) = repair_text(now, false, &look, &|text| traces(&load(text), models));
    if made == 0 {
        return None;
    }
    let changes = [changed(old, &new)];
    Some(
        json!({"title": "labspec: apply all safe fixes", "kind": "source.fixAll.labspec", "edit": edit(document, &changes)}),
    )
}

/// Where two texts differ, and what the second has there.
fn changed(old: &str, new: &str) -> (Range<usize>, String) {
    let start: usize =
        old.chars().zip(new.chars()).take_while(|(a, b)| a == b).map(|(c, _)| c.len_utf8()).sum();
    let (old_rest, new_rest) = (old.get(start..).unwrap_or(""), new.get(start..).unwrap_or(""));
    let same = old_rest.chars().rev().zip(new_rest.chars().rev()).take_while(|(a, b)| a == b);
    let end: usize = same.map(|(c, _)| c.len_utf8()).sum();
    (start..old.len() - end, new_rest.get(..new_rest.len() - end).unwrap_or("").to_string())
}

/// To keep what is found: its code in the `lint` of the lab, the question or the quiz, where the author writes the reason; for prose,
/// in a comment before it.
fn allow(document: &Document, lesson: &Lesson, f: &Finding) -> Option<Value> {
    let file = &document.file;
    if lesson.is_broken(&f.span) {
        return None;
    }
    let holds = |span: &Range<usize>| span.start <= f.span.start && f.span.start < span.end;
    let labs = lesson.all_labs().into_iter().map(|lab| (lab.span.clone(), lab.lint.clone()));
    let questions = lesson.quizzes.iter().flat_map(|quiz| {
        let own = std::iter::once((quiz.span.clone(), quiz.lint.clone()));
        own.chain(quiz.numbered().map(|(_, q)| (q.span.clone(), q.lint.clone())))
    });
    let object =
        labs.chain(questions).filter(|(span, _)| holds(span)).min_by_key(|(span, _)| span.end - span.start);
    let (at, text) = match object {
        Some((_, Some(lint))) => {
            // One code more in a list that there is.
            let (_, last) = lint.codes.last()?;
            (last.end + 1, format!(", \"{}\"", f.code))
        }
        Some((span, None)) => {
            let inside = file.slice(span.start + 1..span.end);
            let gap = inside.get(..inside.find(['"', '}'])?)?;
            let comma = if inside.trim_start().starts_with('}') { "" } else { "," };
            (span.start + 1, format!("{gap}\"lint\": {{\"allow\": [\"{}\"], \"why\": \"\"}}{comma}", f.code))
        }
        None if document.kind == FileKind::Lesson => {
            let line = file.position(f.span.start).line;
            // Before the paragraph or the block, where a comment is one.
            let empty =
                |line: usize| file.line_span(line).is_none_or(|span| file.slice(span).trim().is_empty());
            let block =
                lesson.scan.blocks.iter().find(|b| holds(&b.span)).map(|b| file.position(b.span.start).line);
            let first =
                block.unwrap_or_else(|| (1..=line).rev().find(|l| *l == 1 || empty(l - 1)).unwrap_or(line));
            let end = if file.text().contains("\r\n") { "\r\n" } else { "\n" };
            (file.line_span(first)?.start, format!("<!-- labspec allow {}:  -->{end}", f.code))
        }
        None => return None,
    };
    Some(json!({
        "title": format!("suppress `{}` here, with a reason", f.code),
        "kind": "quickfix",
        "diagnostics": [super::diagnostic::diagnostic(f, file, &document.uri)],
        "edit": edit(document, &[(at..at, text)]),
    }))
}
