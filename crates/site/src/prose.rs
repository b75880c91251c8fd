//! The prose of a lesson as HTML: Markdown without its fences, in self-contained groups.

use crate::html::{Addresses, AuthorElements};
use crate::marks::TextMark;
use crate::masked::{Masked, PLACEHOLDER};
use crate::text::{escape, slug};
use pulldown_cmark::{CowStr, Event, LinkType, Options, Parser, Tag, TagEnd, html};
use std::collections::BTreeSet;
use std::ops::Range;

/// What a course may write besides CommonMark.
const OPTIONS: Options = Options::ENABLE_TABLES
    .union(Options::ENABLE_FOOTNOTES)
    .union(Options::ENABLE_STRIKETHROUGH)
    .union(Options::ENABLE_HEADING_ATTRIBUTES)
    .union(Options::ENABLE_MATH)
    .union(Options::ENABLE_YAML_STYLE_METADATA_BLOCKS);

/// Separates groups in the output of the renderer. The text contains no such character.
const SEPARATOR: &str = "\0";

/// A heading.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Heading {
    pub(crate) level: u8,
    /// The id that its author gave it.
    pub(crate) id: Option<String>,
    pub(crate) text: String,
    /// Where it begins in the masked text.
    pub(crate) offset: usize,
}

/// The headings of a text, and the title in the metadata before it.
pub(crate) fn outline(masked: &Masked) -> (Vec<Heading>, Option<String>) {
    let (mut all, mut open, mut title, mut in_metadata) = (Vec::new(), None, None, false);
    for (event, range) in Parser::new_ext(&masked.text, OPTIONS).into_offset_iter() {
        match event {
            Event::Start(Tag::Heading { level, id, .. }) => {
                let id = id.map(|id| id.to_string());
                open = Some(Heading { level: level as u8, id, text: String::new(), offset: range.start });
            }
            Event::End(TagEnd::Heading(_)) => all.extend(open.take()),
            Event::Start(Tag::MetadataBlock(_)) => in_metadata = true,
            Event::End(TagEnd::MetadataBlock(_)) => in_metadata = false,
            Event::Text(text) if in_metadata => title = title.or_else(|| title_in(&text)),
            Event::Text(text) | Event::Code(text) | Event::InlineMath(text) => {
                open.iter_mut().for_each(|heading| heading.text.push_str(&text));
            }
            _ => {}
        }
    }
    (all, title)
}

fn title_in(metadata: &str) -> Option<String> {
    let line = metadata.lines().find_map(|line| line.strip_prefix("title:"))?;
    let title = line.trim().trim_matches(['"', '\'']).trim();
    (!title.is_empty()).then(|| title.to_string())
}

/// The id that a heading asks for.
pub(crate) fn requested_id(heading: &Heading) -> String {
    heading.id.clone().filter(|id| !id.is_empty()).unwrap_or_else(|| slug(&heading.text))
}

/// A self-contained part of a lesson: no element of its HTML extends beyond it.
#[derive(Debug, Default)]
pub(crate) struct Group {
    /// Its range in the masked text.
    pub(crate) range: Range<usize>,
    /// Its HTML; empty where it is a fence alone.
    pub(crate) html: String,
    /// The fence, where it is one alone.
    pub(crate) fence: Option<usize>,
}

/// What the renderer needs besides the text.
pub(crate) struct RenderContext<'s> {
    pub(crate) masked: &'s Masked,
    /// The ids of the headings, in order.
    pub(crate) ids: &'s [String],
    pub(crate) marks: &'s [TextMark],
    pub(crate) addresses: &'s mut dyn Addresses,
    /// The HTML of a fence.
    pub(crate) fence: &'s mut dyn FnMut(usize, &mut dyn Addresses) -> String,
}

/// Renders a lesson.
pub(crate) fn render(context: &mut RenderContext<'_>) -> Vec<Group> {
    let masked = context.masked;
    let mut renderer = Renderer {
        around: context,
        events: Vec::new(),
        groups: Vec::new(),
        open: AuthorElements::default(),
        bases: Vec::new(),
        ends: Vec::new(),
        heading: 0,
        depth: 0,
        start: None,
        html: None,
        is_metadata: false,
        is_image: false,
        written: BTreeSet::new(),
    };
    let mut end = 0;
    for (event, range) in Parser::new_ext(&masked.text, OPTIONS).into_offset_iter() {
        end = range.end.max(end);
        renderer.start.get_or_insert(range.start);
        renderer.add(event, range);
        if renderer.depth == 0 && renderer.open.depth() == 0 {
            renderer.finish_group(end);
        }
    }
    let rest = renderer.open.close_to(0);
    renderer.markup(rest);
    renderer.finish_group(end);
    let Renderer { events, mut groups, .. } = renderer;
    let mut written = String::new();
    html::push_html(&mut written, events.into_iter());
    // The renderer aligns cells by styles, which the policy of the pages forbids. No other element has one.
    for (style, class) in
        [("text-align: left", "start"), ("text-align: center", "center"), ("text-align: right", "end")]
    {
        for cell in ["th", "td"] {
            written = written
                .replace(&format!("<{cell} style=\"{style}\">"), &format!("<{cell} class=\"{class}\">"));
        }
    }
    for (group, html) in groups.iter_mut().zip(written.split(SEPARATOR)) {
        group.html = html.trim().to_string();
    }
    groups.retain(|group| group.fence.is_some() || !group.html.is_empty());
    groups
}

struct Renderer<'r, 's> {
    around: &'r mut RenderContext<'s>,
    events: Vec<Event<'r>>,
    groups: Vec<Group>,
    open: AuthorElements,
    /// For each open block of Markdown, the author's elements that were open before it.
    bases: Vec<usize>,
    /// For each open link or image, the end tag that replaces its own.
    ends: Vec<Option<&'static str>>,
    heading: usize,
    depth: usize,
    start: Option<usize>,
    /// The HTML block that is being read, up to the last fence in it.
    html: Option<String>,
    is_metadata: bool,
    is_image: bool,
    written: BTreeSet<usize>,
}

impl<'r> Renderer<'r, '_> {
    fn markup(&mut self, html: String) {
        if !html.is_empty() {
            self.events.push(Event::InlineHtml(CowStr::from(html)));
        }
    }

    fn base(&self) -> usize {
        self.bases.last().copied().unwrap_or(0)
    }

    fn add(&mut self, event: Event<'r>, range: Range<usize>) {
        match event {
            Event::Start(Tag::HtmlBlock) => {
                self.depth += 1;
                self.html = Some(String::new());
            }
            Event::End(TagEnd::HtmlBlock) => {
                self.depth = self.depth.saturating_sub(1);
                self.flush_html();
                self.html = None;
            }
            Event::Html(_) => self.add_html(range),
            Event::InlineHtml(html) => {
                let (base, html) = (self.base(), html.to_string());
                let written = self.open.filter(&html, base, self.around.addresses);
                if !self.is_image {
                    self.markup(written);
                }
            }
            Event::Start(tag) => self.start_tag(tag),
            Event::End(tag) => self.end_tag(tag),
            Event::InlineMath(tex) => self.add_math("math", &tex, &range),
            Event::DisplayMath(tex) => self.add_math("math display", &tex, &range),
            Event::Text(text) => self.add_text(text, &range),
            other => self.events.push(other),
        }
    }

    /// Adds a line of an HTML block, which may contain fences.
    fn add_html(&mut self, range: Range<usize>) {
        let masked = self.around.masked;
        let fences: Vec<(usize, usize)> = masked.fences(&range).collect();
        let mut offset = range.start;
        for (start, index) in fences {
            self.push_html(offset..start);
            self.flush_html();
            self.add_fence(index);
            offset = start + PLACEHOLDER.len();
        }
        self.push_html(offset..range.end);
    }

    fn push_html(&mut self, range: Range<usize>) {
        let text = self.around.masked.text.get(range).unwrap_or("");
        self.html.get_or_insert_default().push_str(text);
    }

    fn flush_html(&mut self) {
        let html = self.html.as_mut().map(std::mem::take).unwrap_or_default();
        let base = self.base();
        let written = self.open.filter(&html, base, self.around.addresses);
        if !written.trim().is_empty() {
            self.events.push(Event::Html(CowStr::from(written)));
        }
    }

    fn add_fence(&mut self, index: usize) {
        self.written.insert(index);
        let is_alone = self.depth == 1 && self.open.depth() == 0 && self.is_empty_group();
        if is_alone {
            self.groups.push(Group { range: 0..0, html: String::new(), fence: Some(index) });
            self.events.push(Event::Html(CowStr::from(SEPARATOR)));
            return;
        }
        let html = (self.around.fence)(index, self.around.addresses);
        self.events.push(Event::Html(CowStr::from(html)));
    }

    /// Whether nothing was written since the last separator.
    fn is_empty_group(&self) -> bool {
        self.events.last().is_none_or(|event| matches!(event, Event::Html(html) if **html == *SEPARATOR))
    }

    /// Ends a group, with the fences that the renderer did not reach: those inside code.
    fn finish_group(&mut self, end: usize) {
        let Some(start) = self.start.take() else { return };
        let masked = self.around.masked;
        let unreached: Vec<usize> = masked
            .fences(&(start..end))
            .map(|(_, index)| index)
            .filter(|index| !self.written.contains(index))
            .collect();
        for index in unreached {
            self.written.insert(index);
            let html = (self.around.fence)(index, self.around.addresses);
            self.events.push(Event::Html(CowStr::from(html)));
        }
        if let Some(group) =
            self.groups.last_mut().filter(|group| group.fence.is_some() && group.range.is_empty())
        {
            group.range = start..end;
            if self.is_empty_group() {
                return;
            }
        }
        self.events.push(Event::Html(CowStr::from(SEPARATOR)));
        self.groups.push(Group { range: start..end, html: String::new(), fence: None });
    }

    fn start_tag(&mut self, tag: Tag<'r>) {
        self.depth += 1;
        self.bases.push(self.open.depth());
        match tag {
            Tag::Heading { level, .. } => {
                let id = self.around.ids.get(self.heading).map(|id| CowStr::from(id.clone()));
                self.heading += 1;
                self.events.push(Event::Start(Tag::Heading {
                    level,
                    id,
                    classes: Vec::new(),
                    attrs: Vec::new(),
                }));
            }
            Tag::Link { link_type, dest_url, title, id } => self.start_link(link_type, &dest_url, title, id),
            Tag::Image { link_type, dest_url, title, id } => match self.around.addresses.image(&dest_url) {
                Some(address) => {
                    self.ends.push(None);
                    self.is_image = true;
                    let dest_url = CowStr::from(address);
                    self.events.push(Event::Start(Tag::Image { link_type, dest_url, title, id }));
                }
                None => self.start_missing_image(&dest_url),
            },
            Tag::Table(alignments) => {
                let open = "<div class=\"scroll\" role=\"region\" aria-label=\"Table\" tabindex=\"0\">";
                self.events.push(Event::Html(CowStr::from(open)));
                self.events.push(Event::Start(Tag::Table(alignments)));
            }
            Tag::MetadataBlock(kind) => {
                self.is_metadata = true;
                self.events.push(Event::Start(Tag::MetadataBlock(kind)));
            }
            tag => self.events.push(Event::Start(tag)),
        }
    }

    fn start_link(&mut self, link_type: LinkType, target: &str, title: CowStr<'r>, id: CowStr<'r>) {
        let address = if link_type == LinkType::Email {
            Some(target.to_string())
        } else {
            self.around.addresses.link(target)
        };
        match address {
            Some(address) => {
                self.ends.push(None);
                let dest_url = CowStr::from(address);
                self.events.push(Event::Start(Tag::Link { link_type, dest_url, title, id }));
            }
            None => {
                self.ends.push(Some("</span>"));
                self.markup("<span class=\"dead-link\">".into());
            }
        }
    }

    /// An image that the page does not show: its text, as a link where the image is on the web.
    fn start_missing_image(&mut self, target: &str) {
        match self.around.addresses.link(target).filter(|address| address.starts_with("http")) {
            Some(address) => {
                self.ends.push(Some("</a>"));
                self.markup(format!("<a class=\"image-elsewhere\" href=\"{}\">Image: ", escape(&address)));
            }
            None => {
                self.ends.push(Some("</span>"));
                self.markup("<span class=\"image-missing\">Image: ".into());
            }
        }
    }

    fn end_tag(&mut self, tag: TagEnd) {
        self.depth = self.depth.saturating_sub(1);
        let base = self.bases.pop().unwrap_or(0);
        let rest = self.open.close_to(base);
        if !self.is_image {
            self.markup(rest);
        }
        match tag {
            TagEnd::Link | TagEnd::Image => match self.ends.pop().flatten() {
                Some(end) => self.markup(end.into()),
                None => {
                    self.is_image = self.is_image && tag != TagEnd::Image;
                    self.events.push(Event::End(tag));
                }
            },
            TagEnd::Table => {
                self.events.push(Event::End(tag));
                self.events.push(Event::Html(CowStr::from("</div>\n")));
            }
            TagEnd::MetadataBlock(_) => {
                self.is_metadata = false;
                self.events.push(Event::End(tag));
            }
            tag => self.events.push(Event::End(tag)),
        }
    }

    fn add_math(&mut self, class: &str, tex: &str, range: &Range<usize>) {
        if self.is_image {
            return self.events.push(Event::Text(CowStr::from(tex.to_string())));
        }
        let formula = format!("<span class=\"{class}\">{}</span>", escape(tex));
        let marks = self.marks_in(range);
        let marked = match marks.first() {
            Some((_, mark)) => format!("{}{formula}{}", mark_start(mark), mark_end(mark)),
            None => formula,
        };
        self.markup(marked);
    }

    /// The marks in a range of the text, with their ranges in it.
    fn marks_in(&self, range: &Range<usize>) -> Vec<(Range<usize>, TextMark)> {
        let Some(origin) = self.around.masked.origin_of(range) else { return Vec::new() };
        let marks = self.around.marks;
        let first = marks.partition_point(|mark| mark.span.end <= origin.start);
        let inside = marks.iter().skip(first).take_while(|mark| mark.span.start < origin.end);
        inside
            .map(|mark| {
                let start = mark.span.start.max(origin.start) - origin.start;
                let end = mark.span.end.min(origin.end) - origin.start;
                (start..end, mark.clone())
            })
            .collect()
    }

    fn add_text(&mut self, text: CowStr<'r>, range: &Range<usize>) {
        let masked = self.around.masked;
        if masked.fences(range).next().is_some() {
            let text = text.replace(PLACEHOLDER, "");
            return self.events.push(Event::Text(CowStr::from(text)));
        }
        let is_verbatim = masked.text.get(range.clone()) == Some(&*text);
        let marks = if is_verbatim && !self.is_image && !self.is_metadata {
            self.marks_in(range)
        } else {
            Vec::new()
        };
        if marks.is_empty() {
            return self.events.push(Event::Text(text));
        }
        let mut offset = 0;
        for (part, mark) in marks {
            let (Some(before), Some(inside)) = (text.get(offset..part.start), text.get(part.clone())) else {
                continue;
            };
            self.events.push(Event::Text(CowStr::from(before.to_string())));
            self.markup(mark_start(&mark));
            self.events.push(Event::Text(CowStr::from(inside.to_string())));
            self.markup(mark_end(&mark));
            offset = part.end;
        }
        let rest = text.get(offset..).unwrap_or("").to_string();
        self.events.push(Event::Text(CowStr::from(rest)));
    }
}

fn mark_start(mark: &TextMark) -> String {
    format!("<mark class=\"{}\" title=\"{}\">", mark.class, escape(&mark.label))
}

fn mark_end(mark: &TextMark) -> String {
    format!("<span class=\"hidden\"> ({})</span></mark>", escape(&mark.label))
}
