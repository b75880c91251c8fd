//! A course as the files of a site. The same course gives the same files.

use crate::assets::PageFiles;
use crate::lesson::{LessonPage, LessonSource, Outline, write_lesson};
use crate::lesson_main::{lesson_attributes, lesson_main};
use crate::links::Places;
use crate::models::ModelShelf;
use crate::names::{PageNames, parts_inside};
use crate::offline::{service_worker, sitemap};
use crate::options::{SiteFile, SiteOptions};
use crate::overview::{LIST_TITLE, index_main, labs_main, neighbours};
use crate::page::Page;
use crate::scorm::write_packages;
use crate::search::search_index;
use crate::text::json_in_script;
use crate::verified::hex_of;
use labspec::check::Checked;
use labspec::ledger::Ledger;
use labspec::lint::{ModelFolder, root_of};
use labspec::report::printable_path;
use labspec::spec::{FileKind, Lesson, kind_of};
use labspec::threads;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

/// The file that lists the others. A folder with it may be written again.
pub const MANIFEST: &str = "labspec-site.json";
/// The first page.
const INDEX: &str = "index.html";
/// The list of the lessons, where one of them is the first page.
const LESSONS: &str = "lessons.html";

/// A checked course.
#[derive(Clone, Copy)]
pub struct Course<'a> {
    /// The folder of the course: the names of its pages are the paths of the lessons in it.
    pub folder: &'a Path,
    /// The lesson that is the first page. Without it, the first page is the list of the lessons.
    pub index: Option<&'a Path>,
    /// The address on the web of the root of the course, ending in `/`. Links to files that the site does not have lead there.
    pub sources: Option<&'a str>,
    /// The lessons, in order. JSON files among them have no page.
    pub lessons: &'a [Checked],
    /// The claims of this check.
    pub ledger: &'a Ledger,
    /// The folder of models of a lesson, by its path.
    pub models: &'a dyn Fn(&Path) -> ModelFolder,
}

/// The files of a site by their names, which are relative paths with `/`.
#[derive(Clone, Debug, Default)]
pub struct Site {
    /// The files.
    pub files: BTreeMap<String, SiteFile>,
    /// What the site cannot deliver, as sentences for the author.
    pub problems: Vec<String>,
    /// The number of pages that are lessons.
    pub lessons: usize,
    /// The number of content packages.
    pub packages: usize,
    /// The number of labs and questions with the mark "verified".
    pub verified: usize,
}

/// The pages of a course before they are put into a frame.
#[derive(Debug, Default)]
pub(crate) struct CoursePages {
    pub(crate) pages: Vec<LessonPage>,
    /// For each page, the index of its lesson.
    pub(crate) lessons: Vec<usize>,
    pub(crate) shelf: ModelShelf,
    pub(crate) places: Places,
}

/// A lesson that has a page.
struct Listed<'l> {
    index: usize,
    lesson: &'l Lesson,
    name: String,
    path: PathBuf,
    folder: PathBuf,
}

/// Writes the pages of a course.
pub(crate) fn write_pages(course: &Course<'_>, for_author: bool) -> CoursePages {
    let folder = course.folder.canonicalize().unwrap_or_else(|_| course.folder.to_path_buf());
    let root = root_of(&folder, std::slice::from_ref(&folder));
    let sources = course.sources.map(String::from);
    let mut out = CoursePages {
        places: Places { folder, root, sources, ..Places::default() },
        ..CoursePages::default()
    };
    let listed = list_lessons(course, &mut out.places);
    let outlines: Vec<Outline> = listed
        .iter()
        .map(|one| {
            let file = one.path.file_stem().and_then(|stem| stem.to_str()).unwrap_or("lesson");
            Outline::new(one.lesson, &one.name, file, &mut out.places)
        })
        .collect();
    for (one, outline) in listed.iter().zip(&outlines) {
        let models = out.shelf.number((course.models)(&one.path));
        let source = LessonSource {
            lesson: one.lesson,
            ledger: course.ledger,
            outline,
            page: &one.name,
            folder: &one.folder,
            models,
            for_author,
        };
        // A lesson that cannot be written does not end the others.
        match threads::catch_panic(|| write_lesson(&source, &mut out.places, &mut out.shelf)) {
            Ok(page) => {
                out.pages.push(page);
                out.lessons.push(one.index);
            }
            Err(why) => out.shelf.problems.push(format!("labspec failed while writing {}: {why}", one.name)),
        }
    }
    out
}

/// The lessons that have pages, each with its name in the site.
fn list_lessons<'l>(course: &Course<'l>, places: &mut Places) -> Vec<Listed<'l>> {
    let mut names = PageNames::default();
    let first = course.index.and_then(|path| path.canonicalize().ok());
    if first.is_some() {
        names.reserve(INDEX);
        names.reserve(LESSONS);
    }
    let mut all = Vec::new();
    for (index, checked) in course.lessons.iter().enumerate() {
        let lesson = &checked.lesson;
        let Some((path, _)) = &lesson.place else { continue };
        if kind_of(path) != FileKind::Lesson {
            continue;
        }
        let real = path.canonicalize().unwrap_or_else(|_| path.clone());
        let file =
            || real.file_name().map(|name| vec![name.to_string_lossy().into_owned()]).unwrap_or_default();
        let name = match first.as_ref() == Some(&real) {
            true => INDEX.to_string(),
            false => names.name(&parts_inside(&places.folder, &real).unwrap_or_else(file)),
        };
        let folder = real.parent().unwrap_or(Path::new("")).to_path_buf();
        places.pages.insert(real, name.clone());
        all.push(Listed { index, lesson, name, path: path.clone(), folder });
    }
    all
}

/// Writes a site.
///
/// # Errors
/// A file of the page cannot be read, or the first page is not among the lessons.
pub fn build_site(
    course: &Course<'_>,
    options: &SiteOptions,
    page_files: &PageFiles,
) -> Result<Site, String> {
    let CoursePages { pages, shelf, places, .. } = write_pages(course, false);
    let mut site = Site { lessons: pages.len(), ..Site::default() };
    let base = options.base.as_deref();
    let has_own_index = pages.iter().any(|page| page.name == INDEX);
    if let Some(index) = course.index.filter(|_| !has_own_index) {
        return Err(format!(
            "{} is not among the lessons, so it cannot be the first page",
            printable_path(index)
        ));
    }
    let list = has_own_index.then_some(LESSONS);
    let mut add = |name: &str, page: Page<'_>| {
        let canonical = base.map(|base| format!("{base}{}", crate::text::address(name)));
        let page = Page {
            name,
            course: options.title(),
            lang: &options.lang,
            canonical,
            list,
            is_offline: true,
            ..page
        };
        site.files.insert(name.to_string(), SiteFile::Text(page.write()));
    };
    for (position, page) in pages.iter().enumerate() {
        add(&page.name, lesson_frame(&pages, position, page));
    }
    let title = if has_own_index { LIST_TITLE } else { options.title() };
    add(list.unwrap_or(INDEX), Page { title, main: index_main(title, &pages), ..Page::default() });
    add("labs.html", Page { title: "Labs", main: labs_main(&pages), ..Page::default() });
    site.verified = pages.iter().flat_map(|page| &page.blocks).map(|block| verified_in(&block.after)).sum();
    site.files.insert("search.json".into(), SiteFile::Text(search_index(&pages)));
    let copies = places.copied.into_iter().chain(shelf.copied);
    site.files.extend(copies.map(|(name, path)| (name, SiteFile::Copy(path))));
    site.files.extend(shelf.pictures.into_iter().map(|(name, bytes)| (name, SiteFile::Bytes(bytes))));
    let has_math = pages.iter().any(|page| page.has_math);
    site.files
        .extend(page_files.needed(has_math, false).map(|(name, path)| (name, SiteFile::Copy(path.clone()))));
    if let Some(base) = base {
        let names: Vec<String> = site.files.keys().filter(|name| name.ends_with(".html")).cloned().collect();
        site.files.insert("sitemap.xml".into(), SiteFile::Text(sitemap(base, &names)));
    }
    let packages = match options.scorm {
        Some(scorm) => write_packages(&pages, options, scorm, &site.files, page_files)?,
        None => BTreeMap::new(),
    };
    site.packages = packages.len();
    add_offline(&mut site, packages, page_files)?;
    site.problems = shelf.problems.into_iter().collect::<BTreeSet<_>>().into_iter().collect();
    Ok(site)
}

/// The page of a lesson, as far as it differs from those of others.
fn lesson_frame<'p>(pages: &[LessonPage], index: usize, page: &'p LessonPage) -> Page<'p> {
    Page {
        title: &page.title,
        description: &page.lead,
        has_math: page.has_math,
        attributes: lesson_attributes(page),
        main: lesson_main(page),
        neighbours: neighbours(pages, index),
        ..Page::default()
    }
}

/// The number of marks of a block: one for a lab, one for each question.
fn verified_in(after: &str) -> usize {
    after.split("<p class=\"verified\">").skip(1).map(|mark| mark.matches("question ").count().max(1)).sum()
}

/// Adds the service worker, the packages, which no reader needs offline, and the list of all files.
fn add_offline(
    site: &mut Site,
    packages: BTreeMap<String, Vec<u8>>,
    page_files: &PageFiles,
) -> Result<(), String> {
    let mut hashes = Vec::new();
    for (name, file) in &site.files {
        let hash = match file {
            SiteFile::Text(text) => hex_of(&[text.as_bytes()]),
            SiteFile::Bytes(bytes) => hex_of(&[bytes]),
            SiteFile::Copy(path) => {
                hex_of(&[&std::fs::read(path).map_err(|e| format!("cannot read {}: {e}", path.display()))?])
            }
        };
        hashes.push((name.clone(), hash));
    }
    let program = page_files.path("sw.js").ok_or("the scripts of the page have no sw.js")?;
    let program =
        std::fs::read_to_string(program).map_err(|e| format!("cannot read {}: {e}", program.display()))?;
    site.files.insert("sw.js".into(), SiteFile::Text(service_worker(&hashes, &program)));
    site.files.extend(packages.into_iter().map(|(name, bytes)| (name, SiteFile::Bytes(bytes))));
    let mut names: Vec<&str> = site.files.keys().map(String::as_str).collect();
    names.push(MANIFEST);
    let list = serde_json::to_string_pretty(&names).unwrap_or_else(|_| "[]".into());
    let version = env!("CARGO_PKG_VERSION");
    let manifest = format!(
        "{{\"site\": \"labspec\", \"version\": \"{version}\", \"files\": {}}}\n",
        json_in_script(&list)
    );
    site.files.insert(MANIFEST.into(), SiteFile::Text(manifest));
    Ok(())
}
