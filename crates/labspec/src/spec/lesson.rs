//! A lesson: what its fences hold, in order, and how labs are addressed.

use super::comment::{self, Remark};
use super::kind::{FileKind, Nature, kind_of, nature};
use super::problem::{Mistake, Problem};
use super::{Lab, Quiz, Verify, VerifyLab, lab, quiz, shared};
use crate::finding::{Finding, Severity};
use crate::json::{self, Json, Node};
use crate::markdown::{self, Block, BlockKind, Scan};
use crate::source::{MAX_FILE, SourceFile, SourceMap, Sources, Text};
use std::ops::Range;
use std::path::{Path, PathBuf};

/// Most problems that are looked for in a file: more than anybody reads.
const MAX_PROBLEMS: usize = 10_000;

/// A lesson, or a stand-alone JSON file, with everything that was found wrong in its structure.
#[derive(Clone, Debug)]
pub struct Lesson {
    /// The file.
    pub file: SourceFile,
    /// The labs, in order: `#1`, `#2`, …
    pub labs: Vec<LabEntry>,
    /// The quizzes, in order.
    pub quizzes: Vec<Quiz>,
    /// Blocks of widgets that are not ours to run.
    pub widgets: Vec<Widget>,
    /// Bytes of the blocks whose JSON a page cannot read. What they were meant to be is read and checked all the same.
    pub broken: Vec<Range<usize>>,
    /// The fences, the HTML and the listings of its Markdown.
    pub scan: Scan,
    /// Claims about blocks of the text, in comments before them.
    pub remarks: Vec<Remark>,
    /// `verify` objects that use the runs and measures of others, with these.
    pub wholes: Vec<Verify>,
    /// Labs of other lessons that this one names. Whoever has the files reads them.
    pub others: Vec<Other>,
    /// What was wrong where it was read.
    pub problems: Vec<Problem>,
    /// What the rules of structure say of it, in order; nothing until [`lint`](crate::lint) has looked.
    pub findings: Vec<Finding>,
    /// What is stored beside it of what its labs show, or why that cannot be read; `None` where nothing is.
    pub snapshot: Option<Result<SourceFile, String>>,
    /// Where it lies, and where its neighbours were read from; `None` until somebody has looked for them.
    pub place: Option<(PathBuf, Sources)>,
}

/// A lab of a lesson.
#[derive(Clone, Debug, PartialEq)]
pub struct LabEntry {
    /// Its number, from 1. A lab that could not be read keeps its number.
    pub number: usize,
    /// Bytes of the fence, or of the object in a JSON file.
    pub span: Range<usize>,
    /// Its JSON is broken: a page cannot read it. No verdict about it may say that it is clean.
    pub broken: bool,
    /// The lab; `None` when it could not be read, which is reported.
    pub lab: Option<Lab>,
}

/// A lab of another lesson.
#[derive(Clone, Debug, PartialEq)]
pub struct Other {
    /// Bytes of its name in this lesson. All places in the lab are these.
    pub span: Range<usize>,
    /// The file that it stands in.
    pub path: String,
    /// What stands in that file.
    pub text: String,
    /// The lab, or why there is none.
    pub lab: Result<Lab, String>,
}

/// A block of another widget.
#[derive(Clone, Debug, PartialEq)]
pub struct Widget {
    /// The widget's name.
    pub name: String,
    /// Bytes of the fence.
    pub span: Range<usize>,
    /// The model it names.
    pub model: Option<Text>,
}

/// The address of a lab within a lesson, written `#2` or `#quiz-id.1`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum LabAddress {
    /// A lab by its number, from 1.
    Lab(usize),
    /// The `sim` of a question, from 1.
    Sim {
        /// Id of the quiz.
        quiz: String,
        /// Number of the question, from 1.
        question: usize,
    },
}

impl LabAddress {
    /// Reads `#2`, `#quiz-id.1`; ids may hold dots themselves. `None` when it is neither.
    pub fn parse(text: &str) -> Option<LabAddress> {
        let name = text.strip_prefix('#')?;
        let number = |digits: &str| digits.parse::<usize>().ok().filter(|&n| n > 0 && digits.len() < 8);
        if let Some(n) = number(name) {
            return Some(LabAddress::Lab(n));
        }
        let (quiz, question) = name.rsplit_once('.')?;
        Some(LabAddress::Sim { quiz: quiz.to_string(), question: number(question)? })
            .filter(|_| !quiz.is_empty())
    }
}

impl std::fmt::Display for LabAddress {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            LabAddress::Lab(n) => write!(f, "#{n}"),
            LabAddress::Sim { quiz, question } => write!(f, "#{quiz}.{question}"),
        }
    }
}

impl Lesson {
    /// The lab at an address.
    pub fn lab(&self, address: &LabAddress) -> Option<&Lab> {
        match address {
            LabAddress::Lab(n) => self.labs.get(n.checked_sub(1)?)?.lab.as_ref(),
            LabAddress::Sim { quiz, question } => {
                let quiz = self.quizzes.iter().find(|q| q.id.as_ref().is_some_and(|id| id.value == *quiz))?;
                quiz.questions.get(question.checked_sub(1)?)?.as_ref()?.sim()
            }
        }
    }

    /// The lab that a `verify` object or one of its runs names; `None` when there is none, or when it could not be read.
    pub fn named<'a>(&'a self, lab: &'a VerifyLab) -> Option<&'a Lab> {
        match lab {
            VerifyLab::Inline(lab) => Some(lab),
            VerifyLab::Reference(_, address) => self.lab(address),
            VerifyLab::Elsewhere(text, ..) => self.other(&text.span())?.lab.as_ref().ok(),
            VerifyLab::Broken => None,
        }
    }

    /// The lab of another lesson that is named at these bytes, where somebody has looked for it.
    pub fn other(&self, span: &Range<usize>) -> Option<&Other> {
        self.others.iter().find(|other| other.span == *span)
    }

    /// Every `verify` object: those of labs, then those of questions, then those in comments.
    pub fn verifies(&self) -> impl Iterator<Item = &Verify> {
        self.scoped().map(|(verify, _)| verify)
    }

    /// The same, each with the bytes that its quotes are looked for in, where that is not all of the lesson.
    pub fn scoped(&self) -> impl Iterator<Item = (&Verify, Option<&Range<usize>>)> {
        let labs = self.all_labs().into_iter().filter_map(|lab| lab.verify.as_ref());
        let questions = self.quizzes.iter().flat_map(Quiz::numbered).filter_map(|(_, q)| q.verify.as_ref());
        let remarks = self.remarks.iter().map(|remark| (&remark.verify, Some(&remark.over)));
        labs.chain(questions).map(|verify| (verify, None)).chain(remarks)
    }

    /// Every lab that has an address: labs in order, then the sims of the questions.
    pub fn addressed(&self) -> Vec<(LabAddress, &Lab)> {
        let mut all: Vec<_> =
            self.labs.iter().filter_map(|e| Some((LabAddress::Lab(e.number), e.lab.as_ref()?))).collect();
        for quiz in &self.quizzes {
            let id = quiz.id.as_ref().map_or("", Text::as_str);
            for (number, question) in quiz.numbered() {
                if let Some(sim) = question.sim() {
                    all.push((LabAddress::Sim { quiz: id.to_string(), question: number }, sim));
                }
            }
        }
        all
    }

    /// Every lab there is, those written inside `verify` objects included.
    pub fn all_labs(&self) -> Vec<&Lab> {
        let mut open: Vec<&Lab> = self.addressed().into_iter().map(|(_, lab)| lab).collect();
        let questions = self.quizzes.iter().flat_map(|q| q.numbered());
        open.extend(questions.filter_map(|(_, q)| q.verify.as_ref()).flat_map(inline));
        open.extend(self.remarks.iter().flat_map(|remark| inline(&remark.verify)));
        let mut all = Vec::new();
        // An inline lab may carry a verify object with another inline lab; JSON depth bounds the chain.
        while let Some(lab) = open.pop() {
            open.extend(lab.verify.iter().flat_map(inline));
            all.push(lab);
        }
        all
    }

    /// Whether a page cannot read the block that holds these bytes: its JSON is broken.
    pub fn is_broken(&self, span: &Range<usize>) -> bool {
        self.broken.iter().any(|b| b.start <= span.start && span.end <= b.end)
    }

    fn blocks_are_broken(&self) -> bool {
        !self.broken.is_empty()
    }

    /// Whether anything is an error.
    pub fn has_errors(&self) -> bool {
        self.findings.iter().any(|f| f.severity == Severity::Error)
    }
}

/// The labs that are written in a `verify` object.
fn inline(verify: &Verify) -> impl Iterator<Item = &Lab> {
    verify.labs().filter_map(|lab| match lab {
        VerifyLab::Inline(lab) => Some(&**lab),
        _ => None,
    })
}

/// Reads a lesson (Markdown) or, when the path ends in `.json`, a lab, a quiz or a list of them. This never fails: what is wrong
/// is among the problems, and what is right is there.
pub fn read_lesson(file: SourceFile) -> Lesson {
    let mut lesson = read_at(file, None);
    lesson.remarks = comment::read(&mut lesson);
    lesson.wholes = shared::wholes(&lesson);
    lesson
}

/// A lab of another lesson; all places in it are `at`, where it is named.
///
/// # Errors
/// Why there is none.
pub fn read_other(file: SourceFile, address: &LabAddress, at: Range<usize>) -> Result<Lab, String> {
    let path = file.path().to_string();
    let lesson = read_at(file, Some(at));
    match lesson.lab(address) {
        Some(_) if lesson.blocks_are_broken() => Err(format!("{path} has JSON that a page cannot read")),
        Some(lab) => Ok(lab.clone()),
        None => {
            let all: Vec<String> = lesson.addressed().iter().take(12).map(|(a, _)| a.to_string()).collect();
            let known = if all.is_empty() { "no labs".to_string() } else { all.join(", ") };
            Err(format!("{path} has no lab {address}: it has {known}"))
        }
    }
}

/// Reads a lesson; all places in its JSON are `at`, if that is given.
fn read_at(file: SourceFile, at: Option<Range<usize>>) -> Lesson {
    let mut lesson = Lesson {
        file,
        labs: Vec::new(),
        quizzes: Vec::new(),
        widgets: Vec::new(),
        broken: Vec::new(),
        remarks: Vec::new(),
        wholes: Vec::new(),
        others: Vec::new(),
        scan: Scan::default(),
        problems: Vec::new(),
        findings: Vec::new(),
        snapshot: None,
        place: None,
    };
    if lesson.file.text().len() as u64 > MAX_FILE {
        lesson.problems.push(Mistake::TooLarge.at(0..0));
    } else if kind_of(Path::new(&**lesson.file.path())) == FileKind::Json {
        json_file(&mut lesson, at);
    } else {
        markdown_file(&mut lesson, at);
    }
    lesson
}

fn markdown_file(lesson: &mut Lesson, at: Option<Range<usize>>) {
    let file = lesson.file.clone();
    let (mut scan, text) = (markdown::scan(&file), file.text());
    lesson.problems.extend(scan.problems.drain(..).map(Problem::Fence));
    for block in &scan.blocks {
        if lesson.problems.len() > MAX_PROBLEMS {
            break;
        }
        match &block.kind {
            BlockKind::Lab(widget) if widget == "simlab" => {
                let node = body(block, &at, lesson);
                if let Some(node) = &node
                    && nature(node) == Nature::Quiz
                {
                    let mistake = Mistake::HoldsQuiz(head(text, block, "quiz"));
                    lesson.problems.push(mistake.at(block.info.clone()));
                    lesson.quizzes.extend(quiz::read(node, &mut lesson.problems));
                    continue;
                }
                let lab = node.and_then(|node| lab::read(&node, &mut lesson.problems));
                push_lab(lesson, block.span.clone(), lab);
            }
            BlockKind::Lab(widget) => {
                let node = body(block, &at, lesson);
                let model = node.as_ref().and_then(|n| match &n.get("model")?.json {
                    Json::Text(text) => Some(text.clone()),
                    _ => None,
                });
                lesson.widgets.push(Widget { name: widget.clone(), span: block.span.clone(), model });
            }
            BlockKind::Quiz => {
                let Some(node) = body(block, &at, lesson) else { continue };
                if nature(&node) == Nature::Lab {
                    let mistake = Mistake::HoldsLab(head(text, block, "lab simlab"));
                    lesson.problems.push(mistake.at(block.info.clone()));
                    let lab = lab::read(&node, &mut lesson.problems);
                    push_lab(lesson, block.span.clone(), lab);
                    continue;
                }
                lesson.quizzes.extend(quiz::read(&node, &mut lesson.problems));
            }
            BlockKind::Code { .. } => {}
        }
    }
    lesson.scan = scan;
}

/// The opening line of a block, for another kind.
fn head(text: &str, block: &Block, kind: &str) -> String {
    let old = text.get(block.info.clone()).unwrap_or("");
    let marks: String = old.chars().take_while(|c| matches!(c, '`' | '~')).collect();
    format!("{marks}{kind}")
}

/// The JSON of a block.
fn body(block: &Block, at: &Option<Range<usize>>, lesson: &mut Lesson) -> Option<Node> {
    if block.body.value.trim().is_empty() {
        lesson.broken.push(block.span.clone());
        lesson.problems.push(Mistake::EmptyFence.at(block.info.clone()));
        return None;
    }
    let map = at.as_ref().map(|at| SourceMap::whole(block.body.value.len(), at.clone()));
    read_json(&block.body.value, map.as_ref().unwrap_or(&block.body.map), block.span.clone(), lesson)
}

/// Parses JSON, which may be broken: what can be read of it is read.
fn read_json(text: &str, map: &SourceMap, span: Range<usize>, lesson: &mut Lesson) -> Option<Node> {
    let parsed = json::parse(text, map);
    if parsed.broken {
        lesson.broken.push(span);
    }
    lesson.problems.extend(parsed.problems.into_iter().map(Problem::Json));
    parsed.node
}

fn push_lab(lesson: &mut Lesson, span: Range<usize>, lab: Option<Lab>) {
    let number = lesson.labs.len() + 1;
    let broken = lab.is_none() || lesson.is_broken(&span);
    lesson.labs.push(LabEntry { number, span, broken, lab });
}

/// A lab, a quiz, or a list of them, told apart by their keys.
fn json_file(lesson: &mut Lesson, at: Option<Range<usize>>) {
    let text = lesson.file.text();
    // A byte order mark is no part of JSON, and editors hide it.
    let start = if text.starts_with('\u{feff}') { '\u{feff}'.len_utf8() } else { 0 };
    let (length, whole) = (text.len() - start, 0..text.len());
    let map = at.map_or(SourceMap::verbatim(start..text.len()), |at| SourceMap::whole(length, at));
    let text = text.get(start..).unwrap_or("").to_string();
    let Some(node) = read_json(&text, &map, whole, lesson) else { return };
    match &node.json {
        Json::Array(items) => items.iter().for_each(|item| json_item(lesson, item)),
        _ => json_item(lesson, &node),
    }
}

fn json_item(lesson: &mut Lesson, node: &Node) {
    match nature(node) {
        Nature::Quiz => lesson.quizzes.extend(quiz::read(node, &mut lesson.problems)),
        Nature::Lab => {
            let lab = lab::read(node, &mut lesson.problems);
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

    /// Lessons put together from what breaks them.
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
        /// No lesson is a panic; every place is a place of the file; reports can be drawn.
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

    /// Inputs that make careless checkers slow.
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

    #[test]
    fn addresses_read_what_they_print() {
        for (text, address) in [
            ("#2", Some(LabAddress::Lab(2))),
            ("#0.1-predict.2", Some(LabAddress::Sim { quiz: "0.1-predict".into(), question: 2 })),
            ("#0", None),
            ("2", None),
            ("#quiz", None),
            ("#.1", None),
            ("#quiz.0", None),
            ("#99999999999999999999", None),
        ] {
            assert_eq!(LabAddress::parse(text), address, "{text}");
            if let Some(address) = address {
                assert_eq!(address.to_string(), text);
            }
        }
    }
}
