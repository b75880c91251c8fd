//! The index of the search: the sections of all lessons with their words.

use crate::lesson::LessonPage;
use crate::text::address;
use serde::Serialize;

/// The maximum number of characters of a section that are searched.
const MAX_SECTION: usize = 20_000;

#[derive(Serialize)]
struct IndexEntry<'e> {
    /// The address from the root of the site.
    url: String,
    title: &'e str,
    heading: &'e str,
    text: String,
}

/// The index as JSON. It is a separate file, which a page fetches at the first search.
pub(crate) fn search_index(pages: &[LessonPage]) -> String {
    let entries: Vec<IndexEntry<'_>> = pages
        .iter()
        .flat_map(|page| {
            page.sections.iter().map(|section| {
                let anchor =
                    if section.id.is_empty() { String::new() } else { format!("#{}", address(&section.id)) };
                IndexEntry {
                    url: format!("{}{anchor}", address(&page.name)),
                    title: &page.title,
                    heading: &section.heading,
                    text: section.text.chars().take(MAX_SECTION).collect(),
                }
            })
        })
        .collect();
    serde_json::to_string(&entries).unwrap_or_else(|_| "[]".into())
}
