//! What lies around a document: the models that its labs name, compiled once, and the other lessons of the folder.

use super::convert;
use super::documents::OpenDocument;
use super::start::StartedLabs;
use ignore::WalkBuilder;
use labspec::bind::scene::Models;
use labspec::lint::ModelFolder;
use labspec::source::{MAX_FILE, Overlay, SourceFile, Sources};
use labspec::spec::{FileKind, kind_of};
use lsp_types::Uri;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Most lessons of a folder that are looked at.
const MOST: usize = 2_000;
/// Most entries that are walked over to find them.
const MOST_ENTRIES: usize = 100_000;

/// The models of one folder, and the labs that were started with them.
#[derive(Debug)]
pub(super) struct ModelContext {
    /// The models; threads that run labs share them.
    pub(super) models: Arc<Models>,
    /// Where other lessons are read from: the editor's texts, then files.
    pub(super) sources: Sources,
    /// The labs that somebody pointed into last.
    pub(super) started: StartedLabs,
}

/// The models and sources of all open documents, by the folder of models.
#[derive(Debug, Default)]
pub(super) struct ModelContexts {
    by_folder: BTreeMap<Option<PathBuf>, ModelContext>,
    /// The folder of models of each document, as it was found.
    folders: BTreeMap<PathBuf, ModelFolder>,
    /// The texts that the editor holds.
    pub(super) overlay: Arc<Overlay>,
}

impl ModelContexts {
    /// Nothing is compiled yet; these are the texts that the editor holds.
    pub(super) fn with_overlay(overlay: Arc<Overlay>) -> ModelContexts {
        ModelContexts { overlay, ..ModelContexts::default() }
    }

    /// The models and sources of a document.
    pub(super) fn model_context(
        &mut self,
        document: &Path,
        models_of: &dyn Fn(&Path) -> ModelFolder,
    ) -> &mut ModelContext {
        let sources = self.sources();
        let find = || {
            let folder = models_of(document);
            let unsaved = folder.path_of_folder().map(|folder| self.overlay.names_in(folder));
            folder.with_unsaved(unsaved.unwrap_or_default())
        };
        let folder = self.folders.entry(document.to_path_buf()).or_insert_with(find);
        let key = folder.path_of_folder().map(Path::to_path_buf);
        let new = |folder: &ModelFolder| ModelContext {
            models: Arc::new(Models::new(folder.clone()).with_sources(sources.clone())),
            sources: sources.clone(),
            started: StartedLabs::default(),
        };
        let context = self.by_folder.entry(key).or_insert_with(|| new(folder));
        // A model that was added or taken away.
        if context.models.folder().names() != folder.names() {
            *context = new(folder);
        }
        context
    }

    /// The texts of the editor over files.
    pub(super) fn sources(&self) -> Sources {
        Sources::Over(self.overlay.clone())
    }

    /// Texts of models changed: all are compiled anew.
    pub(super) fn forget(&mut self) {
        self.by_folder.clear();
    }

    /// Files may have changed: the disk is asked again for what is there.
    pub(super) fn refresh(&mut self) {
        self.overlay.refresh();
        self.folders.clear();
    }
}

/// A folder that the editor opened.
#[derive(Debug)]
pub(super) struct WorkspaceRoot {
    /// As the editor names it.
    pub(super) named: PathBuf,
    /// Links resolved.
    pub(super) real: PathBuf,
}

/// A file as the editor names it: by the document that it has open, or by the folder that it opened.
pub(super) fn editor_uri(
    path: &Path,
    open: &BTreeMap<String, OpenDocument>,
    folders: &[WorkspaceRoot],
) -> Option<Uri> {
    if let Some(document) = open.values().find(|d| d.path == path) {
        return Some(document.uri.clone());
    }
    let inside = folders.iter().find_map(|f| Some(f.named.join(path.strip_prefix(&f.real).ok()?)));
    convert::uri_of_path(inside.as_deref().unwrap_or(path))
}

/// The lessons below a folder, as the editor holds them or else as they are saved. Files that `.gitignore` names are left out.
pub(super) fn lessons_below(folder: &Path, open: &BTreeMap<String, OpenDocument>) -> Vec<SourceFile> {
    let mut paths: Vec<PathBuf> = WalkBuilder::new(folder)
        .build()
        .take(MOST_ENTRIES)
        .flatten()
        .map(ignore::DirEntry::into_path)
        .filter(|path| matches!(kind_of(path), FileKind::Lesson | FileKind::Json) && path.is_file())
        .collect();
    paths.extend(open.values().filter(|d| d.path.starts_with(folder)).map(|d| d.path.clone()));
    paths.retain(|path| matches!(kind_of(path), FileKind::Lesson | FileKind::Json));
    paths.sort();
    paths.dedup();
    paths.truncate(MOST);
    paths.iter().filter_map(|path| text_of(path, open)).collect()
}

/// A file as the editor holds it, or else as it is saved.
pub(super) fn text_of(path: &Path, open: &BTreeMap<String, OpenDocument>) -> Option<SourceFile> {
    if let Some(document) = open.values().find(|d| d.path == path) {
        return Some(document.file.clone());
    }
    let small = std::fs::metadata(path).is_ok_and(|m| m.is_file() && m.len() <= MAX_FILE);
    if small { SourceFile::read(path).ok() } else { None }
}
