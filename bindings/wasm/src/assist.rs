//! What an editor shows: findings with fixes while an author types, completions and hover texts. Offsets are UTF-16, as in JavaScript.

use crate::error::call_error;
use crate::files::PageModels;
use crate::{Models, Neighbours, named, object};
use labspec::bind::scene;
use labspec::finding::Finding;
use labspec::lint::ModelFolder;
use labspec::report::to_value;
use labspec::source::{MAX_FILE, SourceFile, Sources};
use labspec::spec::Lesson;
use labspec_assist::{
    Context, Document, EditorText, FindingAnswer, LabText, Utf16Offsets, completions, fixes, hover, lab_texts,
};
use serde_json::{Value as Json, json};
use std::path::PathBuf;
use std::sync::Arc;
use wasm_bindgen::prelude::*;

/// The maximum number of texts whose findings are kept.
const MOST_OPEN: usize = 8;

/// Texts that are edited, with the models and lessons around them.
#[wasm_bindgen]
pub struct Assistant {
    context: Context,
    /// The texts that were asked about last, by their paths.
    open: Vec<(String, Document)>,
}

#[wasm_bindgen]
impl Assistant {
    /// For texts whose labs use these models, beside these lessons.
    #[wasm_bindgen(constructor)]
    pub fn new(models: &Models, neighbours: Option<Neighbours>) -> Result<Assistant, JsValue> {
        let folder = ModelFolder::from(PageModels::new(models)?);
        let sources = match neighbours {
            Some(texts) => Sources::given(named(&texts)?),
            None => Sources::default(),
        };
        let models = scene::Models::new(folder).with_sources(sources.clone());
        Ok(Assistant { context: Context::new(Arc::new(models), sources), open: Vec::new() })
    }

    /// The findings of a text; nothing is run.
    pub fn findings(&mut self, path: &str, text: &str) -> Result<JsValue, JsValue> {
        let (context, document) = self.document(path, text)?;
        document.check(context);
        let lesson = document.read_lesson(context);
        let editor = EditorText::whole(document.file.text());
        let found = document.all_findings();
        object(&found.iter().map(|f| with_fixes(f, &document.file, lesson.as_deref(), &editor)).collect())
    }

    /// The completions at an offset.
    pub fn complete(&mut self, path: &str, text: &str, offset: usize) -> Result<JsValue, JsValue> {
        let (context, document) = self.document(path, text)?;
        let byte = Utf16Offsets::new(document.file.text()).to_byte(offset);
        let all = completions(document, context, byte);
        let editor = EditorText::whole(document.file.text());
        object(&all.iter().filter_map(|c| editor.completion(c)).map(|c| to_value(&c)).collect())
    }

    /// The hover text at an offset; `null` if there is none.
    pub fn hover(&mut self, path: &str, text: &str, offset: usize) -> Result<JsValue, JsValue> {
        let (context, document) = self.document(path, text)?;
        let byte = Utf16Offsets::new(document.file.text()).to_byte(offset);
        let found = hover(document, context, byte);
        let editor = EditorText::whole(document.file.text());
        object(&to_value(&found.as_ref().and_then(|hover| editor.hover(hover))))
    }

    /// The edit that applies all safe fixes; `null` if there is none.
    #[wasm_bindgen(js_name = fixAll)]
    pub fn fix_all(&mut self, path: &str, text: &str) -> Result<JsValue, JsValue> {
        let (context, document) = self.document(path, text)?;
        document.check(context);
        let lesson = document.read_lesson(context);
        let found = lesson.and_then(|lesson| fixes::fix_all(document, &lesson, &context.models));
        let editor = EditorText::whole(document.file.text());
        object(&to_value(&found.as_ref().and_then(|fix| editor.fix(fix))))
    }

    /// The labs of a lesson.
    pub fn labs(&mut self, path: &str, text: &str) -> Result<JsValue, JsValue> {
        let (context, document) = self.document(path, text)?;
        let lesson = document.read_lesson(context);
        let offsets = Utf16Offsets::new(document.file.text());
        let all = lesson.map_or_else(Vec::new, |lesson| lab_texts(&lesson));
        let one = |lab: &LabText| {
            let (start, end) = (offsets.of_byte(lab.span.start), offsets.of_byte(lab.span.end));
            json!({
                "address": lab.address, "title": lab.title, "model": lab.model, "start": start, "end": end, "json": lab.json,
            })
        };
        object(&all.iter().map(one).collect())
    }

    /// The text with its code formatted.
    pub fn format(&mut self, path: &str, text: &str) -> Result<String, JsValue> {
        let (context, document) = self.document(path, text)?;
        let lesson = document.read_lesson(context);
        let formatted = lesson.map(|lesson| labspec::format::format(&lesson, None).text);
        Ok(formatted.unwrap_or_else(|| text.to_string()))
    }
}

impl Assistant {
    /// The document of a path with this text, as it was left if the text is the same.
    fn document(&mut self, path: &str, text: &str) -> Result<(&mut Context, &mut Document), JsValue> {
        if text.len() as u64 > MAX_FILE {
            let most = MAX_FILE >> 20;
            return Err(call_error("too-large", &format!("a text can have at most {most} MB")));
        }
        let mut found = match self.open.iter().position(|(name, _)| name == path) {
            Some(index) => self.open.remove(index),
            None => (path.to_string(), Document::new(PathBuf::from(path), text)),
        };
        if found.1.file.text() != text {
            found.1.set_text(text);
        }
        if self.open.len() >= MOST_OPEN {
            self.open.remove(0);
        }
        self.open.push(found);
        let last = self.open.last_mut().map(|(_, document)| (&mut self.context, document));
        last.ok_or_else(|| call_error("call", "no document is open"))
    }
}

/// A finding with the edits that resolve it. Only findings of this file have any. Its range counts bytes, because it may be in
/// another file, whose text the page has.
pub(crate) fn with_fixes(
    f: &Finding,
    file: &SourceFile,
    lesson: Option<&Lesson>,
    editor: &EditorText<'_>,
) -> Json {
    let mut all = Vec::new();
    if f.path == *file.path() {
        all.extend(fixes::fix(file, f));
        all.extend(lesson.and_then(|lesson| fixes::suppression(lesson, f)));
    }
    to_value(&FindingAnswer::new(f, f.span.clone(), all.iter().filter_map(|fix| editor.fix(fix)).collect()))
}
