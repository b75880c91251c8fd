//! What a page may ask for: the source of a block, a change of it, a fix, proposals. Each request names the lesson and the hash of the
//! text that the page shows; where the lesson has another text by now, nothing is done.

use super::assist::{EditedLesson, assist};
use super::author::block_at;
use super::backend::Backend;
use super::http::Refusal;
use super::snapshot::{ServedLesson, Snapshot};
use labspec::spec::Lesson;
use serde::Deserialize;
use serde_json::{Value, json};
use std::ops::Range;

/// The maximum size of a lesson that is written, in bytes.
const MAX_LESSON: usize = 16 << 20;

/// A request of a page.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Ask {
    page: String,
    hash: String,
    start: Option<usize>,
    end: Option<usize>,
    text: Option<String>,
    finding: Option<usize>,
    proposal: Option<usize>,
    offset: Option<usize>,
}

/// A lesson of a request, whose text is the one that the page shows.
struct RequestedLesson<'s> {
    served: &'s ServedLesson,
    lesson: &'s Lesson,
}

/// Does what a page asks for.
pub(super) fn act(
    what: &str,
    ask: &Ask,
    snapshot: &Snapshot,
    backend: &dyn Backend,
) -> Result<Value, Refusal> {
    let asked = find_lesson(ask, snapshot)?;
    match what {
        "source" => {
            let span = block_span(ask, &asked)?;
            Ok(json!({ "text": asked.lesson.file.slice(span) }))
        }
        "edit" => edit(ask, &asked, backend),
        "fix" => fix(ask, &asked, backend),
        "propose" => propose(ask, &asked, backend),
        "accept" => accept(ask, &asked, backend),
        "findings" | "complete" | "hover" => {
            let edited = EditedLesson {
                path: &asked.served.path,
                models: backend.models(&asked.served.path),
                old: asked.lesson.file.text(),
                block: block_span(ask, &asked)?,
                text: ask.text.as_deref().ok_or((400, "the request has no text".to_string()))?,
            };
            assist(what, edited, ask.offset.unwrap_or(0))
        }
        _ => Err((404, "the preview does not know this request".into())),
    }
}

fn find_lesson<'s>(ask: &Ask, snapshot: &'s Snapshot) -> Result<RequestedLesson<'s>, Refusal> {
    let none = || (404, "this lesson is not part of the course any more".to_string());
    let served = snapshot.lessons.get(&ask.page).ok_or_else(none)?;
    let checked = snapshot.course.lessons.get(served.index).ok_or_else(none)?;
    if served.hash != ask.hash {
        return Err((409, "the file has changed since this page was shown; try again".into()));
    }
    Ok(RequestedLesson { served, lesson: &checked.lesson })
}

/// The bytes of a block that the page shows.
fn block_span(ask: &Ask, asked: &RequestedLesson<'_>) -> Result<Range<usize>, Refusal> {
    let span = ask.start.zip(ask.end).map(|(start, end)| start..end);
    span.filter(|span| asked.served.blocks.contains(span))
        .ok_or((400, "the request names no block of this page".into()))
}

fn conflict(why: String) -> Refusal {
    (409, why)
}

fn edit(ask: &Ask, asked: &RequestedLesson<'_>, backend: &dyn Backend) -> Result<Value, Refusal> {
    let span = block_span(ask, asked)?;
    let text = ask.text.as_deref().ok_or((400, "the request has no text".to_string()))?;
    let old = asked.lesson.file.text();
    let (Some(before), Some(after)) = (old.get(..span.start), old.get(span.end..)) else {
        return Err((400, "the request names no block of this page".into()));
    };
    // A browser sends the line ends of a form as `\n`; the file keeps its own.
    let line_end = if old.contains("\r\n") { "\r\n" } else { "\n" };
    let text = text.replace("\r\n", "\n").replace('\n', line_end);
    let lacks_end =
        old.get(span).is_some_and(|block| block.ends_with('\n')) && !text.is_empty() && !text.ends_with('\n');
    let new = format!("{before}{text}{}{after}", if lacks_end { line_end } else { "" });
    if new.len() > MAX_LESSON {
        return Err((413, "the lesson would be too large".into()));
    }
    backend.write(&asked.served.path, old, &new).map_err(conflict)?;
    Ok(json!({ "ok": true }))
}

fn fix(ask: &Ask, asked: &RequestedLesson<'_>, backend: &dyn Backend) -> Result<Value, Refusal> {
    let finding = ask.finding.and_then(|number| asked.served.findings.get(number));
    let finding = finding.filter(|f| f.fix.is_some()).ok_or((400, "this finding has no fix".to_string()))?;
    backend.fix(&asked.served.path, asked.lesson, finding).map_err(conflict)?;
    Ok(json!({ "ok": true }))
}

fn propose(ask: &Ask, asked: &RequestedLesson<'_>, backend: &dyn Backend) -> Result<Value, Refusal> {
    let block = block_span(ask, asked)?;
    let blocks = &asked.served.blocks;
    let is_here = |span: &Range<usize>| {
        block_at(blocks, span.start).and_then(|index| blocks.get(index)) == Some(&block)
    };
    let proposals = asked.served.proposals.get_or_init(|| backend.propose(&asked.served.path, asked.lesson));
    let verify = proposals.verify.iter().enumerate().filter(|(_, one)| is_here(&one.span));
    let mut all: Vec<Value> = verify
        .map(|(id, one)| {
            let id = one.lesson.is_some().then_some(id);
            json!({ "id": id, "name": one.name, "text": one.text, "note": one.note })
        })
        .collect();
    let numbers: Vec<&str> =
        proposals.numbers.iter().filter(|(span, _)| is_here(span)).map(|(_, text)| text.as_str()).collect();
    if !numbers.is_empty() {
        all.push(json!({ "id": null, "name": "Where the numbers come from", "text": numbers.join("\n"), "note": "" }));
    }
    Ok(json!({ "proposals": all }))
}

fn accept(ask: &Ask, asked: &RequestedLesson<'_>, backend: &dyn Backend) -> Result<Value, Refusal> {
    let proposals = asked.served.proposals.get();
    let chosen = ask
        .proposal
        .zip(proposals)
        .and_then(|(id, all)| all.verify.get(id))
        .and_then(|one| one.lesson.as_deref());
    let new = chosen.ok_or((409, "the proposal has expired; request it again".to_string()))?;
    backend.write(&asked.served.path, asked.lesson.file.text(), new).map_err(conflict)?;
    Ok(json!({ "ok": true }))
}
