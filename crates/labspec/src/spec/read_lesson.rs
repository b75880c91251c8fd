//! Reads a [`Lesson`] from its text: every fence and every labspec comment of a Markdown file, or a standalone JSON file.

use super::address::LabAddress;
use super::conventions::Conventions;
use super::kind::{FileKind, Nature, kind_of, nature};
use super::lab::Lab;
use super::lesson::{LabEntry, Lesson, Widget};
use super::problem::{Mistake, Problem};
use super::read_lab::{read_any_lab, read_integrators, read_lab};
use super::sources::read_json;
use super::{quiz, read_comments, shared};
use crate::json::{self, Json, Node};
use crate::markdown::{self, Block, BlockKind, LabKind, Scan};
use crate::source::{MAX_FILE, SourceFile, SourceMap, Sources};
use std::ops::Range;
use std::path::{Path, PathBuf};

/// The maximum number of problems per file: more than anyone reads.
const MAX_PROBLEMS: usize = 10_000;

/// Reads a lesson (Markdown) or, if the path ends in `.json`, a lab, a quiz or a list of them. It never fails: errors are
/// among the problems, and the valid parts are in the lesson.
pub fn read_lesson(file: SourceFile) -> Lesson {
    read_lesson_in(file, None)
}

/// Reads a lesson whose claims may refer to files beside it. `place` is the path of the lesson, with the sources of other files.
pub fn read_lesson_in(file: SourceFile, place: Option<(&Path, &Sources)>) -> Lesson {
    let place = place.map(|(path, sources)| (path.to_path_buf(), sources.clone()));
    let mut lesson = read_at(file, None, place);
    let scan = std::mem::take(&mut lesson.scan);
    lesson.claim_comments = read_comments::read_claim_comments(&scan, &mut lesson);
    lesson.definitions = read_comments::read_definitions(&scan, &mut lesson);
    lesson.scan = scan;
    lesson.wholes = shared::resolve_uses(&lesson);
    lesson
}

/// Reads a lab of another lesson. All ranges in it are `reference`, the range of the reference.
///
/// # Errors
/// The reason that there is no such lab.
pub fn read_other(file: SourceFile, address: &LabAddress, reference: Range<usize>) -> Result<Lab, String> {
    let path = file.path().to_string();
    let lesson = read_at(file, Some(reference), None);
    match lesson.lab(address) {
        Some(_) if lesson.blocks_are_broken() => Err(format!("{path} has JSON that a page cannot read")),
        Some(lab) => Ok(lab.clone()),
        None => {
            let all: Vec<String> = lesson.addressed().iter().take(12).map(|(a, _)| a.to_string()).collect();
            let available = if all.is_empty() { "no labs".to_string() } else { all.join(", ") };
            Err(format!("{path} has no lab {address}: it has {available}"))
        }
    }
}

/// Reads the JSON of a lab, or the first lab of a list, with its problems. Markdown and quizzes are not read.
pub(crate) fn read_lab_json(file: &SourceFile) -> (Option<Lab>, Vec<Problem>) {
    let (text, mut problems) = (file.text(), Vec::new());
    if text.len() as u64 > MAX_FILE {
        return (None, vec![Mistake::TooLarge.at(0..0)]);
    }
    let start = byte_order_mark(text);
    let parsed = json::parse(text.get(start..).unwrap_or(""), &SourceMap::verbatim(start..text.len()));
    problems.extend(parsed.problems.into_iter().map(Problem::Json));
    let mut lab = None;
    if let Some(node) = parsed.node {
        let items = match &node.json {
            Json::Array(items) => items.as_slice(),
            _ => std::slice::from_ref(&node),
        };
        match items.iter().find(|item| nature(item) == Nature::Lab) {
            Some(item) => lab = read_any_lab(item, &mut problems),
            None if node.is_broken() => {}
            None => problems.push(Mistake::UnknownObject.at(node.span.clone())),
        }
    }
    (lab, problems)
}

/// The length of the byte order mark, in bytes. It is not part of the JSON, and editors do not display it.
fn byte_order_mark(text: &str) -> usize {
    if text.starts_with('\u{feff}') { '\u{feff}'.len_utf8() } else { 0 }
}

/// Reads a lesson. If `reference` is given, all ranges in its JSON are `reference`.
fn read_at(file: SourceFile, reference: Option<Range<usize>>, place: Option<(PathBuf, Sources)>) -> Lesson {
    let mut lesson = Lesson {
        conventions: Conventions::default(),
        file,
        labs: Vec::new(),
        quizzes: Vec::new(),
        widgets: Vec::new(),
        broken: Vec::new(),
        claim_comments: Vec::new(),
        definitions: Vec::new(),
        wholes: Vec::new(),
        others: Vec::new(),
        scan: Scan::default(),
        problems: Vec::new(),
        findings: Vec::new(),
        snapshot: None,
        data: Vec::new(),
        place,
    };
    if lesson.file.text().len() as u64 > MAX_FILE {
        lesson.problems.push(Mistake::TooLarge.at(0..0));
    } else if kind_of(Path::new(&**lesson.file.path())) == FileKind::Json {
        json_file(&mut lesson, reference);
    } else {
        markdown_file(&mut lesson, reference);
    }
    lesson
}

fn markdown_file(lesson: &mut Lesson, reference: Option<Range<usize>>) {
    let file = lesson.file.clone();
    let (mut scan, text) = (markdown::scan(&file), file.text());
    lesson.problems.extend(scan.problems.drain(..).map(Problem::Fence));
    for block in &scan.blocks {
        if lesson.problems.len() > MAX_PROBLEMS {
            break;
        }
        match &block.kind {
            BlockKind::Lab(kind) => {
                let node = body(block, &reference, &scan, lesson);
                if let Some(node) = &node
                    && nature(node) == Nature::Quiz
                {
                    let mistake = Mistake::HoldsQuiz(head(text, block, "quiz"));
                    lesson.problems.push(mistake.at(block.info.clone()));
                    lesson.quizzes.extend(quiz::read_quiz(node, &mut lesson.problems));
                    continue;
                }
                let read = match kind {
                    LabKind::Simulation => read_lab,
                    LabKind::Comparison => read_integrators,
                };
                let lab = node.and_then(|node| read(&node, &mut lesson.problems));
                push_lab(lesson, block.span.clone(), lab);
            }
            BlockKind::Widget(widget) => {
                let node = body(block, &reference, &scan, lesson);
                let model = node.as_ref().and_then(|n| match &n.get("model")?.json {
                    Json::Text(text) => Some(text.clone()),
                    _ => None,
                });
                lesson.widgets.push(Widget { name: widget.clone(), span: block.span.clone(), model });
            }
            BlockKind::Quiz => {
                let Some(node) = body(block, &reference, &scan, lesson) else { continue };
                if nature(&node) == Nature::Lab {
                    let mistake = Mistake::HoldsLab(head(text, block, LabKind::Simulation.fence()));
                    lesson.problems.push(mistake.at(block.info.clone()));
                    let lab = read_lab(&node, &mut lesson.problems);
                    push_lab(lesson, block.span.clone(), lab);
                    continue;
                }
                lesson.quizzes.extend(quiz::read_quiz(&node, &mut lesson.problems));
            }
            BlockKind::Code { .. } => {}
        }
    }
    lesson.scan = scan;
}

/// The opening line of a block, changed to another kind.
fn head(text: &str, block: &Block, kind: &str) -> String {
    let old = text.get(block.info.clone()).unwrap_or("");
    let marks: String = old.chars().take_while(|c| matches!(c, '`' | '~')).collect();
    format!("{marks}{kind}")
}

/// The JSON of a block.
fn body(block: &Block, reference: &Option<Range<usize>>, scan: &Scan, lesson: &mut Lesson) -> Option<Node> {
    if block.body.value.trim().is_empty() {
        lesson.broken.push(block.span.clone());
        lesson.problems.push(Mistake::EmptyFence.at(block.info.clone()));
        return None;
    }
    let map = reference.as_ref().map(|reference| SourceMap::whole(block.body.value.len(), reference.clone()));
    let map = map.as_ref().unwrap_or(&block.body.map);
    read_json(&block.body.value, map, block.span.clone(), (scan, false), lesson)
}

fn push_lab(lesson: &mut Lesson, span: Range<usize>, lab: Option<Lab>) {
    let number = lesson.labs.len() + 1;
    let broken = lab.is_none() || lesson.is_broken(&span);
    lesson.labs.push(LabEntry { number, span, broken, lab });
}

/// A lab, a quiz, or a list of them. Labs and quizzes are distinguished by their keys.
fn json_file(lesson: &mut Lesson, reference: Option<Range<usize>>) {
    let text = lesson.file.text();
    let start = byte_order_mark(text);
    let (length, whole) = (text.len() - start, 0..text.len());
    let map = reference
        .map_or(SourceMap::verbatim(start..text.len()), |reference| SourceMap::whole(length, reference));
    let text = text.get(start..).unwrap_or("").to_string();
    let Some(node) = read_json(&text, &map, whole, (&Scan::default(), false), lesson) else { return };
    match &node.json {
        Json::Array(items) => items.iter().for_each(|item| json_item(lesson, item)),
        _ => json_item(lesson, &node),
    }
}

fn json_item(lesson: &mut Lesson, node: &Node) {
    match nature(node) {
        Nature::Quiz => lesson.quizzes.extend(quiz::read_quiz(node, &mut lesson.problems)),
        Nature::Lab => {
            let lab = read_any_lab(node, &mut lesson.problems);
            push_lab(lesson, node.span.clone(), lab);
        }
        Nature::Neither if node.is_broken() => {}
        Nature::Neither => {
            lesson.problems.push(Mistake::UnknownObject.at(node.span.clone()));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lint::{MAX_FINDINGS, ModelFolder, load_lesson};
    use proptest::prelude::*;

    /// Lessons made of fragments that typically cause errors.
    fn hostile() -> impl Strategy<Value = String> {
        let piece = prop::sample::select(vec![
            "```lab simlab\n",
            "```lab simlab ",
            "```quiz\n",
            "```\n",
            "````\n",
            "~~~\n",
            "```python file=a.py ",
            "> ",
            "- ",
            "    ",
            "\n",
            "\n\n",
            "{",
            "}",
            "[",
            "]",
            "\"model\"",
            ": ",
            ", ",
            "\"ball\"",
            "“",
            "”",
            "‘",
            "’",
            "\"questions\": [",
            "\"controls\": [{",
            "\"label\": \"a\"",
            "\"options\": [\"a\", \"b\"]",
            "\"answer\": 7",
            "\"verify\": {\"lab\": \"#1\"}",
            "<option>",
            "<div>\n",
            "`x`",
            "def f(): a = 1 b = 2\n",
            "if name == “main”:\n",
            "\\tau",
            "\u{feff}",
            "\r\n",
            "é😀",
            "\t",
            "-1",
            "0",
            "1e999",
            "true",
            "null",
            "{\"model\": \"ball\", \"readouts\": [{\"label\": \"t\", \"expr\": \"‘\"}]}\n",
            "{\"id\": \"q\", \"questions\": []}\n",
        ]);
        prop::collection::vec(piece, 0..24).prop_map(|pieces| pieces.concat())
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(2000))]
        /// No lesson causes a panic, every range is within the file, and the reports can be rendered.
        #[test]
        fn hostile_lessons_are_survived(text in hostile(), json in any::<bool>()) {
            let name = if json { "h.json" } else { "h.md" };
            let lesson = load_lesson(SourceFile::new(name, text.as_str()), &ModelFolder::with_names(["ball"]));
            for finding in &lesson.findings {
                let places = finding.related.iter().map(|p| &p.span).chain(finding.fix.as_ref().map(|f| &f.span));
                for span in places.chain([&finding.span]) {
                    prop_assert!(text.get(span.clone()).is_some(), "{:?} of {:?}", finding, text);
                }
            }
            crate::report::human(&lesson.findings, &[&lesson.file], false);
            crate::report::json(&lesson.findings, &[&lesson.file]);
        }
    }

    #[test]
    fn a_place_inside_a_character_is_widened() {
        let lesson = load_lesson(SourceFile::new("h.json", "“\"model\""), &ModelFolder::unknown());
        assert!(lesson.findings.iter().all(|f| lesson.file.text().get(f.span.clone()).is_some()));
    }

    /// Inputs on which an inefficient checker is slow.
    #[test]
    fn large_lessons_take_a_moment() {
        let wide = |item: &str, n: usize| item.repeat(n);
        let lab = |inside: String| format!("```lab simlab\n{{\"model\": \"ball\", {inside}}}\n```\n");
        for text in [
            wide("```lab {\n", 20_000),
            wide("{\"questions\" ", 20_000),
            wide("```lab `x` {}\n\n", 20_000),
            wide("“", 300_000),
            wide("<option ", 100_000),
            lab((0..9_000).map(|i| format!("\"stopAtt{i}\": 1")).collect::<Vec<_>>().join(", ")),
            lab(format!("\"note\": \"{}\"", wide("$\\n", 300_000))),
            format!("```python\n{}", wide("‘x’ “y”\n", 50_000)),
        ] {
            let start = std::time::Instant::now();
            let lesson =
                load_lesson(SourceFile::new("large.md", text.as_str()), &ModelFolder::with_names(["ball"]));
            assert!(lesson.findings.len() <= MAX_FINDINGS + 1);
            let head: String = text.chars().take(30).collect();
            println!("{:.3} s, {} findings: {head}", start.elapsed().as_secs_f64(), lesson.findings.len());
            assert!(start.elapsed().as_secs() < 20, "{head}");
        }
    }
}
