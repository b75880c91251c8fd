//! Eight lessons without claims, as an old course has them: what `scaffold --write` proves alone, and the bytes that an author writes
//! by hand for the rest (`tests/eight/by-hand`). Writes `docs/measured/authors.md`.

#![allow(clippy::unwrap_used, clippy::panic)]

use crate::needs::needs;
use crate::population::sample;
use crate::program::run_in;
use crate::support::{for_each, read_json, workspace};
use labspec::bind::scene::Models;
use labspec::check::{self, CheckLevel, Checked};
use labspec::lint::{ModelFolder, load_lesson};
use labspec::source::SourceFile;
use labspec::spec::{Lesson, QuestionKind};
use labspec::verify::{QuoteState, Stated, Verdict, counted};
use serde_json::Value;
use std::fmt::Write;
use std::path::{Path, PathBuf};

/// The aims: the share of decidable questions that need no keystroke, the bytes for each of the others, and those for a number
/// of a table.
const PROVEN_ALONE: f64 = 0.5;
const BYTES_OF_QUESTION: usize = 200;
const BYTES_OF_NUMBER: f64 = 20.0;
/// The share of the numbers of tables that proposals claim.
const CELLS_ALONE: f64 = 0.9;

/// A lesson without claims.
struct OldLesson {
    name: &'static str,
    text: String,
    models: PathBuf,
}

/// The four lessons of our own, and four of other courses if they are there.
fn lessons() -> Vec<OldLesson> {
    let folder = workspace().join("tests/eight");
    let of_own = |name| OldLesson {
        name,
        text: std::fs::read_to_string(folder.join(format!("{name}.md"))).unwrap(),
        models: folder.join("models"),
    };
    let mut all: Vec<OldLesson> = ["waves", "orbits", "gears", "collisions"].map(of_own).into();
    if needs("../shared/corpus") {
        let shared = workspace().join("../shared");
        let read = |path: &str| std::fs::read_to_string(shared.join(path)).unwrap();
        let models = shared.join("corpus/models");
        let first = read("lesson-0.1/lesson-0.1.md");
        all.push(OldLesson { name: "lesson-0.1", text: first, models: models.clone() });
        // The labs and the quizzes of a lesson are files of their own there; its prose is not.
        for name in ["5.1", "5.3", "9.3"] {
            let [lab, quiz] = [format!("labs/{name}_01_simlab"), format!("quizzes/{name}_01")]
                .map(|file| read(&format!("corpus/{file}.json")).trim().to_string());
            let text = format!("# Lesson {name}\n\n```lab simlab\n{lab}\n```\n\n```quiz\n{quiz}\n```\n");
            all.push(OldLesson { name, text, models: models.clone() });
        }
    }
    all
}

/// What an author adds by hand.
struct ByHand {
    /// Objects by the addresses of their questions: whole ones, or under `skeleton` the keys that replace those of a skeleton.
    questions: Vec<(String, Value)>,
    /// Comments, each before the first line that begins with a text.
    comments: Vec<(String, Value)>,
    /// Questions that no run of the labs of the lesson and no formula decides, each with the reason.
    undecidable: Vec<(String, String)>,
}

fn by_hand(name: &str) -> ByHand {
    let all = read_json(&workspace().join(format!("tests/eight/by-hand/{name}.json")));
    let entries = |key: &str| -> Vec<(String, Value)> {
        let object = all[key].as_object();
        object.into_iter().flatten().map(|(name, value)| (name.clone(), value.clone())).collect()
    };
    let text = |(name, value): (String, Value)| (name, value.as_str().unwrap().to_string());
    ByHand {
        questions: entries("questions"),
        comments: entries("comments"),
        undecidable: entries("undecidable").into_iter().map(text).collect(),
    }
}

/// The figures of a lesson.
struct Figures {
    name: &'static str,
    questions: usize,
    decidable: usize,
    alone: usize,
    /// The bytes for each of the other decidable questions.
    bytes: Vec<(String, usize)>,
    numbers: usize,
    numbers_alone: usize,
    /// The numbers in tables, without first columns, and those of them that proposals claim.
    cells: usize,
    cells_alone: usize,
    /// The bytes of comments, and the numbers that they claim.
    comments: (usize, usize),
}

fn load(lesson: &OldLesson, text: &str) -> (Lesson, Models) {
    let models = Models::new(ModelFolder::open(&lesson.models).unwrap());
    (load_lesson(SourceFile::new(format!("{}.md", lesson.name), text), models.folder()), models)
}

fn checked(lesson: &OldLesson, text: &str) -> Checked {
    let (loaded, models) = load(lesson, text);
    assert!(!loaded.has_errors(), "{}: {:#?}", lesson.name, loaded.findings);
    check::check_lesson(loaded, &models, CheckLevel { labs: false, ..CheckLevel::FULL })
}

/// The addresses of the questions whose answers are true. Everything else that is claimed must be true as well.
fn proven(name: &str, checked: &Checked) -> Vec<String> {
    let mut all = Vec::new();
    for claim in &checked.claims {
        let wrong: Vec<String> = claim
            .judgement
            .quotes
            .iter()
            .filter(|q| q.state != QuoteState::Right)
            .map(|q| format!("{}: {}", q.text, q.reason))
            .collect();
        assert!(wrong.is_empty(), "{name}, {}: {wrong:#?}", claim.name);
        let Some(answer) = &claim.judgement.answer else { continue };
        if answer.verdict == Verdict::Unverified {
            continue;
        }
        let is_true = matches!(answer.verdict, Verdict::Verified | Verdict::Computed);
        assert!(is_true, "{name}, {}: {} {}", claim.name, answer.verdict.as_str(), answer.reason);
        let address = claim.name.strip_prefix("quiz ").unwrap().replace(", question ", ".");
        all.push(address);
    }
    all
}

/// The addresses of all questions with a key.
fn questions(lesson: &Lesson) -> Vec<String> {
    let with_key = lesson.quizzes.iter().flat_map(|quiz| {
        let id = quiz.id.as_ref().unwrap().as_str().to_string();
        let closed = quiz.numbered().filter(|(_, q)| !matches!(q.kind, QuestionKind::Open { .. }));
        closed.map(move |(number, _)| format!("{id}.{number}"))
    });
    with_key.collect()
}

/// Writes the proposals for a lesson into a file, and returns its text.
fn scaffolded(lesson: &OldLesson, folder: &Path, text: &str, names: &[&str]) -> String {
    let file = folder.join(format!("{}.md", lesson.name));
    std::fs::write(&file, text).unwrap();
    let (path, models) = (file.to_str().unwrap(), lesson.models.to_str().unwrap());
    let done = run_in(folder, &[&["scaffold", path, "--models", models, "--write"], names].concat());
    assert!(done.code < 2, "{}: {}", lesson.name, done.stderr);
    std::fs::read_to_string(&file).unwrap()
}

/// The `verify` object of a question in a text: its place, and the object.
fn object_of(lesson: &Lesson, address: &str) -> (std::ops::Range<usize>, Value) {
    let (id, number) = address.rsplit_once('.').unwrap();
    let quiz = lesson.quizzes.iter().find(|q| q.id.as_ref().is_some_and(|t| t.as_str() == id)).unwrap();
    let (_, question) = quiz.numbered().find(|(n, _)| n.to_string() == number).unwrap();
    let object: Value = serde_json::from_str(&lesson.file.text()[question.span.clone()]).unwrap();
    (question.span.clone(), object)
}

/// Adds what an author writes by hand: returns the text, and the bytes for each question.
fn completed(lesson: &OldLesson, folder: &Path, text: &str, hand: &ByHand) -> (String, Vec<(String, usize)>) {
    let mut text = text.to_string();
    let mut bytes = Vec::new();
    for (address, keys) in &hand.questions {
        let keys = match keys.get("skeleton") {
            Some(keys) => {
                text = scaffolded(lesson, folder, &text, &[address]);
                keys
            }
            None => keys,
        };
        let (span, mut question) = object_of(&load(lesson, &text).0, address);
        for (key, value) in keys.as_object().unwrap() {
            question["verify"][key] = value.clone();
        }
        text.replace_range(span, &question.to_string());
        bytes.push((address.clone(), keys.to_string().len()));
    }
    for (before, verify) in &hand.comments {
        let at = text.find(&format!("\n{before}")).unwrap_or_else(|| panic!("{before}")) + 1;
        text.insert_str(at, &format!("<!-- labspec verify {verify} -->\n"));
    }
    (text, bytes)
}

/// Whether a number is in a table, and not in its first column.
fn is_cell(text: &str, s: &Stated) -> bool {
    let before = &text[..s.span.start];
    let line = &before[before.rfind('\n').map_or(0, |at| at + 1)..];
    !s.column.is_empty() && line.matches('|').count() > 1
}

fn measure(lesson: &OldLesson) -> Figures {
    let folder = tempfile::tempdir().unwrap();
    let hand = by_hand(lesson.name);
    let (loaded, _) = load(lesson, &lesson.text);
    let all = questions(&loaded);
    let text = scaffolded(lesson, folder.path(), &lesson.text, &[]);
    let alone = proven(lesson.name, &checked(lesson, &text));
    let left: Vec<&String> = all.iter().filter(|address| !alone.contains(address)).collect();
    // Every question is proven by a proposal, by hand, or listed as undecidable.
    let is_undecidable = |address: &String| hand.undecidable.iter().any(|(name, _)| name == address);
    let mut by_hand: Vec<&String> = hand.questions.iter().map(|(address, _)| address).collect();
    let mut expected: Vec<&String> = left.into_iter().filter(|address| !is_undecidable(address)).collect();
    by_hand.sort();
    expected.sort();
    assert_eq!(by_hand, expected, "{}: the questions that are left", lesson.name);
    let (full, bytes) = completed(lesson, folder.path(), &text, &hand);
    let done = proven(lesson.name, &checked(lesson, &full));
    assert_eq!(done.len(), all.len() - hand.undecidable.len(), "{}: {done:?}", lesson.name);
    let claimed = |text: &str| counted(&load(lesson, text).0);
    let (before, after) = (claimed(&text), claimed(&full));
    let cells = |text: &str, numbers: &[Stated]| numbers.iter().filter(|s| is_cell(text, s)).count();
    let comment_bytes =
        hand.comments.iter().map(|(_, v)| format!("<!-- labspec verify {v} -->\n").len()).sum();
    Figures {
        name: lesson.name,
        questions: all.len(),
        decidable: done.len(),
        alone: alone.len(),
        bytes,
        numbers: before.count(),
        numbers_alone: before.claimed.len(),
        cells: cells(&text, &before.claimed) + cells(&text, &before.left),
        cells_alone: cells(&text, &before.claimed),
        comments: (comment_bytes, after.claimed.len() - before.claimed.len()),
    }
}

/// The page of the figures.
fn page(all: &[Figures]) -> String {
    let mut text = String::from(include_str!("eight/page.txt"));
    text += "\n| lesson | questions | decidable | proven alone | by hand | bytes by hand, each | in tables | claimed alone | numbers | claimed alone |\n|---|---:|---:|---:|---:|---|---:|---:|---:|---:|\n";
    for f in all {
        let bytes: Vec<String> = f.bytes.iter().map(|(_, n)| n.to_string()).collect();
        let bytes = if bytes.is_empty() { "–".to_string() } else { bytes.join(", ") };
        let _ = writeln!(
            text,
            "| {} | {} | {} | {} | {} | {bytes} | {} | {} | {} | {} |",
            f.name,
            f.questions,
            f.decidable,
            f.alone,
            f.bytes.len(),
            f.cells,
            f.cells_alone,
            f.numbers,
            f.numbers_alone
        );
    }
    let sum = |of: &dyn Fn(&Figures) -> usize| all.iter().map(of).sum::<usize>();
    let [bytes, count] = [sum(&|f| f.bytes.iter().map(|(_, n)| n).sum()), sum(&|f| f.bytes.len())];
    let mean = bytes.checked_div(count).unwrap_or(0);
    let _ = writeln!(
        text,
        "| **all** | {} | {} | {} | {count} | mean {mean} | {} | {} | {} | {} |",
        sum(&|f| f.questions),
        sum(&|f| f.decidable),
        sum(&|f| f.alone),
        sum(&|f| f.cells),
        sum(&|f| f.cells_alone),
        sum(&|f| f.numbers),
        sum(&|f| f.numbers_alone)
    );
    text
}

#[test]
fn old_lessons_are_proven_with_few_keystrokes() {
    let lessons = sample(lessons(), 4);
    let all = for_each(lessons.len(), |i| measure(&lessons[i]));
    let [decidable, alone] =
        [all.iter().map(|f| f.decidable).sum::<usize>(), all.iter().map(|f| f.alone).sum()];
    assert!(alone as f64 >= PROVEN_ALONE * decidable as f64, "{alone} of {decidable}");
    let [cells, claimed] =
        [all.iter().map(|f| f.cells).sum::<usize>(), all.iter().map(|f| f.cells_alone).sum()];
    assert!(claimed as f64 >= CELLS_ALONE * cells as f64, "{claimed} of {cells} numbers of tables");
    for f in &all {
        assert!(
            f.alone as f64 >= PROVEN_ALONE * f.decidable as f64,
            "{}: {} of {}",
            f.name,
            f.alone,
            f.decidable
        );
        for (address, bytes) in &f.bytes {
            assert!(*bytes <= BYTES_OF_QUESTION, "{address}: {bytes} bytes");
        }
        let (bytes, numbers) = f.comments;
        assert!(bytes as f64 <= BYTES_OF_NUMBER * numbers as f64, "{}: {bytes} bytes for {numbers}", f.name);
    }
    // The page has the figures of all eight lessons.
    if all.len() < 8 {
        return;
    }
    let path = workspace().join("docs/measured/authors.md");
    let page = page(&all);
    if std::env::var_os("LABSPEC_BLESS").is_some() {
        std::fs::write(&path, &page).unwrap();
    }
    assert_eq!(
        std::fs::read_to_string(&path).unwrap_or_default(),
        page,
        "docs/measured/authors.md is stale: LABSPEC_BLESS=1 cargo test -p labspec-cli --test all eight"
    );
}
