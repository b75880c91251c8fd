//! The index of the course, and that of its labs.

use crate::lesson::{LessonPage, PageElement};
use crate::names::address_from;
use crate::text::{address, escape};
use labspec::report::counted;
use std::fmt::Write;

/// The title of the list of the lessons, where it is not the first page.
pub(crate) const LIST_TITLE: &str = "All pages";

/// The list of the lessons, each with its first lines, its labs and its quizzes.
pub(crate) fn index_main(title: &str, pages: &[LessonPage]) -> String {
    let mut out = format!("<h1>{}</h1>\n<ol class=\"lessons\">\n", escape(title));
    for page in pages {
        let _ = writeln!(
            out,
            "<li><h2><a href=\"{}\">{}</a></h2>",
            address_from("index.html", &page.name),
            escape(&page.title)
        );
        if !page.lead.is_empty() {
            let _ = writeln!(out, "<p>{}</p>", escape(&page.lead));
        }
        out.push_str(&element_list(page, "index.html"));
        out.push_str("</li>\n");
    }
    out.push_str("</ol>\n");
    out
}

/// The labs and quizzes of a page as links.
fn element_list(page: &LessonPage, from: &str) -> String {
    if page.elements.is_empty() {
        return String::new();
    }
    let mut out = String::from("<ul class=\"elements\">");
    for element in &page.elements {
        let kind = if element.is_lab { "Lab".to_string() } else { counted(element.questions, "question") };
        let _ = write!(
            out,
            "<li><a href=\"{}\">{}</a> <small>{kind}</small></li>",
            element_address(page, element, from),
            escape(&element.title)
        );
    }
    out.push_str("</ul>\n");
    out
}

fn element_address(page: &LessonPage, element: &PageElement, from: &str) -> String {
    format!("{}#{}", address_from(from, &page.name), address(&element.id))
}

/// The index of all labs.
pub(crate) fn labs_main(pages: &[LessonPage]) -> String {
    let mut out = String::from("<h1>Labs</h1>\n");
    let mut rows = String::new();
    for page in pages {
        for lab in page.elements.iter().filter(|element| element.is_lab) {
            let _ = writeln!(
                rows,
                "<tr><td><a href=\"{}\">{}</a></td><td>{}</td></tr>",
                element_address(page, lab, "labs.html"),
                escape(&lab.title),
                escape(&page.title)
            );
        }
    }
    if rows.is_empty() {
        out.push_str("<p>This course has no labs.</p>\n");
    } else {
        let _ = write!(
            out,
            "<div class=\"scroll\" role=\"region\" aria-label=\"Labs\" tabindex=\"0\"><table><thead><tr><th scope=\"col\">Lab</th>\
             <th scope=\"col\">Lesson</th></tr></thead><tbody>\n{rows}</tbody></table></div>\n"
        );
    }
    out
}

/// Links to the lessons before and after.
pub(crate) fn neighbours(pages: &[LessonPage], index: usize) -> String {
    let Some(page) = pages.get(index) else { return String::new() };
    let link = |other: &LessonPage, rel: &str, word: &str| {
        let href = address_from(&page.name, &other.name);
        format!("<a rel=\"{rel}\" href=\"{href}\"><small>{word}</small> {}</a>", escape(&other.title))
    };
    let before = index.checked_sub(1).and_then(|i| pages.get(i)).map(|other| link(other, "prev", "Previous"));
    let after = pages.get(index + 1).map(|other| link(other, "next", "Next"));
    before.into_iter().chain(after).collect()
}
