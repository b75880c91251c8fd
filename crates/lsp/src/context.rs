//! The context of a document: the models of its labs, each compiled once, and the other lessons of the folder.

use super::convert;
use super::documents::OpenDocument;
use ignore::WalkBuilder;
use labspec::bind::scene::Models;
use labspec::lint::ModelFolder;
use labspec::source::{MAX_FILE, Overlay, SourceFile, Sources};
use labspec::spec::{FileKind, kind_of};
use labspec_assist::Context;
use lsp_types::Uri;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The maximum number of lessons of a folder that are searched.
const MOST: usize = 2_000;
/// The maximum number of directory entries that are visited to find them.
const MOST_ENTRIES: usize = 100_000;

/// The models and sources of all open documents, by folder of models.
#[derive(Debug, Default)]
pub(super) struct ModelContexts {
    by_folder: BTreeMap<Option<PathBuf>, Context>,
    /// The folder of models of each document, cached.
    folders: BTreeMap<PathBuf, ModelFolder>,
    /// The texts in the editor.
    pub(super) overlay: Arc<Overlay>,
}

impl ModelContexts {
    /// Creates the contexts without compiled models, for the texts in the editor.
    pub(super) fn with_overlay(overlay: Arc<Overlay>) -> ModelContexts {
        ModelContexts { overlay, ..ModelContexts::default() }
    }

    /// Returns the models and sources of a document.
    pub(super) fn model_context(
        &mut self,
        document: &Path,
        models_of: &dyn Fn(&Path) -> ModelFolder,
    ) -> &mut Context {
        let sources = self.sources();
        let find = || {
            let folder = models_of(document);
            let unsaved = folder.path_of_folder().map(|folder| self.overlay.names_in(folder));
            folder.with_unsaved(unsaved.unwrap_or_default())
        };
        let folder = self.folders.entry(document.to_path_buf()).or_insert_with(find);
        let key = folder.path_of_folder().map(Path::to_path_buf);
        let new = |folder: &ModelFolder| {
            let models = Models::new(folder.clone()).with_sources(sources.clone());
            Context::new(Arc::new(models), sources.clone())
        };
        let context = self.by_folder.entry(key).or_insert_with(|| new(folder));
        // A model was added or removed.
        if context.models.folder().names() != folder.names() {
            *context = new(folder);
        }
        context
    }

    /// The texts of the editor, which override files.
    pub(super) fn sources(&self) -> Sources {
        Sources::Over(self.overlay.clone())
    }

    /// Discards all compiled models, because texts of models changed.
    pub(super) fn forget(&mut self) {
        self.by_folder.clear();
    }

    /// Discards cached information about files, which may have changed on disk.
    pub(super) fn refresh(&mut self) {
        self.overlay.refresh();
        self.folders.clear();
    }
}

/// A folder that is open in the editor.
#[derive(Debug)]
pub(super) struct WorkspaceRoot {
    /// The path as the editor names it.
    pub(super) named: PathBuf,
    /// The path with resolved links.
    pub(super) real: PathBuf,
}

/// The URI of a file as the editor names it: that of an open document, or one below an open folder.
pub(super) fn editor_uri(
    path: &Path,
    open: &BTreeMap<String, OpenDocument>,
    folders: &[WorkspaceRoot],
) -> Option<Uri> {
    if let Some(document) = open.values().find(|d| d.content.path == path) {
        return Some(document.uri.clone());
    }
    let inside = folders.iter().find_map(|f| Some(f.named.join(path.strip_prefix(&f.real).ok()?)));
    convert::uri_of_path(inside.as_deref().unwrap_or(path))
}

/// The lessons below a folder, with the text of the editor or of the file. Files listed in `.gitignore` are left out.
pub(super) fn lessons_below(folder: &Path, open: &BTreeMap<String, OpenDocument>) -> Vec<SourceFile> {
    let mut paths: Vec<PathBuf> = WalkBuilder::new(folder)
        .build()
        .take(MOST_ENTRIES)
        .flatten()
        .map(ignore::DirEntry::into_path)
        .filter(|path| matches!(kind_of(path), FileKind::Lesson | FileKind::Json) && path.is_file())
        .collect();
    paths
        .extend(open.values().filter(|d| d.content.path.starts_with(folder)).map(|d| d.content.path.clone()));
    paths.retain(|path| matches!(kind_of(path), FileKind::Lesson | FileKind::Json));
    paths.sort();
    paths.dedup();
    paths.truncate(MOST);
    paths.iter().filter_map(|path| text_of(path, open)).collect()
}

/// A file with the text of the editor, or as it is saved.
pub(super) fn text_of(path: &Path, open: &BTreeMap<String, OpenDocument>) -> Option<SourceFile> {
    if let Some(document) = open.values().find(|d| d.content.path == path) {
        return Some(document.content.file.clone());
    }
    let small = std::fs::metadata(path).is_ok_and(|m| m.is_file() && m.len() <= MAX_FILE);
    if small { SourceFile::read(path).ok() } else { None }
}
