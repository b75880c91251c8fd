//! A course as one page of HTML: every claim with what it rests on, to be read without a server, a network or a script.
//!
//! The page is HTML that is also XML, so that a test can hold its nesting. Text from lessons enters it through `text` and `formula` alone, and
//! pictures are drawn by `labspec_plot`, which escapes what it is given. The policy in its head forbids everything but its style.
//!
//! | piece | module |
//! |---|---|
//! | what it all comes to, and how much is claimed | `overview`, `coverage` |
//! | a lesson with its findings and labs | `lesson` |
//! | a question with its options | `question` |
//! | runs, measures, quoted numbers, closed forms | `evidence` |
//! | how a run is made, and with which settings | `settings` |
//! | pictures of the runs | `plots` |
//! | texts of lessons, and formulas in them | `text`, `formula` |

mod coverage;
mod evidence;
mod formula;
mod lesson;
mod overview;
mod plots;
mod question;
mod settings;
mod text;
mod verdict;

use crate::check::{Allowed, Basis, Checked, Drawn};
use crate::finding::Finding;
use crate::ledger::Ledger;
use crate::printable::counted;
use crate::source::SourceFile;
use lesson::LessonPage;
use text::{Names, text};

/// What a page is made of.
#[derive(Clone, Copy, Debug)]
pub struct Material<'a> {
    /// The lessons, in order.
    pub lessons: &'a [Checked],
    /// What the labs of each of them show in the runs of its claims.
    pub curves: &'a [Vec<Drawn>],
    /// What the check of each of them rests on.
    pub bases: &'a [Basis],
    /// Everything that is told, of lessons and of models.
    pub findings: &'a [Finding],
    /// What the lessons allow.
    pub allowed: &'a [Allowed],
    /// The claims of the course.
    pub ledger: &'a Ledger,
    /// The files that findings lie in.
    pub sources: &'a [&'a SourceFile],
    /// What it all comes to, in one line.
    pub summary: &'a str,
}

const STYLE: &str = include_str!("style.css");

/// Nothing may be loaded, and nothing may run.
const POLICY: &str = "default-src 'none'; style-src 'unsafe-inline'";

/// The page. The same material gives the same bytes.
pub fn page(material: &Material<'_>) -> String {
    let names = Names::of(material.lessons.iter().map(|c| &**c.lesson.file.path()));
    let parts: Vec<LessonPage<'_>> = material
        .lessons
        .iter()
        .enumerate()
        .map(|(i, c)| LessonPage::new(i + 1, c, material, &names))
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

/// What was found in other files: models, and files that could not be read.
fn others(material: &Material<'_>, names: &Names) -> String {
    let own = |f: &&Finding| !material.lessons.iter().any(|c| *c.lesson.file.path() == f.path);
    let mut by_path: std::collections::BTreeMap<&str, Vec<&Finding>> = std::collections::BTreeMap::new();
    for f in material.findings.iter().filter(own) {
        by_path.entry(&f.path).or_default().push(f);
    }
    let one = |(path, all): (&&str, &Vec<&Finding>)| {
        let found = lesson::found(all, material.sources, names);
        format!("<section class=\"lesson\">\n<h2>{}</h2>\n{found}</section>\n", text(names.short(path)))
    };
    by_path.iter().map(one).collect()
}
