//! The documentation and the example course as one site: every link leads to a page, an element or a file.

#![allow(clippy::unwrap_used)]

use crate::program::run_in;
use crate::site::{all_files, course, page};
use crate::support::workspace;
use std::collections::{BTreeMap, BTreeSet};

/// The values of an attribute in a page.
pub(crate) fn values<'h>(html: &'h str, attribute: &str) -> impl Iterator<Item = &'h str> {
    let start = format!(" {attribute}=\"");
    let parts: Vec<&str> = html.split(start.as_str()).skip(1).collect();
    parts.into_iter().filter_map(|part| part.split('"').next())
}

/// The links of a site that lead to no file of it, or to no element.
fn dead_links(pages: &BTreeMap<String, String>, files: &BTreeSet<String>) -> Vec<String> {
    let mut dead = Vec::new();
    for (name, html) in pages {
        let folder = name.rsplit_once('/').map_or("", |(folder, _)| folder);
        for link in values(html, "href").chain(values(html, "src")).chain(values(html, "data-models")) {
            if link.contains(':') {
                continue;
            }
            let (path, anchor) = link.split_once('#').unwrap_or((link, ""));
            let mut parts: Vec<&str> = folder.split('/').filter(|part| !part.is_empty()).collect();
            for part in path.split('/').filter(|part| !part.is_empty()) {
                if part == ".." {
                    parts.pop();
                } else {
                    parts.push(part);
                }
            }
            let target = if path.is_empty() { name.clone() } else { parts.join("/").replace("%20", " ") };
            let is_folder = files.iter().any(|file| file.starts_with(&format!("{target}/")));
            let has_anchor =
                || pages.get(&target).is_some_and(|html| values(html, "id").any(|id| id == anchor));
            if !(files.contains(&target) || is_folder) || !(anchor.is_empty() || has_anchor()) {
                dead.push(format!("{name}: {link}"));
            }
        }
        for class in ["dead-link", "image-missing", "image-elsewhere"] {
            dead.extend(
                html.split(&format!("class=\"{class}\""))
                    .skip(1)
                    .map(|rest| format!("{name}: {class}{}", &rest[..rest.len().min(80)])),
            );
        }
    }
    dead
}

/// The documentation and the example course, as `xtask site` builds them.
#[test]
fn the_documentation_of_the_repository_is_a_site_without_dead_links() {
    let folder = course(&[]);
    let at = |name: &str| workspace().join(name).display().to_string();
    let paths =
        ["docs", "specs/lessons", "web/labspec/README.md", "web/elements/README.md", "CHANGELOG.md"].map(at);
    let index = at("docs/README.md");
    let mut arguments = vec!["build"];
    arguments.extend(paths.iter().map(String::as_str));
    arguments.extend([
        "--index",
        &index,
        "--sources",
        "https://example.org/tree",
        "--out",
        "site",
        "--page",
        "page",
    ]);
    let done = run_in(folder.path(), &arguments);
    assert_eq!(done.code, 0, "{}{}", done.stdout, done.stderr);
    let written = all_files(folder.path());
    let files = written.keys().cloned().collect();
    let pages: BTreeMap<String, String> = written
        .into_iter()
        .filter(|(name, _)| name.ends_with(".html"))
        .map(|(name, bytes)| (name, String::from_utf8(bytes).unwrap()))
        .collect();
    assert!(pages.len() > 40 && pages.contains_key("docs/measured/web.html"), "{}", pages.len());
    assert_eq!(dead_links(&pages, &files), [""; 0]);
    let labs = pages.values().map(|html| html.matches("<sim-lab").count()).sum::<usize>();
    assert_eq!(labs, 19, "the labs of the course, and none of the documentation");
    let search = page(folder.path(), "search.json");
    for url in
        ["docs/tutorial.html#the-model", "specs/lessons/02-bounce-and-swing.html", "web/elements/README.html"]
    {
        assert!(search.contains(&format!("\"url\":\"{url}")), "{url}");
    }
}
