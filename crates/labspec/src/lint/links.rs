//! Links of a lesson that lead to nothing: files of the course that are not there, headings that no lesson has.

use super::models::root_of;
use crate::finding::Finding;
use crate::markdown::html::tags;
use crate::markdown::{self, Link, Scan};
use crate::rules;
use crate::source::{Asked, MAX_FILE, SourceFile, Sources};
use crate::spec::Lesson;
use percent_encoding::percent_decode_str;
use std::borrow::Cow;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// Most links that are followed.
const MOST: usize = 1000;
/// What a site makes of a lesson, and no file of the course has.
const PAGES: [&str; 2] = ["html", "htm"];

/// Letters and digits of a heading or an anchor: sites write the rest in their own ways.
fn letters(text: &str) -> String {
    text.chars().filter(|c| c.is_alphanumeric()).flat_map(char::to_lowercase).collect()
}

/// Whether a text has this anchor: a heading, or an element with this id.
fn has_anchor(text: &str, scan: &Scan, ids: &BTreeSet<String>, anchor: &str) -> bool {
    let meant = letters(anchor);
    // `fall-1` is the second heading "Fall".
    let plain = meant.trim_end_matches(|c: char| c.is_ascii_digit());
    let heading = scan.headings.iter().filter_map(|h| text.get(h.clone())).any(|heading| {
        let heading_letters = letters(heading);
        heading_letters == meant
            || heading_letters == plain
            || heading_letters.trim_start_matches(|c: char| c.is_ascii_digit()) == meant
            || heading.contains(&format!("{{#{anchor}}}"))
    });
    heading || ids.contains(anchor)
}

/// The names of places in the HTML of a text.
fn ids(text: &str, scan: &Scan) -> BTreeSet<String> {
    let tags = scan.html.iter().filter_map(|html| text.get(html.clone())).flat_map(tags);
    let attributes = tags.flat_map(|tag| tag.attributes);
    attributes.filter(|(name, _)| name == "id" || name == "name").map(|(_, value)| value).collect()
}

/// What a site numbers itself, or names after an id.
fn is_of_the_site(lesson: &Lesson, anchor: &str) -> bool {
    let meant = letters(anchor);
    let numbered = ["lab", "quiz", "fig", "figure", "eq", "equation", "tab", "table", "top", "ref", "fn"];
    let stem = meant.trim_end_matches(|c: char| c.is_ascii_digit());
    let ids = lesson.quizzes.iter().filter_map(|q| q.id.as_ref()).map(|id| letters(id.as_str()));
    numbered.contains(&stem) || ids.into_iter().any(|id| !id.is_empty() && meant.contains(&id))
}

/// Anchors of the lesson itself.
pub(super) fn check_anchors(lesson: &Lesson, findings: &mut Vec<Finding>) {
    let text = lesson.file.text();
    let mut ids_here = None;
    for link in lesson.scan.links.iter().take(MOST) {
        let Some(anchor) = link.target.strip_prefix('#').filter(|a| !a.is_empty()) else { continue };
        let ids = ids_here.get_or_insert_with(|| ids(text, &lesson.scan));
        if !has_anchor(text, &lesson.scan, ids, &decoded(anchor)) && !is_of_the_site(lesson, anchor) {
            findings.push(finding(link, "this lesson has no such heading"));
        }
    }
}

/// A link to a file of the course.
struct Named<'l> {
    link: &'l Link,
    /// The file, as the link names it, from the folder of the lesson.
    path: PathBuf,
    extension: String,
    anchor: Option<String>,
}

/// The files of the course that links of a lesson name; nothing that a site makes itself.
fn named<'l>(lesson: &'l Lesson, folder: &Path) -> impl Iterator<Item = Named<'l>> {
    lesson.scan.links.iter().take(MOST).filter_map(move |link| {
        let (file, anchor) = inside(&link.target)?;
        let path = joined(folder, &file).filter(|_| !file.ends_with('/'))?;
        let extension = path.extension().and_then(|e| e.to_str()).unwrap_or("").to_ascii_lowercase();
        let is_page = extension.is_empty() || PAGES.contains(&extension.as_str());
        (!is_page).then_some(Named { link, path, extension, anchor })
    })
}

/// The folder of a lesson, links resolved where it has one.
fn folder_of(path: &Path, sources: &Sources) -> PathBuf {
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
    named(lesson, &folder)
        .any(|named| named.path == file || sources.real(&named.path).as_deref() == Some(file))
}

/// Files that links of a lesson name, and headings of those that are lessons. Nothing outside of the root is looked at.
pub(super) fn check_files(lesson: &Lesson, path: &Path, sources: &Sources, findings: &mut Vec<Finding>) {
    let folder = folder_of(path, sources);
    let mut root = None;
    for Named { link, path, extension, anchor } in named(lesson, &folder) {
        let root = root.get_or_insert_with(|| {
            let found = sources.place(Asked::Root, &folder, || Some(root_of(&folder, &[])));
            found.unwrap_or_default()
        });
        if !path.starts_with(&*root) {
            continue;
        }
        match (sources.real(&path), anchor) {
            (None, _) if sources.has_files() => findings.push(finding(
                link,
                if link.image { "this image does not exist" } else { "this file does not exist" },
            )),
            (Some(real), Some(anchor)) if extension == "md" && real.starts_with(&*root) => {
                let Ok(text) = sources.text(&real, MAX_FILE, "a lesson") else { continue };
                let other = SourceFile::new(real.display().to_string(), text);
                let scan = markdown::scan(&other);
                if !has_anchor(other.text(), &scan, &ids(other.text(), &scan), &decoded(&anchor))
                    && !is_of_the_site(lesson, &anchor)
                {
                    findings.push(finding(link, "that lesson has no such heading"));
                }
            }
            _ => {}
        }
    }
}

/// The file of the course that a link names, and the anchor there; `None` for the web, for a path of the site, and for nothing.
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

/// A path from a folder, without steps that lead back; `None` where it leads above everything.
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

/// `%20` is a space.
fn decoded(text: &str) -> Cow<'_, str> {
    percent_decode_str(text).decode_utf8_lossy()
}

fn finding(link: &Link, message: &str) -> Finding {
    let short_target = crate::json::read::shorten(&link.target);
    Finding::new(rules::DEAD_LINK, link.span.clone(), format!("`{short_target}`: {message}"))
        .help("correct the link, or add its target")
}
