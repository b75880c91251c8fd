//! The page: its head, the overview, the lessons, and the findings in other files.

use super::lesson::{self, LessonReport};
use super::material::Material;
use super::overview;
use super::text::{Names, text};
use crate::finding::Finding;
use crate::printable::counted;

const STYLE: &str = include_str!("style.css");

/// Nothing may be loaded, and no script may run.
const POLICY: &str = "default-src 'none'; style-src 'unsafe-inline'";

/// The page. The same material gives the same bytes.
pub fn page(material: &Material<'_>) -> String {
    let names = Names::shorten_paths(material.lessons.iter().map(|c| &**c.lesson.file.path()));
    let parts: Vec<LessonReport<'_>> = material
        .lessons
        .iter()
        .enumerate()
        .map(|(i, c)| LessonReport::new(i + 1, c, material, &names))
        .collect();
    let mut out = format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\"/>\n\
         <meta http-equiv=\"Content-Security-Policy\" content=\"{POLICY}\"/>\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>\n\
         <meta name=\"color-scheme\" content=\"light dark\"/>\n\
         <title>{}, checked</title>\n<style>\n{STYLE}</style>\n</head>\n<body>\n<main>\n",
        counted(parts.len(), "lesson")
    );
    out.push_str(&overview::write(&parts, &names.shorten(material.summary)));
    parts.iter().for_each(|part| out.push_str(&lesson::write(part)));
    out.push_str(&others(material, &names));
    out.push_str("</main>\n<footer><p>");
    out.push_str(&text(&format!("labspec {}", env!("CARGO_PKG_VERSION"))));
    out.push_str("</p></footer>\n</body>\n</html>\n");
    out
}

/// Writes the findings in other files: models, and files that could not be read.
fn others(material: &Material<'_>, names: &Names) -> String {
    let is_other = |f: &&Finding| !material.lessons.iter().any(|c| *c.lesson.file.path() == f.path);
    let mut by_path: std::collections::BTreeMap<&str, Vec<&Finding>> = std::collections::BTreeMap::new();
    for f in material.findings.iter().filter(is_other) {
        by_path.entry(&f.path).or_default().push(f);
    }
    let one = |(path, all): (&&str, &Vec<&Finding>)| {
        let found = lesson::found(all, material.sources, names);
        format!("<section class=\"lesson\">\n<h2>{}</h2>\n{found}</section>\n", text(names.short(path)))
    };
    by_path.iter().map(one).collect()
}
