//! The main part of the page of a lesson.

use crate::lesson::{LessonPage, PageBlock};
use crate::names::root_from;
use crate::text::escape;

/// The main part of the page of a lesson.
pub(crate) fn lesson_main(page: &LessonPage) -> String {
    let blocks: String =
        page.blocks.iter().map(|block| format!("{}\n{}\n", wrapped(block), block.after)).collect();
    format!("{}{blocks}{}", missing_heading(page), embedded_models(page))
}

/// The attributes of the main part of the page of a lesson.
pub(crate) fn lesson_attributes(page: &LessonPage) -> String {
    let root = root_from(&page.name);
    let folder = page.model_folder.as_ref();
    folder.map_or(String::new(), |folder| format!(" data-models=\"{}{}/\"", escape(&root), escape(folder)))
}

/// The models that a page contains.
pub(crate) fn embedded_models(page: &LessonPage) -> String {
    let one = |(name, text): (&String, &String)| {
        format!("<script type=\"model/mjcf\" data-name=\"{}\">{}</script>\n", escape(name), text.trim())
    };
    page.embedded.iter().map(one).collect()
}

/// The title of a page, where its text has none.
pub(crate) fn missing_heading(page: &LessonPage) -> String {
    if page.has_heading { String::new() } else { format!("<h1>{}</h1>\n", escape(&page.title)) }
}

/// The content of a block in an element of its kind.
fn wrapped(block: &PageBlock) -> String {
    match block.kind {
        "text" => block.content.clone(),
        kind => format!("<div class=\"fence {kind}\">{}</div>", block.content),
    }
}
