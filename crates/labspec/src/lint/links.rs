//! The files of a course to which the links of a lesson point.

use crate::markdown::Link;
use crate::source::Sources;
use crate::spec::Lesson;
use percent_encoding::percent_decode_str;
use std::borrow::Cow;
use std::path::{Path, PathBuf};

/// Maximum number of links that are followed.
pub(crate) const MOST: usize = 1000;
/// Extensions of pages that a site generates, which are not files of the course.
const PAGES: [&str; 2] = ["html", "htm"];

/// A link to a file of the course.
pub(crate) struct LinkedFile<'l> {
    pub(crate) link: &'l Link,
    /// The path of the file, resolved from the folder of the lesson.
    pub(crate) path: PathBuf,
    pub(crate) extension: String,
    pub(crate) anchor: Option<String>,
}

/// The files of the course to which links of a lesson point, without pages that a site generates.
pub(crate) fn linked_files<'l>(lesson: &'l Lesson, folder: &Path) -> impl Iterator<Item = LinkedFile<'l>> {
    lesson.scan.links.iter().take(MOST).filter_map(move |link| {
        let (file, anchor) = inside(&link.target)?;
        let path = joined(folder, &file).filter(|_| !file.ends_with('/'))?;
        let extension = path.extension().and_then(|e| e.to_str()).unwrap_or("").to_ascii_lowercase();
        let is_page = extension.is_empty() || PAGES.contains(&extension.as_str());
        (!is_page).then_some(LinkedFile { link, path, extension, anchor })
    })
}

/// The folder of a lesson, with symbolic links resolved where possible.
pub(crate) fn folder_of(path: &Path, sources: &Sources) -> PathBuf {
    let parent = |path: &Path| match path.parent() {
        Some(folder) if folder != Path::new("") => folder.to_path_buf(),
        _ => PathBuf::from("."),
    };
    match sources.real(path) {
        Some(real) => parent(&real),
        None => sources.real(&parent(path)).unwrap_or_else(|| parent(path)),
    }
}

/// Whether a lesson links to a file.
pub fn links_to(lesson: &Lesson, file: &Path) -> bool {
    let Some((path, sources)) = &lesson.place else { return false };
    let folder = folder_of(path, sources);
    linked_files(lesson, &folder)
        .any(|linked| linked.path == file || sources.real(&linked.path).as_deref() == Some(file))
}

/// The file of the course to which a link points, and the anchor in it; `None` for the web, for a path of the site, and for
/// an empty link.
fn inside(target: &str) -> Option<(String, Option<String>)> {
    let scheme = target.split(['/', '?', '#']).next().is_some_and(|head| head.contains(':'));
    if scheme || target.starts_with(['/', '#', '\\', '?', '{', '<']) || target.contains("{{") {
        return None;
    }
    let (file, anchor) = match target.split_once('#') {
        Some((file, anchor)) => (file, Some(anchor.to_string()).filter(|a| !a.is_empty())),
        None => (target, None),
    };
    let path = file.split('?').next().unwrap_or(file);
    let file = decoded(path).into_owned();
    (!file.is_empty()).then_some((file, anchor))
}

/// A path relative to a folder, with `..` resolved; `None` where it leaves the root of the path.
fn joined(folder: &Path, file: &str) -> Option<PathBuf> {
    let mut path = folder.to_path_buf();
    for part in file.split('/') {
        match part {
            "" | "." => {}
            ".." => {
                path.pop().then_some(())?;
            }
            part => path.push(part),
        }
    }
    Some(path)
}

/// Decodes percent escapes: `%20` is a space.
pub(crate) fn decoded(text: &str) -> Cow<'_, str> {
    percent_decode_str(text).decode_utf8_lossy()
}
