//! Everything to which the pages of the repository refer exists: linked pages and headings, and files and folders of the code.

#![allow(clippy::unwrap_used)]

use crate::support::workspace;
use pulldown_cmark::{Event, Options, Parser, Tag, TagEnd};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// All files and folders below a folder, except build outputs and optional folders.
fn walk(folder: &Path, out: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        if matches!(name.as_str(), "target" | ".git" | "tools" | "node_modules") {
            continue;
        }
        if path.is_dir() {
            walk(&path, out);
        }
        out.push(path);
    }
}

/// All files of the repository, and its pages. Lessons that are damaged on purpose are not pages.
fn all() -> (Vec<PathBuf>, Vec<PathBuf>) {
    let mut files = Vec::new();
    walk(&workspace(), &mut files);
    let damaged = workspace().join("tests/lessons");
    let page = |p: &&PathBuf| p.extension().is_some_and(|e| e == "md") && !p.starts_with(&damaged);
    let pages = files.iter().filter(page).cloned().collect();
    (files, pages)
}

/// The parts of a page that are tested: its links, its headings as link targets, and its code words.
#[derive(Default)]
struct Page {
    links: Vec<String>,
    headings: BTreeSet<String>,
    code: Vec<String>,
}

impl Page {
    fn read(path: &Path) -> Page {
        let text = std::fs::read_to_string(path).unwrap();
        let (mut page, mut heading) = (Page::default(), None);
        for event in Parser::new_ext(&text, Options::ENABLE_TABLES) {
            match event {
                Event::Start(Tag::Link { dest_url, .. } | Tag::Image { dest_url, .. }) => {
                    page.links.push(dest_url.to_string());
                }
                Event::Start(Tag::Heading { .. }) => heading = Some(String::new()),
                Event::End(TagEnd::Heading(_)) => page.headings.extend(heading.take().map(|h| anchor(&h))),
                Event::Text(text) => heading.iter_mut().for_each(|h| h.push_str(&text)),
                Event::Code(text) => {
                    heading.iter_mut().for_each(|h| h.push_str(&text));
                    page.code.push(text.to_string());
                }
                _ => {}
            }
        }
        page
    }
}

/// The link target of a heading on web pages: lower case, hyphens for spaces, without other characters.
fn anchor(heading: &str) -> String {
    let letters = heading.chars().filter(|c| c.is_alphanumeric() || matches!(c, ' ' | '-' | '_'));
    letters.map(|c| if c == ' ' { '-' } else { c }).collect::<String>().to_lowercase()
}

#[test]
fn no_link_is_dead() {
    let (mut dead, mut count, mut headings) = (Vec::new(), 0, 0);
    for path in all().1 {
        let page = Page::read(&path);
        for link in page.links.iter().filter(|l| !l.contains("://") && !l.starts_with("mailto:")) {
            let (file, heading) = link.split_once('#').unwrap_or((link, ""));
            let to = if file.is_empty() { path.clone() } else { path.parent().unwrap().join(file) };
            let there = to.exists() && (heading.is_empty() || Page::read(&to).headings.contains(heading));
            if !there {
                dead.push(format!("{}: {link}", path.display()));
            }
            count += 1;
            headings += usize::from(!heading.is_empty());
        }
    }
    assert!(dead.is_empty(), "dead:\n{}", dead.join("\n"));
    assert!(count > 60 && headings > 5, "{count} {headings}");
}

/// Files and folders of the code, named by the end of their paths: `step/pipeline.rs`.
#[test]
fn files_that_pages_name_exist() {
    let (files, pages) = all();
    let files: Vec<String> = files.iter().map(|f| f.to_string_lossy().into_owned()).collect();
    let (mut gone, mut count) = (Vec::new(), 0);
    for path in pages {
        for name in Page::read(&path).code {
            let of_code = name.ends_with(".rs") || name.ends_with(".py") || name.ends_with(".sh");
            let folder = name.ends_with('/') && name.matches('/').count() > 1;
            let plain = name.chars().all(|c| c.is_ascii_alphanumeric() || matches!(c, '/' | '.' | '_' | '-'));
            let is_sign = !name.contains(|c: char| c.is_ascii_alphanumeric());
            if !plain || is_sign || !(of_code || folder) {
                continue;
            }
            let end = format!("/{}", name.trim_end_matches('/'));
            if !files.iter().any(|f| f.ends_with(&end)) {
                gone.push(format!("{}: {name}", path.display()));
            }
            count += 1;
        }
    }
    assert!(gone.is_empty(), "not there:\n{}", gone.join("\n"));
    assert!(count > 60, "{count}");
}

/// The index of the documentation links to every page. The list of codes links to the pages of the rules.
#[test]
fn the_index_leads_to_every_page() {
    let docs = workspace().join("docs");
    let index = Page::read(&docs.join("README.md"));
    let codes = Page::read(&docs.join("reference/codes.md"));
    let rules = codes.links.iter().map(|l| docs.join("reference").join(l));
    let named: BTreeSet<PathBuf> = index.links.iter().map(|l| docs.join(l)).chain(rules).collect();
    let pages = all().1;
    let of_docs: Vec<&PathBuf> =
        pages.iter().filter(|p| p.starts_with(&docs) && !p.ends_with("docs/README.md")).collect();
    assert!(of_docs.len() > 15);
    for page in of_docs {
        assert!(named.contains(page), "{} is not in docs/README.md", page.display());
    }
}
