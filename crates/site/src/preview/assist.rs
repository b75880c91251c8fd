//! What an open editor shows while an author types: findings with fixes, completions and hover texts of the whole lesson with the
//! edited block in it. Offsets are those of the block, as JavaScript counts them.

use super::http::Refused;
use labspec::bind::scene::Models;
use labspec::finding::{Finding, Severity};
use labspec::lint::ModelFolder;
use labspec::source::{MAX_FILE, Sources};
use labspec_assist::{Completion, Context, Document, Edit, TextFix, Utf16Offsets, completions, fixes, hover};
use serde_json::{Value, json};
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// A lesson with an edited block.
pub(super) struct EditedLesson<'l> {
    /// The file of the lesson.
    pub(super) path: &'l Path,
    /// The models of the lesson.
    pub(super) models: ModelFolder,
    /// The text of the file, and the bytes of the block in it.
    pub(super) old: &'l str,
    pub(super) block: Range<usize>,
    /// The text of the block in the editor.
    pub(super) text: &'l str,
}

/// A lesson, the block of an editor in it, and the conversion of offsets.
struct Opened {
    document: Document,
    context: Context,
    block: Range<usize>,
}

/// Answers a question of an editor: `findings`, `complete` or `hover`, the last two at an offset of the block.
pub(super) fn assist(question: &str, edited: EditedLesson<'_>, offset: usize) -> Result<Value, Refused> {
    let mut opened = open(edited)?;
    Ok(match question {
        "findings" => opened.findings(),
        "complete" => opened.completions(offset),
        _ => opened.hover(offset),
    })
}

/// An editor ends lines with `\n`, so the lesson around its block does here as well.
fn open(edited: EditedLesson<'_>) -> Result<Opened, Refused> {
    let EditedLesson { path, models, old, block, text } = edited;
    let (Some(before), Some(after)) = (old.get(..block.start), old.get(block.end..)) else {
        return Err((400, "the request names no block of this page".into()));
    };
    let [before, text, after] = [before, text, after].map(|part| part.replace("\r\n", "\n"));
    let whole = format!("{before}{text}{after}");
    if whole.len() as u64 > MAX_FILE {
        return Err((413, "the lesson would be too large".into()));
    }
    let models = Arc::new(Models::new(models).with_sources(Sources::Disk));
    Ok(Opened {
        document: Document::new(PathBuf::from(path), &whole),
        context: Context::new(models, Sources::Disk),
        block: before.len()..before.len() + text.len(),
    })
}

impl Opened {
    /// The findings of the lesson that are in the block. Nothing is run.
    fn findings(&mut self) -> Value {
        self.document.check(&self.context);
        let lesson = self.document.read_lesson(&self.context);
        let file = &self.document.file;
        let place = BlockPlace::new(file.text(), &self.block);
        let here = self.document.findings.iter().filter(|f| f.path == *file.path());
        let all = here.filter_map(|f| {
            let (start, end) = place.range(&f.span)?;
            let suppression = lesson.as_ref().and_then(|lesson| fixes::suppression(lesson, f));
            let fixes = fixes::fix(file, f).into_iter().chain(suppression);
            let fixes: Vec<Value> = fixes.filter_map(|fix| place.fix(&fix)).collect();
            Some(finding(f, start, end, &fixes))
        });
        json!({ "findings": all.collect::<Vec<_>>() })
    }

    fn completions(&mut self, offset: usize) -> Value {
        let byte = BlockPlace::new(self.document.file.text(), &self.block).byte(offset);
        let all = completions(&mut self.document, &self.context, byte);
        let place = BlockPlace::new(self.document.file.text(), &self.block);
        json!({ "completions": all.iter().filter_map(|c| place.completion(c)).collect::<Vec<_>>() })
    }

    fn hover(&mut self, offset: usize) -> Value {
        let byte = BlockPlace::new(self.document.file.text(), &self.block).byte(offset);
        let found = hover(&mut self.document, &mut self.context, byte);
        let place = BlockPlace::new(self.document.file.text(), &self.block);
        let found = found.and_then(|hover| {
            let (start, end) = place.range(&hover.span)?;
            Some(json!({ "start": start, "end": end, "text": hover.text }))
        });
        json!({ "hover": found })
    }
}

fn finding(f: &Finding, start: usize, end: usize, fixes: &[Value]) -> Value {
    let severity = match f.severity {
        Severity::Error => "error",
        Severity::Warning => "warning",
        Severity::Note => "note",
    };
    json!({
        "code": f.code, "severity": severity, "start": start, "end": end, "message": f.message, "why": f.why, "help": f.help,
        "fixes": fixes,
    })
}

/// The place of the block in the lesson.
struct BlockPlace<'t> {
    offsets: Utf16Offsets<'t>,
    block: &'t Range<usize>,
    /// The offset of the block, and that of its end.
    first: usize,
    last: usize,
}

impl<'t> BlockPlace<'t> {
    fn new(text: &'t str, block: &'t Range<usize>) -> BlockPlace<'t> {
        let offsets = Utf16Offsets::new(text);
        let (first, last) = (offsets.of_byte(block.start), offsets.of_byte(block.end));
        BlockPlace { offsets, block, first, last }
    }

    /// The byte of the lesson at an offset of the block.
    fn byte(&self, offset: usize) -> usize {
        self.offsets.to_byte(self.first.saturating_add(offset).min(self.last))
    }

    /// A range of the lesson as offsets of the block; `None` where it reaches beyond the block.
    fn range(&self, span: &Range<usize>) -> Option<(usize, usize)> {
        let is_inside = self.block.start <= span.start && span.end <= self.block.end;
        let offset = |byte: usize| self.offsets.of_byte(byte) - self.first;
        is_inside.then(|| (offset(span.start), offset(span.end)))
    }

    fn edit(&self, edit: &Edit) -> Option<Value> {
        let (start, end) = self.range(&edit.span)?;
        Some(json!({ "start": start, "end": end, "text": edit.text }))
    }

    fn fix(&self, fix: &TextFix) -> Option<Value> {
        Some(json!({ "title": fix.title, "kind": fix.kind.as_str(), "edits": [self.edit(&fix.edit)?] }))
    }

    fn completion(&self, c: &Completion) -> Option<Value> {
        Some(json!({
            "label": c.label, "kind": c.kind.as_str(), "detail": c.detail, "documentation": c.documentation, "filter": c.filter,
            "edit": self.edit(&c.edit)?,
        }))
    }
}
