//! Content packages of SCORM 2004 4th edition (Content Aggregation Model, section 3): one archive for each lesson, with its page, the
//! scripts, the models and other files that the page needs, and the manifest. A lesson with questions is a sharable content object,
//! which reports grades; one without is an asset.
//!
//! The page has no navigation: it is one activity of a course that the learning system shows. Its links to other lessons lead to the
//! site where there is an address of it, and nowhere otherwise.

use crate::archive::{Deflated, deflate, write_archive};
use crate::assets::PageFiles;
use crate::html::{Attributes, edit_start_tags};
use crate::lesson::LessonPage;
use crate::lesson_main::{lesson_attributes, lesson_main};
use crate::names::address_from;
use crate::options::{ScormOptions, SiteFile, SiteOptions};
use crate::page::Page;
use crate::text::{address, escape};
use crate::verified::short_hash;
use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::Path;

/// The name of the manifest, which the standard gives.
const MANIFEST: &str = "imsmanifest.xml";
/// The folder of a site with the packages.
const FOLDER: &str = "scorm";

/// Writes a package for each lesson of a site. Their names in the site are those of the pages with the ending `.zip`.
///
/// # Errors
/// A file cannot be read.
pub(crate) fn write_packages(
    pages: &[LessonPage],
    options: &SiteOptions,
    scorm: ScormOptions,
    copied: &BTreeMap<String, SiteFile>,
    page_files: &PageFiles,
) -> Result<BTreeMap<String, Vec<u8>>, String> {
    // The scripts are the same in all packages.
    let mut deflated: BTreeMap<Source<'_>, Deflated> = BTreeMap::new();
    let mut packages = BTreeMap::new();
    for page in pages {
        let html = package_page(page, pages, options, scorm);
        let scripts = page_files.needed(page.has_math, false).map(|(name, path)| (name, Source::File(path)));
        let files: BTreeMap<String, Source<'_>> = scripts.chain(needed_copies(page, &html, copied)).collect();
        for source in files.values() {
            if !deflated.contains_key(source) {
                deflated.insert(*source, source.deflated()?);
            }
        }
        let manifest = deflate(manifest(page, files.keys(), options, scorm).as_bytes());
        let html = deflate(html.as_bytes());
        let first = [(MANIFEST, &manifest), (page.name.as_str(), &html)];
        let others = files.iter().filter_map(|(name, source)| Some((name.as_str(), deflated.get(source)?)));
        let archive = write_archive(first.into_iter().chain(others))
            .map_err(|e| format!("cannot write a package for {}: {e}", page.name))?;
        packages.insert(package_name(&page.name), archive);
    }
    Ok(packages)
}

/// Where the bytes of a file of a package come from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Source<'f> {
    File(&'f Path),
    Bytes(&'f [u8]),
}

impl Source<'_> {
    fn deflated(&self) -> Result<Deflated, String> {
        match self {
            Source::Bytes(bytes) => Ok(deflate(bytes)),
            Source::File(path) => {
                let bytes =
                    std::fs::read(path).map_err(|e| format!("cannot read {}: {e}", path.display()))?;
                Ok(deflate(&bytes))
            }
        }
    }
}

/// The name of the package of a page.
fn package_name(page: &str) -> String {
    format!("{FOLDER}/{}.zip", page.strip_suffix(".html").unwrap_or(page))
}

/// The files of the course that a page needs: those to which it links, its pictures, and its folder of models.
fn needed_copies<'f>(
    page: &LessonPage,
    html: &str,
    copied: &'f BTreeMap<String, SiteFile>,
) -> Vec<(String, Source<'f>)> {
    let is_needed = |name: &str| {
        let is_model =
            page.model_folder.as_ref().is_some_and(|folder| name.starts_with(&format!("{folder}/")));
        is_model || html.contains(&format!("\"{}\"", escape(&address_from(&page.name, name))))
    };
    copied
        .iter()
        .filter_map(|(name, file)| match file {
            SiteFile::Copy(path) if is_needed(name) => Some((name.clone(), Source::File(path))),
            SiteFile::Bytes(bytes) if is_needed(name) => Some((name.clone(), Source::Bytes(bytes))),
            _ => None,
        })
        .collect()
}

/// The page of a lesson as a learning system shows it.
fn package_page(
    page: &LessonPage,
    pages: &[LessonPage],
    options: &SiteOptions,
    scorm: ScormOptions,
) -> String {
    Page {
        name: &page.name,
        title: &page.title,
        course: options.title(),
        lang: &options.lang,
        description: &page.lead,
        has_math: page.has_math,
        attributes: lesson_attributes(page),
        main: edit_start_tags(&lesson_main(page), |name, attributes| match name {
            "lesson-quiz" => report_grades(attributes, scorm),
            "a" => lead_out(attributes, page, pages, options.base.as_deref()),
            _ => false,
        }),
        is_alone: true,
        ..Page::default()
    }
    .write()
}

/// A quiz reports its grade to the learning system.
fn report_grades(attributes: &mut Attributes, scorm: ScormOptions) -> bool {
    attributes.insert("grades".into(), "scorm".into());
    if let Some(share) = scorm.passing {
        attributes.insert("passing".into(), share.to_string());
    }
    true
}

/// A link to another lesson leads to its page on the site, or nowhere. A page of the web opens in a window of its own, because it
/// would take the place of the lesson in its frame.
fn lead_out(
    attributes: &mut Attributes,
    page: &LessonPage,
    pages: &[LessonPage],
    base: Option<&str>,
) -> bool {
    let Some(target) = attributes.get("href").cloned() else { return false };
    let (path, fragment) = target.find('#').map_or((target.as_str(), ""), |i| target.split_at(i));
    let others = pages.iter().filter(|other| other.name != page.name);
    let lesson = others.into_iter().find(|other| address_from(&page.name, &other.name) == path);
    match (lesson, base) {
        (None, _) if !target.starts_with("http") => return false,
        (None, _) => {}
        (Some(other), Some(base)) => {
            attributes.insert("href".into(), format!("{base}{}{fragment}", address(&other.name)));
        }
        (Some(_), None) => {
            attributes.remove("href");
            attributes.insert("class".into(), "dead-link".into());
            attributes.insert("data-lesson".into(), fragment.into());
            return true;
        }
    }
    attributes.insert("target".into(), "_blank".into());
    attributes.insert("rel".into(), "noopener".into());
    true
}

/// The manifest of a package.
fn manifest<'n>(
    page: &LessonPage,
    files: impl Iterator<Item = &'n String>,
    options: &SiteOptions,
    scorm: ScormOptions,
) -> String {
    let is_graded = page.elements.iter().any(|element| !element.is_lab);
    let id = short_hash(&[options.title().as_bytes(), b"\n", page.name.as_bytes()]);
    let title = escape(&page.title);
    let mut out = format!(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n\
         <manifest identifier=\"labspec-{id}\" version=\"1\" xmlns=\"http://www.imsglobal.org/xsd/imscp_v1p1\" \
         xmlns:adlcp=\"http://www.adlnet.org/xsd/adlcp_v1p3\" xmlns:adlseq=\"http://www.adlnet.org/xsd/adlseq_v1p3\" \
         xmlns:imsss=\"http://www.imsglobal.org/xsd/imsss\">\n\
         <metadata><schema>ADL SCORM</schema><schemaversion>2004 4th Edition</schemaversion></metadata>\n\
         <organizations default=\"lesson\">\n\
         <organization identifier=\"lesson\" adlseq:objectivesGlobalToSystem=\"false\">\n<title>{title}</title>\n\
         <item identifier=\"item\" identifierref=\"page\">\n<title>{title}</title>\n{}</item>\n</organization>\n</organizations>\n",
        if is_graded { sequencing(scorm.passing) } else { String::new() }
    );
    let kind = if is_graded { "sco" } else { "asset" };
    let start = escape(&address(&page.name));
    let _ = writeln!(
        out,
        "<resources>\n<resource identifier=\"page\" type=\"webcontent\" adlcp:scormType=\"{kind}\" href=\"{start}\">\n<file href=\"{start}\"/>"
    );
    for name in files {
        let _ = writeln!(out, "<file href=\"{}\"/>", escape(&address(name)));
    }
    out.push_str("</resource>\n</resources>\n</manifest>\n");
    out
}

/// The page itself reports whether it is completed and passed; a learning system assumes neither.
fn sequencing(passing: Option<f64>) -> String {
    let objective = passing.map_or(String::new(), |share| {
        format!(
            "<imsss:objectives><imsss:primaryObjective objectiveID=\"score\" satisfiedByMeasure=\"true\">\
             <imsss:minNormalizedMeasure>{share}</imsss:minNormalizedMeasure></imsss:primaryObjective></imsss:objectives>"
        )
    });
    format!(
        "<imsss:sequencing>{objective}<imsss:deliveryControls completionSetByContent=\"true\" objectiveSetByContent=\"true\"/></imsss:sequencing>\n"
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lesson::{PageBlock, PageElement};

    fn lesson(name: &str, title: &str, content: &str, has_quiz: bool) -> LessonPage {
        let element = |is_lab| PageElement { id: "x".into(), title: "X".into(), is_lab, questions: 1 };
        let block = PageBlock { kind: "quiz", span: 0..0, content: content.into(), after: String::new() };
        LessonPage {
            name: name.into(),
            title: title.into(),
            lead: String::new(),
            has_heading: true,
            blocks: vec![block],
            elements: vec![element(true), element(!has_quiz)],
            sections: Vec::new(),
            embedded: BTreeMap::new(),
            model_folder: None,
            has_math: false,
        }
    }

    /// A folder with the scripts of pages.
    fn scripts() -> (tempfile::TempDir, PageFiles) {
        let folder = tempfile::tempdir().unwrap();
        let files = PageFiles::of_names(folder.path());
        (folder, files)
    }

    /// The files of a package.
    fn unpack(archive: &[u8]) -> BTreeMap<String, String> {
        let read = rawzip::ZipArchive::from_slice(archive).unwrap();
        let mut entries = read.entries();
        let mut files = BTreeMap::new();
        while let Some(entry) = entries.next_entry().unwrap() {
            let data = read.get_entry(entry.wayfinder()).unwrap();
            let bytes = miniz_oxide::inflate::decompress_to_vec(data.data()).unwrap();
            let name = String::from_utf8(entry.file_path().as_ref().to_vec()).unwrap();
            assert!(
                files.insert(name.clone(), String::from_utf8(bytes).unwrap()).is_none(),
                "{name} is there twice"
            );
        }
        files
    }

    const QUIZ: &str = "<lesson-quiz id=\"q\"></lesson-quiz><a href=\"../b.html#part\">b</a> <a href=\"../files/d%20e.csv\">d</a> \
                        <a href=\"https://x.org/\">x</a><a href=\"#here\">here</a>";

    #[test]
    fn a_package_has_what_its_page_needs_and_lists_it() {
        let (folder, page_files) = scripts();
        let pages = [
            lesson("week 1/a.html", "A & \"B\" <c>", QUIZ, true),
            lesson("b.html", "B", "<p>text</p>", false),
        ];
        let copy = |name: &str| SiteFile::Copy(folder.path().join(name));
        let copied = BTreeMap::from([
            ("files/d e.csv".to_string(), copy("site.js")),
            ("files/other.csv".to_string(), copy("site.js")),
        ]);
        let options = SiteOptions { lang: "en".into(), ..SiteOptions::default() };
        let write = |scorm| write_packages(&pages, &options, scorm, &copied, &page_files).unwrap();
        let packages = write(ScormOptions { passing: Some(0.6) });
        assert_eq!(
            packages,
            write(ScormOptions { passing: Some(0.6) }),
            "the same course gives the same bytes"
        );
        assert_eq!(packages.keys().collect::<Vec<_>>(), ["scorm/b.zip", "scorm/week 1/a.zip"]);
        let a = unpack(&packages["scorm/week 1/a.zip"]);
        let manifest = roxmltree::Document::parse(&a["imsmanifest.xml"]).unwrap();
        let all = |tag: &str| {
            manifest.descendants().filter(|node| node.tag_name().name() == tag).collect::<Vec<_>>()
        };
        let listed: Vec<_> = all("file").iter().filter_map(|file| file.attribute("href")).collect();
        let mut expected: Vec<_> =
            a.keys().filter(|name| *name != MANIFEST).map(|name| address(name)).collect();
        expected.sort_by_key(|name| name != "week%201/a.html");
        assert_eq!(listed, expected);
        assert!(listed.contains(&"files/d%20e.csv") && listed.contains(&"page/labspec.wasm"), "{listed:?}");
        assert!(
            !a.contains_key("files/other.csv")
                && !a.contains_key("page/preview.js")
                && !a.contains_key("page/katex.js")
        );
        assert_eq!(all("title")[1].text(), Some("A & \"B\" <c>"));
        assert_eq!(all("minNormalizedMeasure")[0].text(), Some("0.6"));
        assert_eq!(all("schemaversion")[0].text(), Some("2004 4th Edition"));
        let resource = all("resource")[0];
        assert_eq!(resource.attribute("href"), Some("week%201/a.html"));
        assert_eq!(resource.attribute(("http://www.adlnet.org/xsd/adlcp_v1p3", "scormType")), Some("sco"));
        let b = unpack(&packages["scorm/b.zip"]);
        assert!(
            b["imsmanifest.xml"].contains("scormType=\"asset\"")
                && !b["imsmanifest.xml"].contains("sequencing")
        );
        let without = unpack(&write(ScormOptions::default())["scorm/week 1/a.zip"]);
        assert!(
            !without["imsmanifest.xml"].contains("minNormalizedMeasure")
                && !without["week 1/a.html"].contains("passing")
        );
    }

    #[test]
    fn a_page_reports_grades_and_leads_nowhere_that_the_package_has_not() {
        let (_folder, page_files) = scripts();
        let pages = [lesson("week 1/a.html", "A", QUIZ, true), lesson("b.html", "B", "", true)];
        let page = |base: Option<&str>| {
            let options =
                SiteOptions { lang: "en".into(), base: base.map(String::from), ..SiteOptions::default() };
            let scorm = ScormOptions { passing: Some(0.6) };
            let packages = write_packages(&pages, &options, scorm, &BTreeMap::new(), &page_files).unwrap();
            unpack(&packages["scorm/week 1/a.zip"]).remove("week 1/a.html").unwrap()
        };
        let html = page(None);
        assert!(html.contains("<lesson-quiz grades=\"scorm\" id=\"q\" passing=\"0.6\">"), "{html}");
        assert!(
            html.contains("<a class=\"dead-link\" data-lesson=\"#part\">b</a>")
                && html.contains("href=\"#here\""),
            "{html}"
        );
        assert!(html.contains("<a href=\"https://x.org/\" rel=\"noopener\" target=\"_blank\">"), "{html}");
        assert!(
            !html.contains("index.html") && !html.contains("labs.html") && !html.contains("data-offline"),
            "{html}"
        );
        let html = page(Some("https://example.org/m/"));
        assert!(
            html.contains(
                "<a href=\"https://example.org/m/b.html#part\" rel=\"noopener\" target=\"_blank\">b</a>"
            ),
            "{html}"
        );
    }
}
