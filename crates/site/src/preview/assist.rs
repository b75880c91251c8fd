//! What an open editor shows while an author types: findings with fixes, completions and hover texts of the whole lesson with the
//! edited block in it. Offsets are those of the block, as JavaScript counts them.

use super::http::Refusal;
use labspec::bind::scene::Models;
use labspec::lint::ModelFolder;
use labspec::report::to_value;
use labspec::source::{MAX_FILE, Sources};
use labspec_assist::{Context, Document, EditorText, FindingAnswer, TextFix, completions, fixes, hover};
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
pub(super) fn assist(question: &str, edited: EditedLesson<'_>, offset: usize) -> Result<Value, Refusal> {
    let mut opened = open(edited)?;
    Ok(match question {
        "findings" => opened.findings(),
        "complete" => opened.completions(offset),
        _ => opened.hover(offset),
    })
}

/// An editor ends lines with `\n`, so the lesson around its block does here as well.
fn open(edited: EditedLesson<'_>) -> Result<Opened, Refusal> {
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
        let editor = EditorText::block(file.text(), self.block.clone());
        let here = self.document.findings.iter().filter(|f| f.path == *file.path());
        let all = here.filter_map(|f| {
            let range = editor.range(&f.span)?;
            let suppression = lesson.as_ref().and_then(|lesson| fixes::suppression(lesson, f));
            let fixes: Vec<TextFix> = fixes::fix(file, f).into_iter().chain(suppression).collect();
            let fixes = fixes.iter().filter_map(|fix| editor.fix(fix)).collect();
            Some(to_value(&FindingAnswer::new(f, range, fixes)))
        });
        json!({ "findings": all.collect::<Vec<_>>() })
    }

    fn completions(&mut self, offset: usize) -> Value {
        let byte = EditorText::block(self.document.file.text(), self.block.clone()).byte(offset);
        let all = completions(&mut self.document, &self.context, byte);
        let editor = EditorText::block(self.document.file.text(), self.block.clone());
        json!({ "completions": all.iter().filter_map(|c| editor.completion(c)).collect::<Vec<_>>() })
    }

    fn hover(&mut self, offset: usize) -> Value {
        let byte = EditorText::block(self.document.file.text(), self.block.clone()).byte(offset);
        let found = hover(&mut self.document, &mut self.context, byte);
        let editor = EditorText::block(self.document.file.text(), self.block.clone());
        json!({ "hover": found.as_ref().and_then(|hover| editor.hover(hover)) })
    }
}
