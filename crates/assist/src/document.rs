//! A text in an editor, and what is around it.

use super::start::StartedLabs;
use labspec::bind::scene::Models;
use labspec::finding::{self, Finding};
use labspec::lint::{ModelFolder, load_lesson_at};
use labspec::source::{SourceFile, Sources};
use labspec::spec::{Conventions, FileKind, Lesson, kind_of};
use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::Arc;

/// The models and lessons around a document, and the labs that were started with them.
#[derive(Debug)]
pub struct Context {
    /// The models, shared with threads that run labs.
    pub models: Arc<Models>,
    /// The source of other lessons.
    pub sources: Sources,
    /// The labs into which a user pointed last.
    pub(crate) started: StartedLabs,
}

impl Context {
    /// The context of documents whose labs use these models.
    pub fn new(models: Arc<Models>, sources: Sources) -> Context {
        Context { models, sources, started: StartedLabs::default() }
    }
}

/// The text of a document, and how it is read.
#[derive(Clone, Debug)]
pub struct DocumentText {
    file: SourceFile,
    path: PathBuf,
    conventions: Conventions,
}

impl DocumentText {
    /// The lesson.
    pub fn load(self, sources: &Sources, models: &ModelFolder) -> Lesson {
        let lesson = load_lesson_at(self.file, &self.path, sources, models);
        Lesson { conventions: self.conventions, ..lesson }
    }
}

/// A text in an editor: a lesson, a lab or a quiz as JSON, or a model.
#[derive(Debug)]
pub struct Document {
    /// The path, with resolved links if it is a file.
    pub path: PathBuf,
    /// The kind of file, by the extension of the path.
    pub kind: FileKind,
    /// The text.
    pub file: SourceFile,
    /// How the texts of the lesson are read.
    pub conventions: Conventions,
    /// The parsed lesson, if it is one and was parsed since the last change.
    pub lesson: Option<Arc<Lesson>>,
    /// The findings about this text alone.
    pub findings: Vec<Finding>,
    /// The findings about this text that depend on all lessons of its course; after [`Document::check`], those of a course
    /// with this lesson only.
    pub of_course: Vec<Finding>,
    /// The findings of each block, by the text of the block and its dependencies.
    pub(crate) blocks: BTreeMap<String, Vec<Finding>>,
}

impl Document {
    /// A document with this text.
    pub fn new(path: PathBuf, text: &str) -> Document {
        let name = path.display().to_string();
        Document {
            kind: kind_of(&path),
            path,
            file: SourceFile::new(name, text),
            conventions: Conventions::default(),
            lesson: None,
            findings: Vec::new(),
            of_course: Vec::new(),
            blocks: BTreeMap::new(),
        }
    }

    /// Replaces the text. The findings are those of the old text until [`Document::check`].
    pub fn set_text(&mut self, text: impl Into<Arc<str>>) {
        self.file = SourceFile::new(self.file.path().clone(), text);
        self.lesson = None;
    }

    /// All findings, sorted.
    pub fn all_findings(&self) -> Vec<Finding> {
        let mut all = self.of_course.clone();
        all.extend(self.findings.iter().cloned());
        finding::sort(&mut all);
        all
    }

    /// The text, for a thread that loads the lesson.
    pub fn text(&self) -> DocumentText {
        let Document { file, path, conventions, .. } = self;
        DocumentText { file: file.clone(), path: path.clone(), conventions: conventions.clone() }
    }

    /// Sets how the texts are read. Returns whether that changes.
    pub fn set_conventions(&mut self, conventions: Conventions) -> bool {
        let changes = self.conventions != conventions;
        if changes {
            self.conventions = conventions;
            self.forget_models();
        }
        changes
    }

    /// Forgets what depends on models, because models changed.
    pub fn forget_models(&mut self) {
        self.blocks.clear();
        self.lesson = None;
    }

    /// The lesson, parsed if necessary; `None` if the document is not a lesson.
    pub fn read_lesson(&mut self, context: &Context) -> Option<Arc<Lesson>> {
        if !matches!(self.kind, FileKind::Lesson | FileKind::Json) {
            return None;
        }
        let read = || {
            let models = context.models.folder();
            Arc::new(self.text().load(&context.sources, models))
        };
        let lesson = self.lesson.clone().unwrap_or_else(read);
        self.lesson = Some(lesson.clone());
        Some(lesson)
    }
}
