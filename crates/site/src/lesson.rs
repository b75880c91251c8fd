//! A lesson as a page: blocks of HTML in the order of its text, its headings, its labs and quizzes, and its words for the search.

use crate::fence::{FenceIds, FencePart, FenceWriter};
use crate::html::Addresses;
use crate::links::{PageLinks, Places};
use crate::marks::{TextMark, text_marks};
use crate::masked::Masked;
use crate::models::ModelShelf;
use crate::prose::{self, Group, RenderContext};
use crate::text::{escape, shortened};
use crate::verified::{short_hash, verified_owners};
use labspec::ledger::Ledger;
use labspec::spec::Lesson;
use std::collections::BTreeMap;
use std::ops::Range;
use std::path::Path;

/// What is known of a lesson before any page is written, so that pages can link to each other.
#[derive(Debug)]
pub(crate) struct Outline {
    pub(crate) masked: Masked,
    pub(crate) title: String,
    pub(crate) has_heading: bool,
    /// The ids of the headings, in order, with their texts and where they begin in the masked text.
    pub(crate) headings: Vec<(String, String, usize)>,
    pub(crate) fences: FenceIds,
}

impl Outline {
    /// Reads the headings of a lesson, and gives them and its fences ids.
    pub(crate) fn new(lesson: &Lesson, page: &str, file: &str, places: &mut Places) -> Outline {
        let masked = Masked::new(lesson.file.text(), &lesson.scan);
        let (headings, title) = prose::outline(&masked);
        let anchors = places.anchors.entry(page.to_string()).or_default();
        let fences = FenceIds::new(lesson, anchors);
        let first = headings.iter().find(|h| h.level == 1);
        let has_heading = first.is_some();
        let title = first.map(|h| h.text.clone()).or(title).or(headings.first().map(|h| h.text.clone()));
        let title = title.filter(|title| !title.trim().is_empty()).unwrap_or_else(|| file.to_string());
        let with_id =
            headings.into_iter().map(|h| (anchors.add(&prose::requested_id(&h), &h.text), h.text, h.offset));
        Outline { title, has_heading, headings: with_id.collect(), fences, masked }
    }
}

/// A part of a lesson that is replaced as a whole when it changes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct PageBlock {
    /// `text`, or the kind of its fence.
    pub(crate) kind: &'static str,
    /// Bytes of the file.
    pub(crate) span: Range<usize>,
    /// What stays on the page as long as it is the same.
    pub(crate) content: String,
    /// What is written again at every change.
    pub(crate) after: String,
}

/// A lab or a quiz in the indexes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct PageElement {
    pub(crate) id: String,
    pub(crate) title: String,
    pub(crate) is_lab: bool,
    /// The number of questions of a quiz.
    pub(crate) questions: usize,
}

/// A section for the search: the id of its heading, the heading, its words.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Section {
    pub(crate) id: String,
    pub(crate) heading: String,
    pub(crate) text: String,
}

/// A lesson as a page.
#[derive(Debug)]
pub(crate) struct LessonPage {
    pub(crate) name: String,
    pub(crate) title: String,
    /// The first sentences.
    pub(crate) lead: String,
    pub(crate) has_heading: bool,
    pub(crate) blocks: Vec<PageBlock>,
    pub(crate) elements: Vec<PageElement>,
    pub(crate) sections: Vec<Section>,
    /// Models that the page contains, by name.
    pub(crate) embedded: BTreeMap<String, String>,
    /// The folder of the site from which elements fetch models.
    pub(crate) model_folder: Option<String>,
    pub(crate) has_math: bool,
}

/// The sources of a page.
pub(crate) struct LessonSource<'s> {
    pub(crate) lesson: &'s Lesson,
    pub(crate) ledger: &'s Ledger,
    pub(crate) outline: &'s Outline,
    pub(crate) page: &'s str,
    pub(crate) folder: &'s Path,
    /// The number of its folder of models.
    pub(crate) models: usize,
    /// Whether the page is for the author, who sees every claim in the text.
    pub(crate) for_author: bool,
}

/// Writes a lesson.
pub(crate) fn write_lesson(
    source: &LessonSource<'_>,
    places: &mut Places,
    shelf: &mut ModelShelf,
) -> LessonPage {
    let LessonSource { lesson, ledger, outline, page, .. } = source;
    // A question may name a lab whose fence was read only in part.
    let verified = match lesson.broken.is_empty() {
        true => verified_owners(ledger, lesson.file.path()),
        false => Default::default(),
    };
    let marks = if source.for_author { text_marks(lesson, ledger) } else { Vec::new() };
    let mut links = PageLinks { places, page, folder: source.folder };
    let mut writer = FenceWriter {
        lesson,
        page,
        ids: &outline.fences,
        verified: &verified,
        shelf,
        folder: source.models,
        embedded: BTreeMap::new(),
        needs_files: false,
        has_twins: !source.for_author,
    };
    let groups = render_groups(source, &marks, &mut links, &mut writer);
    let mut blocks = Vec::new();
    for group in groups {
        let fence = group.fence.and_then(|index| lesson.scan.blocks.get(index));
        blocks.push(match fence {
            Some(block) => {
                let FencePart { kind, content, after } = writer.write(block, &mut links);
                PageBlock { kind, span: block.span.clone(), content, after }
            }
            None => {
                let range = outline.masked.origin(group.range.start)..outline.masked.origin(group.range.end);
                PageBlock { kind: "text", span: range, content: group.html, after: String::new() }
            }
        });
    }
    let FenceWriter { embedded, needs_files, .. } = writer;
    let model_folder = needs_files.then(|| ModelShelf::site_folder(source.models));
    let has_math = blocks
        .iter()
        .any(|block| [&block.content, &block.after].iter().any(|html| html.contains("class=\"math")));
    LessonPage {
        name: page.to_string(),
        title: outline.title.clone(),
        lead: lead(lesson),
        has_heading: outline.has_heading,
        elements: elements(lesson, &outline.fences),
        sections: sections(lesson, outline),
        blocks,
        embedded,
        model_folder,
        has_math,
    }
}

fn render_groups(
    source: &LessonSource<'_>,
    marks: &[TextMark],
    links: &mut PageLinks<'_>,
    writer: &mut FenceWriter<'_>,
) -> Vec<Group> {
    let LessonSource { lesson, outline, .. } = source;
    if lesson.scan.blocks.is_empty() && !lesson.scan.problems.is_empty() && lesson.scan.headings.is_empty() {
        // The text was not read, because it has too much markup.
        let html = format!("<pre tabindex=\"0\">{}</pre>", escape(&shortened(lesson.file.text(), 100_000)));
        return vec![Group { range: 0..outline.masked.text.len(), html, fence: None }];
    }
    let ids: Vec<String> = outline.headings.iter().map(|(id, ..)| id.clone()).collect();
    let mut fence = |index: usize, addresses: &mut dyn Addresses| {
        let part =
            lesson.scan.blocks.get(index).map(|block| writer.write(block, addresses)).unwrap_or_default();
        format!("<div class=\"inner {}\">{}{}</div>", part.kind, part.content, part.after)
    };
    prose::render(&mut RenderContext {
        masked: &outline.masked,
        ids: &ids,
        marks,
        addresses: links,
        fence: &mut fence,
    })
}

fn elements(lesson: &Lesson, ids: &FenceIds) -> Vec<PageElement> {
    let mut all = Vec::new();
    for block in &lesson.scan.blocks {
        let Some(id) = ids.find(block.span.start) else { continue };
        if let Some(entry) = lesson.labs.iter().find(|entry| entry.span.start == block.span.start) {
            let title = entry.lab.as_ref().map_or("", |lab| lab.title());
            let title = if title.is_empty() { format!("Lab {}", entry.number) } else { title.to_string() };
            all.push(PageElement { id: id.to_string(), title, is_lab: true, questions: 0 });
        } else if let Some(quiz) =
            lesson.quizzes.iter().find(|quiz| crate::fence::contains(&block.span, &quiz.span))
        {
            let (title, questions) = (quiz.title().to_string(), quiz.questions.len());
            all.push(PageElement { id: id.to_string(), title, is_lab: false, questions });
        }
    }
    all
}

/// The first paragraph as text.
fn lead(lesson: &Lesson) -> String {
    let paragraphs = lesson.scan.paragraphs.iter().filter_map(|range| lesson.file.text().get(range.clone()));
    let first = paragraphs.map(plain).find(|text| !text.trim().is_empty());
    shortened(first.unwrap_or_default().trim(), 240)
}

/// Markdown as text for the indexes: without marks, tags and addresses.
fn plain(markdown: &str) -> String {
    let mut out = String::new();
    let options = pulldown_cmark::Options::ENABLE_MATH | pulldown_cmark::Options::ENABLE_TABLES;
    for event in pulldown_cmark::Parser::new_ext(markdown, options) {
        match event {
            pulldown_cmark::Event::Text(text)
            | pulldown_cmark::Event::Code(text)
            | pulldown_cmark::Event::InlineMath(text)
            | pulldown_cmark::Event::DisplayMath(text) => out.push_str(&text),
            pulldown_cmark::Event::SoftBreak
            | pulldown_cmark::Event::HardBreak
            | pulldown_cmark::Event::End(_) => out.push(' '),
            _ => {}
        }
    }
    out.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// The text of a lesson in sections, each from one heading to the next. Fences are part of it with their titles only.
fn sections(lesson: &Lesson, outline: &Outline) -> Vec<Section> {
    let text = &outline.masked.text;
    let mut starts: Vec<(usize, String, String)> = vec![(0, String::new(), outline.title.clone())];
    starts
        .extend(outline.headings.iter().map(|(id, heading, offset)| (*offset, id.clone(), heading.clone())));
    let mut all = Vec::new();
    for (i, (offset, id, heading)) in starts.iter().enumerate() {
        let end = starts.get(i + 1).map_or(text.len(), |next| next.0);
        let range = *offset..end.max(*offset);
        let mut words = text.get(range.clone()).map(plain).unwrap_or_default();
        for (_, index) in outline.masked.fences(&range) {
            let Some(block) = lesson.scan.blocks.get(index) else { continue };
            let lab = lesson.labs.iter().find(|entry| entry.span.start == block.span.start);
            if let Some(title) = lab.and_then(|entry| entry.lab.as_ref()).map(|lab| lab.title()) {
                words.push(' ');
                words.push_str(title);
            }
        }
        if !words.trim().is_empty() {
            all.push(Section { id: id.clone(), heading: heading.clone(), text: words });
        }
    }
    all
}

impl PageBlock {
    /// What identifies the content: a page keeps the elements of a block whose content is the same.
    pub(crate) fn hash(&self) -> String {
        short_hash(&[self.content.as_bytes()])
    }
}
