//! All pages after a check, with the texts for which they were made.

use super::author::{AuthorView, text_hash, unwritten_items};
use super::backend::{Backend, CourseCheck, Proposals};
use crate::assets::PageFiles;
use crate::options::{SiteFile, SiteOptions};
use crate::overview::{index_main, labs_main, neighbours};
use crate::page::Page;
use crate::search::search_index;
use crate::site::{Course, CoursePages, write_pages};
use crate::text::escape;
use labspec::finding::Finding;
use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::{Arc, OnceLock};

/// A lesson as a page shows it.
#[derive(Debug)]
pub(super) struct ServedLesson {
    pub(super) path: PathBuf,
    /// Its place in the check.
    pub(super) index: usize,
    /// The hash of its text.
    pub(super) hash: String,
    /// The bytes of its blocks.
    pub(super) blocks: Vec<Range<usize>>,
    /// The findings in it, as requests name them.
    pub(super) findings: Vec<Finding>,
    /// What its runs suggest, computed when a page asks for it.
    pub(super) proposals: OnceLock<Proposals>,
}

/// All pages of one version.
#[derive(Debug, Default)]
pub(super) struct Snapshot {
    pub(super) version: u64,
    pub(super) files: BTreeMap<String, SiteFile>,
    /// By the names of their pages.
    pub(super) lessons: BTreeMap<String, ServedLesson>,
    pub(super) course: Arc<CourseCheck>,
    /// Further files that the pages show.
    pub(super) watched: BTreeSet<PathBuf>,
}

/// What a snapshot is made of.
pub(super) struct SnapshotMaterial<'m> {
    pub(super) backend: &'m dyn Backend,
    pub(super) folder: &'m Path,
    pub(super) options: &'m SiteOptions,
    pub(super) page_files: &'m PageFiles,
    pub(super) token: &'m str,
}

impl Snapshot {
    /// Writes all pages.
    pub(super) fn new(
        material: &SnapshotMaterial<'_>,
        course: Arc<CourseCheck>,
        version: u64,
        is_checked: bool,
        problem: Option<&str>,
    ) -> Snapshot {
        let models = |path: &Path| material.backend.models(path);
        let written = write_pages(
            &Course {
                folder: material.folder,
                index: None,
                sources: None,
                lessons: &course.lessons,
                ledger: &course.ledger,
                models: &models,
            },
            true,
        );
        let mut snapshot = Snapshot { version, course: course.clone(), ..Snapshot::default() };
        let unwritten: Vec<String> =
            written.shelf.problems.iter().cloned().collect::<BTreeSet<_>>().into_iter().collect();
        snapshot.add_lessons(material, &written, is_checked, (problem, &unwritten));
        let head = head(material.token, version);
        let title = material.options.title();
        let notes = match unwritten_items(&unwritten) {
            items if items.is_empty() => items,
            items => {
                format!("<aside class=\"notes\" aria-label=\"What is missing\"><ul>{items}</ul></aside>\n")
            }
        };
        for (name, title, main) in [
            ("index.html", title, format!("{}{notes}", index_main(title, &written.pages))),
            ("labs.html", "Labs", labs_main(&written.pages)),
        ] {
            let page = Page {
                name,
                title,
                main,
                course: material.options.title(),
                lang: &material.options.lang,
                ..Page::default()
            };
            snapshot.files.insert(name.into(), SiteFile::Text(Page { head: head.clone(), ..page }.write()));
        }
        snapshot.files.insert("search.json".into(), SiteFile::Text(search_index(&written.pages)));
        let copies: Vec<(String, PathBuf)> =
            written.places.copied.into_iter().chain(written.shelf.copied).collect();
        snapshot.watched = copies.iter().map(|(_, path)| path.clone()).collect();
        let of_pages = material.page_files.needed(true, true).map(|(name, path)| (name, path.clone()));
        snapshot
            .files
            .extend(copies.into_iter().chain(of_pages).map(|(name, path)| (name, SiteFile::Copy(path))));
        snapshot
    }

    /// The pages of a version that could not be written: each says why, until a change of the course.
    pub(super) fn failed(
        material: &SnapshotMaterial<'_>,
        served: &Snapshot,
        version: u64,
        why: &str,
    ) -> Snapshot {
        let main = format!(
            "<h1>{}</h1>\n<p class=\"status status-false\" role=\"status\">labspec failed while writing the pages: {}</p>\n",
            escape(material.options.title()),
            escape(why)
        );
        let page = |name: &str| {
            let page = Page {
                name,
                title: material.options.title(),
                main: main.clone(),
                course: material.options.title(),
                lang: &material.options.lang,
                head: head(material.token, version),
                ..Page::default()
            };
            SiteFile::Text(page.write())
        };
        let file = |(name, file): (&String, &SiteFile)| match name.ends_with(".html") {
            true => (name.clone(), page(name)),
            false => (name.clone(), file.clone()),
        };
        Snapshot {
            version,
            files: served.files.iter().map(file).collect(),
            course: served.course.clone(),
            watched: served.watched.clone(),
            ..Snapshot::default()
        }
    }

    fn add_lessons(
        &mut self,
        material: &SnapshotMaterial<'_>,
        written: &CoursePages,
        is_checked: bool,
        (problem, unwritten): (Option<&str>, &[String]),
    ) {
        let course = self.course.clone();
        for (position, (page, index)) in written.pages.iter().zip(&written.lessons).enumerate() {
            let Some(checked) = course.lessons.get(*index) else { continue };
            let Some((path, _)) = &checked.lesson.place else { continue };
            let of_lesson = |f: &&Finding| f.path == *checked.lesson.file.path();
            let findings: Vec<Finding> = course.findings.iter().filter(of_lesson).cloned().collect();
            let view = AuthorView {
                checked,
                page,
                course: &course,
                findings: &findings,
                is_checked,
                problem,
                unwritten,
            };
            let html = Page {
                name: &page.name,
                title: &page.title,
                course: material.options.title(),
                lang: &material.options.lang,
                has_math: page.has_math,
                attributes: view.attributes(),
                main: view.main(),
                neighbours: neighbours(&written.pages, position),
                head: head(material.token, self.version),
                ..Page::default()
            };
            self.files.insert(page.name.clone(), SiteFile::Text(html.write()));
            let served = ServedLesson {
                path: path.clone(),
                index: *index,
                hash: text_hash(checked.lesson.file.text()),
                blocks: page.blocks.iter().map(|block| block.span.clone()).collect(),
                findings,
                proposals: OnceLock::new(),
            };
            self.lessons.insert(page.name.clone(), served);
        }
    }
}

/// What the preview adds to the head of a page.
fn head(token: &str, version: u64) -> String {
    format!(
        "<meta name=\"labspec-token\" content=\"{}\">\n<meta name=\"labspec-version\" content=\"{version}\">\n\
         <link rel=\"stylesheet\" href=\"/page/preview.css\">\n<script type=\"module\" src=\"/page/preview.js\"></script>\n",
        escape(token)
    )
}
