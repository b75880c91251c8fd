//! Another layout, and other words around a number, do not make a claim false.

use super::places::{Place, places, verifies};
use super::{checked, course, for_each, list_findings, models};
use crate::program::program;
use labspec::check::CheckLevel;
use labspec::verify::QuoteState;
use serde_json::Value;

/// A lesson with another layout or wording.
type Change = fn(&str) -> String;

const CHANGES: [(&str, Change); 6] = [
    ("lines of any length", |text| wrapped(text, usize::MAX)),
    ("short lines", |text| wrapped(text, 50)),
    ("pretty JSON", |text| fences(text, |json| serde_json::to_string_pretty(&json).unwrap())),
    ("JSON on one line", |text| fences(text, |json| json.to_string())),
    ("no break between number and unit", |text| rewrite_numbers(text, |quote| quote.replace(' ', "&nbsp;"))),
    ("other words", |text| rewrite_numbers(text, |quote| format!("what comes to {quote}, as they say,"))),
];

/// Wraps paragraphs of prose at this width. Everything else is unchanged.
fn wrapped(text: &str, width: usize) -> String {
    let (mut out, mut words, mut fenced, mut formula) = (String::new(), Vec::new(), false, false);
    let flush = |out: &mut String, words: &mut Vec<&str>| {
        let mut length = 0;
        for word in words.drain(..) {
            if length > 0 && length + word.len() >= width {
                out.push('\n');
                length = 0;
            } else if length > 0 {
                out.push(' ');
            }
            out.push_str(word);
            length += word.len() + 1;
        }
        if length > 0 {
            out.push('\n');
        }
    };
    for line in text.lines() {
        let fence = line.starts_with("```");
        let prose = !(fenced
            || formula
            || fence
            || line.is_empty()
            || line.starts_with(['#', '|', '*'])
            || line.contains("$$"));
        if prose {
            words.extend(line.split(' '));
            continue;
        }
        flush(&mut out, &mut words);
        fenced ^= fence;
        formula ^= line.matches("$$").count() == 1;
        out.push_str(line);
        out.push('\n');
    }
    flush(&mut out, &mut words);
    out
}

/// Writes the JSON of every fence with another function.
fn fences(text: &str, write: impl Fn(Value) -> String) -> String {
    let (mut out, mut rest) = (String::new(), text);
    while let Some(start) =
        ["```lab simlab\n", "```quiz\n"].iter().filter_map(|f| Some(rest.find(f)? + f.len())).min()
    {
        let end = start + rest[start..].find("\n```").unwrap();
        out.push_str(&rest[..start]);
        out.push_str(&write(serde_json::from_str(&rest[start..end]).unwrap()));
        rest = &rest[end..];
    }
    out + rest
}

/// Writes each number of prose, questions and explanations in another way. Labels are not HTML, so they are left unchanged. In
/// formulas, a word would be set as italic letters.
fn rewrite_numbers(text: &str, write: impl Fn(&str) -> String) -> String {
    let mut out = String::new();
    let mut from = 0;
    for Place { at, quote } in places(text) {
        let line = text[..at.start].rfind('\n').map_or(0, |i| i + 1);
        let before = &text[line..at.start];
        let plain =
            ["\"label\"", "\"note\"", "\"options\"", "\"title\"", "$$"].iter().any(|k| before.contains(k));
        let formula = before.matches('$').count() % 2 == 1 || quote.contains('=');
        if plain || formula || line < from {
            continue;
        }
        // At most one in each line: more changes would make a line too long to read, without testing anything else.
        out.push_str(&text[from..at.start]);
        out.push_str(&write(&quote));
        from = at.end;
    }
    out + &text[from..]
}

#[test]
fn another_layout_and_wording_are_accepted() {
    let models = models();
    let lessons = course();
    let wrong = for_each(lessons.len() * CHANGES.len(), |i| {
        let (lesson, (how, change)) = (&lessons[i % lessons.len()], CHANGES[i / lessons.len()]);
        let text = change(&lesson.text);
        assert!(text != lesson.text || how == "other words", "{how} changes nothing of {}", lesson.name);
        assert_eq!(verifies(&text).len(), verifies(&lesson.text).len());
        let checked = checked(&lesson.name, &text, &models, CheckLevel::CLAIMS);
        let quotes = checked.claims.iter().flat_map(|c| &c.judgement.quotes);
        let unsure = quotes.filter(|q| q.state != QuoteState::Right).map(|q| q.reason.clone());
        let all: Vec<String> = list_findings(&checked).into_iter().chain(unsure).collect();
        all.into_iter().map(|what| format!("{}, {how}: {what}", lesson.name)).collect::<Vec<_>>()
    });
    let wrong: Vec<String> = wrong.into_iter().flatten().collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// The course remains correct after `labspec fmt`.
#[test]
fn a_formatted_course_is_clean() {
    let folder = tempfile::tempdir().unwrap();
    let from = crate::support::workspace().join("specs");
    for part in ["lessons", "models"] {
        std::fs::create_dir(folder.path().join(part)).unwrap();
        for entry in std::fs::read_dir(from.join(part)).unwrap().map(Result::unwrap) {
            if entry.file_type().unwrap().is_file() {
                std::fs::copy(entry.path(), folder.path().join(part).join(entry.file_name())).unwrap();
            }
        }
    }
    std::fs::copy(from.join("labspec.toml"), folder.path().join("labspec.toml")).unwrap();
    let done = program(folder.path(), &["fmt", "lessons"]).output().unwrap();
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
    let done = program(folder.path(), &["check", "lessons"]).output().unwrap();
    assert_eq!(done.status.code(), Some(0), "{}", String::from_utf8_lossy(&done.stdout));
}
