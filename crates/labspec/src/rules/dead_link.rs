use crate::json::read::shorten;
use crate::lint::links::{LinkedFile, MOST, decoded, folder_of, linked_files};
use crate::lint::root_of;
use crate::markdown::html::tags;
use crate::markdown::{self, Link, Scan};
use crate::source::{MAX_FILE, PathQuery, SourceFile, Sources};
use crate::spec::Lesson;
use labspec_finding::{Example, Finding, Layer, Rule, Severity};
use std::collections::BTreeSet;
use std::path::Path;

/// A link or an image leads to a file or a heading that does not exist.
pub const DEAD_LINK: &Rule = &Rule {
    code: "dead-link",
    severity: Severity::Warning,
    exceptions: &[],
    layer: Layer::Structure,
    summary: "a link or an image leads to a file or a heading that does not exist",
    why: "a student lands on a missing page, or sees a broken image",
    bad: Example::Lesson("# Falling\n\nSee ⟦[below](#bouncing)⟧.\n"),
    good: Example::Lesson("# Falling\n\nSee [below](#bouncing).\n\n# Bouncing\n\nIt bounces.\n"),
};

/// The letters and digits of a heading or an anchor. Site generators differ in how they write other characters.
fn anchor_letters(text: &str) -> String {
    text.chars().filter(|c| c.is_alphanumeric()).flat_map(char::to_lowercase).collect()
}

/// Whether a text has this anchor: as a heading, or as the id of an element.
fn has_anchor(text: &str, scan: &Scan, ids: &BTreeSet<String>, anchor: &str) -> bool {
    let meant = anchor_letters(anchor);
    // `fall-1` is the second heading "Fall".
    let plain = meant.trim_end_matches(|c: char| c.is_ascii_digit());
    let heading = scan.headings.iter().filter_map(|h| text.get(h.clone())).any(|heading| {
        let heading_letters = anchor_letters(heading);
        heading_letters == meant
            || heading_letters == plain
            || heading_letters.trim_start_matches(|c: char| c.is_ascii_digit()) == meant
            || heading.contains(&format!("{{#{anchor}}}"))
    });
    heading || ids.contains(anchor)
}

/// The ids of elements in the HTML of a text.
fn ids(text: &str, scan: &Scan) -> BTreeSet<String> {
    let tags = scan.html.iter().filter_map(|html| text.get(html.clone())).flat_map(tags);
    let attributes = tags.flat_map(|tag| tag.attributes);
    attributes.filter(|(name, _)| name == "id" || name == "name").map(|(_, value)| value).collect()
}

/// Whether a site generator creates this anchor: a number, or a name derived from an id.
fn is_generated_anchor(lesson: &Lesson, anchor: &str) -> bool {
    let meant = anchor_letters(anchor);
    let numbered = ["lab", "quiz", "fig", "figure", "eq", "equation", "tab", "table", "top", "ref", "fn"];
    let stem = meant.trim_end_matches(|c: char| c.is_ascii_digit());
    let ids = lesson.quizzes.iter().filter_map(|q| q.id.as_ref()).map(|id| anchor_letters(id.as_str()));
    numbered.contains(&stem) || ids.into_iter().any(|id| !id.is_empty() && meant.contains(&id))
}

/// Checks links to anchors of the lesson itself.
pub(crate) fn check_anchors(lesson: &Lesson, findings: &mut Vec<Finding>) {
    let text = lesson.file.text();
    let mut ids_here = None;
    for link in lesson.scan.links.iter().take(MOST) {
        let Some(anchor) = link.target.strip_prefix('#').filter(|a| !a.is_empty()) else { continue };
        if anchor.starts_with('/') {
            findings.push(unknown_route(link));
            continue;
        }
        let ids = ids_here.get_or_insert_with(|| ids(text, &lesson.scan));
        if !has_anchor(text, &lesson.scan, ids, &decoded(anchor)) && !is_generated_anchor(lesson, anchor) {
            findings.push(finding(link, "this lesson has no such heading"));
        }
    }
}

/// Checks the files that links of a lesson name, and the headings of linked lessons. Files outside the root are never opened.
pub(crate) fn check_files(lesson: &Lesson, path: &Path, sources: &Sources, findings: &mut Vec<Finding>) {
    let folder = folder_of(path, sources);
    let mut root = None;
    for LinkedFile { link, path, extension, anchor } in linked_files(lesson, &folder) {
        let root = root.get_or_insert_with(|| {
            let found = sources.place(PathQuery::Root, &folder, || Some(root_of(&folder, &[])));
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
                    && !is_generated_anchor(lesson, &anchor)
                {
                    findings.push(finding(link, "that lesson has no such heading"));
                }
            }
            _ => {}
        }
    }
}

/// A link to a page of a single-page site, such as `#/lesson/0.1`. The settings of the course state which files these pages are.
fn unknown_route(link: &Link) -> Finding {
    let mut finding = Finding::new(
        DEAD_LINK,
        link.span.clone(),
        format!("`{}` is a page of the site, but `routes` does not state its file", shorten(&link.target)),
    )
    .why("without `routes`, a link to a missing page is not reported")
    .help("write its form in labspec.toml, for example routes = { \"#/lesson/{}\" = \"lessons/{}.md\" }");
    finding.link = Some(link.target.as_str().into());
    finding
}

fn finding(link: &Link, message: &str) -> Finding {
    let short_target = shorten(&link.target);
    Finding::new(DEAD_LINK, link.span.clone(), format!("`{short_target}`: {message}"))
        .help("correct the link, or add its target")
}
