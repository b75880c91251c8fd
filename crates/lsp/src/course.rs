//! The findings that depend on all lessons of a course. The lessons below a folder that is open in the editor are one course;
//! a lesson outside of these folders is a course of its own.

use super::context::{WorkspaceRoot, lessons_below};
use super::documents::OpenDocument;
use labspec::finding::Finding;
use labspec::lint::{ModelFolder, check_course, load_lesson_at};
use labspec::source::Sources;
use labspec::spec::Lesson;
use labspec::threads;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The lessons of each open folder that are files, by path. They are read when a file may have changed, and parsed when its text
/// has.
#[derive(Debug, Default)]
pub(super) struct CourseFiles {
    lessons: BTreeMap<String, Arc<Lesson>>,
    /// The folders whose files were read.
    read: Vec<PathBuf>,
}

impl CourseFiles {
    /// Reads the files again when they are used next.
    pub(super) fn refresh(&mut self) {
        self.read.clear();
    }

    /// Whether files were read since they may have changed.
    pub(super) fn are_read(&self) -> bool {
        !self.read.is_empty()
    }

    /// Forgets all files, because other folders are open.
    pub(super) fn forget(&mut self) {
        *self = CourseFiles::default();
    }

    /// Reads the lessons below a folder.
    fn read_below(&mut self, folder: &Path, open: &BTreeMap<String, OpenDocument>) {
        if self.read.iter().any(|read| read == folder) {
            return;
        }
        self.read.push(folder.to_path_buf());
        let mut before = std::mem::take(&mut self.lessons);
        for file in lessons_below(folder, open) {
            let parsed = before.remove(&**file.path()).filter(|lesson| lesson.file.text() == file.text());
            let path = file.path().to_string();
            // Only its own text counts: its models and other files are not read.
            let nowhere = (Sources::default(), ModelFolder::unknown());
            let parse = || {
                let load = || Arc::new(load_lesson_at(file, Path::new(&path), &nowhere.0, &nowhere.1));
                threads::catch_panic(load).ok()
            };
            if let Some(lesson) = parsed.or_else(parse) {
                self.lessons.insert(path.clone(), lesson);
            }
        }
        before.retain(|path, _| !Path::new(path).starts_with(folder));
        self.lessons.append(&mut before);
    }

    /// The findings of the course of a folder: its files, and the open documents in place of theirs.
    fn findings_below(&mut self, root: &Path, open: &BTreeMap<String, OpenDocument>) -> Vec<Finding> {
        self.read_below(root, open);
        let files = self.lessons.iter().filter(|(path, _)| Path::new(path).starts_with(root));
        let mut lessons: BTreeMap<&str, &Lesson> =
            files.map(|(path, lesson)| (path.as_str(), &**lesson)).collect();
        for document in open.values().filter(|document| document.content.path.starts_with(root)) {
            if let Some(lesson) = document.content.lesson.as_deref() {
                lessons.insert(lesson.file.path(), lesson);
            }
        }
        check_course(&lessons.into_values().collect::<Vec<_>>())
    }
}

/// Finds the findings about open documents that depend on their courses. Returns the documents whose findings changed, by URI.
pub(super) fn update(
    files: &mut CourseFiles,
    documents: &mut BTreeMap<String, OpenDocument>,
    folders: &[WorkspaceRoot],
    policy: &mut dyn FnMut(&Path, &mut Vec<Finding>),
) -> Vec<String> {
    let mut changed = Vec::new();
    // Several documents of a folder share its findings.
    let mut by_folder: BTreeMap<&Path, Vec<Finding>> = BTreeMap::new();
    for (uri, document) in &*documents {
        let path = document.content.file.path();
        let mut roots = folders.iter().map(|folder| folder.real.as_path());
        let mut found: Vec<Finding> = match roots.find(|root| document.content.path.starts_with(root)) {
            Some(root) => {
                let all = by_folder.entry(root).or_insert_with(|| files.findings_below(root, documents));
                all.iter().filter(|finding| finding.path == *path).cloned().collect()
            }
            // A course of its own.
            None => document.content.lesson.as_deref().map_or(Vec::new(), |lesson| check_course(&[lesson])),
        };
        policy(&document.content.path, &mut found);
        if found != document.content.of_course {
            changed.push((uri.clone(), found));
        }
    }
    let update_one = |(uri, found)| {
        documents.get_mut(&uri)?.content.of_course = found;
        Some(uri)
    };
    changed.into_iter().filter_map(update_one).collect()
}
