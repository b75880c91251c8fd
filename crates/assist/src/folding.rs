//! The parts of a lesson that an editor can fold: fences, the objects and lists in them, sections, comments, and `<details>`.

use super::item::{Fold, FoldKind};
use super::outline::sections;
use labspec::json::{Json, Node, parse};
use labspec::source::SourceMap;
use labspec::spec::{FileKind, Lesson, kind_of};
use std::ops::Range;
use std::path::Path;

const OPENS_DETAILS: &str = "<details";
const CLOSES_DETAILS: &str = "</details>";
const OPENS_COMMENT: &str = "<!--";

/// The folds of a lesson, in the order of their starts. Each begins and ends in the line of a byte of its span.
pub fn folds(lesson: &Lesson) -> Vec<Fold> {
    let file = &lesson.file;
    let mut all = Vec::new();
    for (_, _, section) in sections(lesson) {
        let text = file.slice(section.clone()).trim_end();
        all.push(Fold { span: section.start..section.start + text.len(), kind: FoldKind::Section });
    }
    for block in &lesson.scan.blocks {
        let text = file.slice(block.span.clone()).trim_end();
        all.push(Fold { span: block.span.start..block.span.start + text.len(), kind: FoldKind::Block });
        if block.body.value.trim_start().starts_with(['{', '[']) {
            let whole = parse(&block.body.value, &block.body.map);
            whole.node.iter().for_each(|node| add_brackets(node, &mut all));
        }
    }
    if kind_of(Path::new(&**file.path())) == FileKind::Json {
        let whole = parse(file.text(), &SourceMap::verbatim(0..file.text().len()));
        whole.node.iter().for_each(|node| add_brackets(node, &mut all));
    }
    add_html(lesson, &mut all);
    all.sort_by_key(|fold| (fold.span.start, std::cmp::Reverse(fold.span.end)));
    all
}

/// Adds the objects and lists of a value. The depth of JSON is limited by its parser.
fn add_brackets(node: &Node, all: &mut Vec<Fold>) {
    let parts: Vec<&Node> = match &node.json {
        Json::Array(items) => items.iter().collect(),
        Json::Object(members) => members.iter().map(|member| &member.value).collect(),
        _ => return,
    };
    all.push(Fold { span: node.span.clone(), kind: FoldKind::Brackets });
    parts.into_iter().for_each(|part| add_brackets(part, all));
}

/// Adds the comments, and the elements `<details>` from their start tags to their end tags.
fn add_html(lesson: &Lesson, all: &mut Vec<Fold>) {
    let mut open: Vec<usize> = Vec::new();
    for html in &lesson.scan.html {
        let text = lesson.file.slice(html.clone());
        if text.trim_start().starts_with(OPENS_COMMENT) {
            let end = html.start + text.trim_end().len();
            all.push(Fold { span: html.start..end, kind: FoldKind::Comment });
            continue;
        }
        for (offset, closes) in details_tags(text) {
            if !closes {
                open.push(html.start + offset);
            } else if let Some(start) = open.pop() {
                let end = html.start + offset + CLOSES_DETAILS.len();
                all.push(Fold { span: start..end, kind: FoldKind::Block });
            }
        }
    }
}

/// The offsets of the tags of `<details>` in HTML, and whether each is an end tag.
fn details_tags(html: &str) -> Vec<(usize, bool)> {
    let lower = html.to_ascii_lowercase();
    let opens = lower.match_indices(OPENS_DETAILS).map(|(offset, _)| (offset, false));
    let closes = lower.match_indices(CLOSES_DETAILS).map(|(offset, _)| (offset, true));
    let mut all: Vec<(usize, bool)> = opens.chain(closes).collect();
    all.sort_unstable();
    all
}

/// The lines of a fold, from 0: the first one stays visible. `None` if nothing would be hidden.
pub fn folded_lines(lines: Range<usize>, kind: FoldKind) -> Option<Range<usize>> {
    // The line of a closing bracket stays visible too.
    let end = if kind == FoldKind::Brackets { lines.end.saturating_sub(1) } else { lines.end };
    (lines.start < end).then_some(lines.start..end)
}

#[cfg(test)]
mod tests {
    use super::*;
    use labspec::lint::{ModelFolder, load_lesson};
    use labspec::source::SourceFile;

    /// The folds as pairs of lines, from 1.
    fn lines(name: &str, text: &str) -> Vec<(usize, usize, FoldKind)> {
        let lesson = load_lesson(SourceFile::new(name, text), &ModelFolder::unknown());
        let line = |byte: usize| lesson.file.position(byte).line;
        let folded = |fold: &Fold| {
            let lines = line(fold.span.start)..line(fold.span.end);
            folded_lines(lines, fold.kind).map(|lines| (lines.start, lines.end, fold.kind))
        };
        folds(&lesson).iter().filter_map(folded).collect()
    }

    #[test]
    fn sections_fences_objects_and_details_fold() {
        let text = "# A\n\n<details>\n<summary>𝄞</summary>\n\n> ```lab\n> {\"model\": \"a\",\n>  \"controls\": [\n>   1\n>  ]\n> }\n> ```\n\n</details>\n\n## B\n\nx\n\n<!-- a\n comment -->\n\n# C\n";
        use FoldKind::{Block, Brackets, Comment, Section};
        assert_eq!(
            lines("a.md", text),
            [
                (1, 21, Section),
                (3, 14, Block),
                (6, 12, Block),
                (7, 10, Brackets),
                (8, 9, Brackets),
                (16, 21, Section),
                (20, 21, Comment)
            ]
        );
        assert_eq!(lines("a.json", "{\"model\":\n[1,\n2\n]\n}"), [(1, 4, Brackets), (2, 3, Brackets)]);
        assert_eq!(lines("a.md", "# A\n</details>\n<details>"), [(1, 3, Section)]);
    }
}
