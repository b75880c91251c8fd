//! Labs and quizzes in the text without a fence that Markdown recognizes.

use super::Problem;
use super::opener::opener;
use super::{Block, BlockKind, LabKind, Scan, extent, line_start};
use crate::source::{SourceMap, Text};
use std::ops::Range;

/// Maximum number of bytes of one such object.
const MAX_OBJECT: usize = 256 << 10;
/// Maximum number of lines of a file that are tried.
const MAX_TRIES: usize = 50;

/// A JSON object at the beginning of a line with the keys of a lab or a quiz.
pub(super) struct BareObject {
    /// Start of its line.
    pub(super) line: usize,
    /// The object.
    pub(super) object: Range<usize>,
    pub(super) is_quiz: bool,
}

/// All such objects of a text.
pub(super) fn bare_json(text: &str) -> impl Iterator<Item = BareObject> {
    let mut line = 0;
    let mut tries = 0;
    let mut behind = 0;
    text.split_inclusive('\n').filter_map(move |content| {
        let start = line;
        line += content.len();
        let offset = start + content.len() - content.trim_start().len();
        let after = text.get(offset..)?.strip_prefix('{')?.trim_start();
        if offset < behind || tries >= MAX_TRIES || !after.starts_with(extent::is_quote) {
            return None;
        }
        tries += 1;
        let limit = ceil(text, offset.saturating_add(MAX_OBJECT));
        let object = offset..offset + extent::json_end(text.get(offset..limit)?)?;
        let json = text.get(object.clone())?;
        let has = |key: &str| {
            json.match_indices(key).any(|(i, _)| {
                let before = json.get(..i).and_then(|b| b.chars().next_back());
                let after = json.get(i + key.len()..).and_then(|a| a.chars().next());
                before.is_some_and(extent::is_quote) && after.is_some_and(extent::is_quote)
            })
        };
        let is_quiz = has("questions");
        let is_lab =
            (has("model") || has("xml")) && ["controls", "plots", "readouts", "camera"].into_iter().any(has);
        if !is_quiz && !is_lab {
            return None;
        }
        behind = object.end;
        Some(BareObject { line: start, object, is_quiz })
    })
}

/// The nearest character boundary at or after an offset.
fn ceil(text: &str, mut offset: usize) -> usize {
    while offset < text.len() && !text.is_char_boundary(offset) {
        offset += 1;
    }
    offset.min(text.len())
}

/// Finds such objects outside of all code, and adds them as blocks with their problems.
pub(super) fn find(text: &str, scan: &mut Scan) {
    let mut code = std::mem::take(&mut scan.code);
    code.sort_by_key(|r| r.start);
    let mut from = 0;
    let mut prose = Vec::new();
    for range in &code {
        // A block begins after its indentation; the start of the line is needed.
        let start = line_start(text, range.start);
        if start > from {
            prose.push(from..start);
        }
        from = from.max(range.end);
    }
    prose.push(from..text.len());
    for range in prose {
        let Some(part) = text.get(range.clone()) else { continue };
        for bare in bare_json(part) {
            let object = bare.object.start + range.start..bare.object.end + range.start;
            let kind = if bare.is_quiz { BlockKind::Quiz } else { BlockKind::Lab(LabKind::Simulation) };
            scan.problems.push(Problem::Missing { object: object.clone(), kind: kind.clone() });
            let head = object.start..object.start + 1;
            scan.blocks.push(loose_block(text, kind, object.clone(), head, object));
        }
    }
}

/// Processes the first opening line of a lab or a quiz within a paragraph or within HTML, where Markdown does not recognize
/// it. Adds its object, and returns where to resume.
pub(super) fn unseen_fence(text: &str, within: Range<usize>, scan: &mut Scan) -> Option<usize> {
    let mut offset = within.start;
    for line in text.get(within)?.split_inclusive('\n') {
        let start = offset;
        offset += line.len();
        if !line.trim_start().starts_with("```") {
            continue;
        }
        let Some(open) = opener(text, start) else { continue };
        let kind = open.kind();
        if matches!(kind, BlockKind::Code { .. }) {
            continue;
        }
        scan.problems.push(Problem::Unseen(open.clone()));
        let from = open.rest.as_ref().map_or(offset, |rest| rest.start);
        let after = text.get(from..ceil(text, from.saturating_add(MAX_OBJECT)))?;
        let Some(end) = extent::json_end(after).map(|end| from + end) else { return Some(offset) };
        let object = from + after.len() - after.trim_start().len()..end;
        // The intended closing line would now open a fence.
        let mut resume = text.get(end..)?.find('\n').map_or(text.len(), |i| end + i + 1);
        let next = text.get(resume..)?.split_inclusive('\n').next().unwrap_or("");
        if next.trim() == open.closing() {
            resume += next.len();
        }
        let span = open.line.start..resume;
        scan.code.push(span.clone());
        scan.blocks.push(loose_block(text, kind, span, open.head, object));
        return Some(resume);
    }
    None
}

/// Reports opening lines of labs and quizzes within an indented code block, which Markdown displays verbatim.
pub(super) fn indented_fence(text: &str, within: Range<usize>, scan: &mut Scan) {
    let mut offset = within.start;
    let lines = text.get(within).unwrap_or("").split_inclusive('\n');
    for line in lines {
        let start = offset;
        offset += line.len();
        let Some(open) = opener(text, start) else { continue };
        // A page that explains the format may display a fence like this. It is reported only if it contains a lab or a
        // quiz.
        let below = text.get(offset..ceil(text, offset.saturating_add(200))).unwrap_or("").trim_start();
        let holds_json =
            below.strip_prefix('{').is_some_and(|t| t.trim_start().starts_with(extent::is_quote));
        if holds_json && !matches!(open.kind(), BlockKind::Code { .. }) {
            scan.problems.push(Problem::Indented(open));
        }
    }
}

fn loose_block(
    text: &str,
    kind: BlockKind,
    span: Range<usize>,
    info: Range<usize>,
    object: Range<usize>,
) -> Block {
    let value = text.get(object.clone()).unwrap_or("").to_string();
    Block { kind, span, info, body: Text { value, map: SourceMap::verbatim(object) }, whole: true }
}
