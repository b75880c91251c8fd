//! Damaged lessons, labs and quizzes: they are read, checked, formatted and reported to people and programs; some are run.

use super::run_cases;
use crate::program::{CLEAN, FALL, wrong};
use crate::support::random::Random;
use crate::support::{model_text, workspace};
use labspec::bind::scene::Models;
use labspec::check::{self, CheckLevel};
use labspec::format::format;
use labspec::lint::ModelFolder;
use labspec::lint::load_lesson;
use labspec::report;
use labspec::source::SourceFile;
use std::ops::Range;
use std::path::Path;

/// The number of cases of a test run.
const CASES: u64 = 600;
/// One of this many cases is run and verified, in a lesson with short runs.
const RUN: u64 = 20;

/// Texts that are inserted between two characters or that replace numbers and strings.
const PIECES: &[&str] = &[
    "\"",
    "{",
    "}",
    "[",
    "]",
    ",",
    ":",
    "\\",
    "'",
    "`",
    "```",
    "~~~",
    "\n",
    "\r\n",
    "\t",
    "\u{0}",
    "\u{7f}",
    "\u{202e}",
    "\u{feff}",
    "é",
    "😀",
    "//",
    "/*",
    "<!--",
    "-->",
    "<b>",
    "$",
    "$$",
    "#",
    "> ",
    "    ",
    "- ",
    "\\u",
    "\\ud800",
    "True",
    "null",
    "NaN",
    "9",
    ".",
    "-",
    "e",
    "```lab simlab\n",
    "```quiz\n",
    "```lab\n",
    "```json lab\n",
    "value",
    "ctx.",
    "data.",
    "||",
    "(",
    ")",
    "=",
];
const VALUES: &[&str] = &[
    "0",
    "-0",
    "1",
    "-1",
    "2",
    "0.5",
    "20",
    "1e300",
    "-1e300",
    "1e999",
    "null",
    "true",
    "[]",
    "{}",
    "\"\"",
    "\"x\"",
    "[[[]]]",
    "\"\\u0000\"",
    "NaN",
    "-",
    "\"1\"",
    "\"data.qpos[2]\"",
    "\"`\"",
    "[1, 2, 3]",
    "{\"a\": 1}",
];

/// Lessons with short runs, and all lessons.
struct Corpus {
    quick: Vec<String>,
    all: Vec<String>,
}

fn texts(folder: &Path) -> Vec<String> {
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten().map(|e| e.path());
    let mut files: Vec<_> =
        entries.filter(|p| p.extension().is_some_and(|e| e == "md" || e == "json")).collect();
    files.sort();
    files.iter().filter_map(|f| std::fs::read_to_string(f).ok()).collect()
}

impl Corpus {
    fn read() -> Corpus {
        let quick = vec![CLEAN.to_string(), wrong(), FALL.to_string()];
        let folders = ["tests/lessons", "specs/lessons", "../shared/corpus/labs", "../shared/corpus/quizzes"];
        let all = folders.iter().flat_map(|f| texts(&workspace().join(f))).chain(quick.clone()).collect();
        Corpus { quick, all }
    }
}

fn boundary(text: &str, at: usize) -> usize {
    (at.min(text.len())..).find(|&i| text.is_char_boundary(i)).unwrap()
}

/// The byte ranges of numbers, and of strings with their quotes.
fn scalars(text: &str) -> Vec<Range<usize>> {
    let (mut all, mut at) = (Vec::new(), 0);
    let bytes = text.as_bytes();
    while at < bytes.len() {
        let end = match bytes[at] {
            b'"' => text[at + 1..].find(['"', '\n']).map_or(bytes.len(), |n| at + n + 2).min(bytes.len()),
            b'0'..=b'9' => text[at..]
                .find(|c: char| !c.is_ascii_alphanumeric() && c != '.')
                .map_or(bytes.len(), |n| at + n),
            _ => {
                at += 1;
                continue;
            }
        };
        if text.is_char_boundary(end) {
            all.push(at..end);
        }
        at = end;
    }
    all
}

fn mutate(random: &mut Random, corpus: &Corpus, text: &mut String) {
    let at = boundary(text, random.below(text.len() + 1));
    match random.below(10) {
        0 | 1 => text.insert_str(at, random.word(PIECES)),
        2 | 3 => {
            let end = boundary(text, at + 1 + random.below(3));
            text.replace_range(at..end.min(text.len()), "");
        }
        4 => text.truncate(at),
        5 | 6 => {
            let places = scalars(text);
            if !places.is_empty() {
                let place = random.pick(&places).clone();
                text.replace_range(place, random.word(VALUES));
            }
        }
        7 => {
            // Replaces a value by another one.
            let places = scalars(text);
            if !places.is_empty() {
                let other = text[random.pick(&places).clone()].to_string();
                let place = random.pick(&places).clone();
                text.replace_range(place, &other);
            }
        }
        8 => {
            // Inserts a copy of a line.
            let lines: Vec<&str> = text.split_inclusive('\n').collect();
            if lines.is_empty() {
                return;
            }
            let line = random.pick(&lines).to_string();
            let at = lines.iter().take(random.below(lines.len() + 1)).map(|l| l.len()).sum();
            text.insert_str(at, &line);
        }
        _ => {
            let other = random.pick(&corpus.all);
            let from = boundary(other, random.below(other.len() + 1));
            let end = boundary(other, from + random.below(200)).min(other.len());
            text.insert_str(at, &other[from..end]);
        }
    }
}

/// Whether nothing is between two backticks of a message. Three backticks are a fence.
fn is_empty_quote(text: &str) -> bool {
    let at = |i: usize| text.as_bytes().get(i) == Some(&b'`');
    text.match_indices("``").any(|(i, _)| !(at(i + 2) || i > 0 && at(i - 1)))
}

/// The findings of a check as text: the report for people and the report for programs. Every span is inside the file.
fn messages(name: &str, text: &str, models: &ModelFolder, depth: CheckLevel) -> String {
    let mut models = Models::new(models.clone());
    let lesson = load_lesson(SourceFile::new(name, text), models.folder());
    let checked = check::check_lesson(lesson, &models, depth);
    let of_models = models.take_findings();
    let file = &checked.lesson.file;
    let inside = |span: &Range<usize>| span.start <= span.end && file.text().get(span.clone()).is_some();
    for finding in checked.findings.iter().filter(|f| f.path == *file.path()) {
        assert!(inside(&finding.span), "{finding:?}");
        assert!(finding.fix.as_ref().is_none_or(|fix| inside(&fix.span)), "{finding:?}");
        // An empty name must not be printed between backticks.
        let texts = [finding.message.as_str()]
            .into_iter()
            .chain(finding.help.as_deref())
            .chain(finding.why.as_deref());
        // A backtick that the author wrote, outside of fences, may be next to a backtick of the message.
        let rest = |l: &str| l.trim_start_matches(['>', ' ']).trim_start_matches("```").contains('`');
        let has_code = text.lines().any(rest) || (name.ends_with("json") && text.contains('`'));
        texts.for_each(|t| assert!(has_code || !is_empty_quote(t), "{finding:?}"));
        let here = finding.related.iter().filter(|place| place.path == *file.path());
        here.for_each(|place| assert!(inside(&place.span), "{finding:?}"));
    }
    let verdicts: Vec<String> = checked.claims.iter().map(|c| format!("{c:?}")).collect();
    let human = report::human(&checked.findings, &[file], true);
    let machine = report::json(&checked.findings, &[file]);
    format!("{human}\n{machine}\n{verdicts:?}\n{}", of_models.len())
}

#[test]
fn damaged_lessons_are_read_checked_and_reported() {
    let corpus = Corpus::read();
    let folder = tempfile::tempdir().unwrap();
    for name in ["ball_drop", "free_fall"] {
        std::fs::write(folder.path().join(format!("{name}.xml")), model_text(name)).unwrap();
    }
    let models = ModelFolder::open(folder.path()).unwrap();
    run_cases(CASES, |n| {
        let mut random = Random(n);
        let runs = n.is_multiple_of(RUN);
        let mut text = random.pick(if runs { &corpus.quick } else { &corpus.all }).clone();
        for _ in 0..1 + random.below(4) {
            mutate(&mut random, &corpus, &mut text);
        }
        let depth = if runs { CheckLevel::FULL } else { CheckLevel::STATIC };
        let name = if text.trim_start().starts_with(['{', '[']) { "lesson.json" } else { "lesson.md" };
        let first = messages(name, &text, &models, depth);
        assert!(runs || first == messages(name, &text, &models, depth), "not the same twice");
        let lesson = load_lesson(SourceFile::new(name, text.clone()), &models);
        format(&lesson, None);
        text
    });
}
