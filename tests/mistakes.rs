//! Lessons as an author writes them, with one mistake each: the check gives one finding, and its help, done literally, ends it.
//!
//! `tests/mistakes/NAME.md` is the wrong lesson. `NAME.fix` contains the code of its finding, and what an author does who
//! follows the help: lines `- text` and `+ text`, each a text of the lesson and its replacement, in all places. What is inserted
//! must be in the help or in the fix of the finding. So the help leads to the right lesson, without knowledge of labspec.

// A test that cannot read its own inputs must fail.
#![allow(clippy::unwrap_used, clippy::panic)]

use crate::support::{check_text, for_each, sorted_files, workspace};
use labspec::finding::Finding;
use std::path::{Path, PathBuf};

/// What an author does after reading a finding.
struct Correction {
    /// The code of the finding.
    code: String,
    /// Texts of the lesson, and their replacements.
    replacements: Vec<(String, String)>,
}

impl Correction {
    fn read(path: &Path) -> Correction {
        let text = std::fs::read_to_string(path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
        let mut lines = text.lines();
        let code = lines.next().unwrap().to_string();
        let unescaped = |line: &str| line.replace("\\n", "\n");
        let mut replacements = Vec::new();
        while let Some(old) = lines.next() {
            let new = lines.next().unwrap();
            let [old, new] = [(old, "- "), (new, "+ ")].map(|(line, sign)| {
                unescaped(line.strip_prefix(sign).unwrap_or_else(|| panic!("{}: {line}", path.display())))
            });
            replacements.push((old, new));
        }
        Correction { code, replacements }
    }

    fn apply(&self, lesson: &str) -> String {
        self.replacements.iter().fold(lesson.to_string(), |text, (old, new)| {
            assert!(text.contains(old), "the lesson does not contain {old:?}");
            text.replace(old, new)
        })
    }
}

/// What a replacement inserts: the new text without what it shares with the old one. A part of a word is extended to the
/// word. Nothing for a deletion.
fn inserted<'t>(old: &str, new: &'t str) -> &'t str {
    let bare = |text: &'t str| match text.trim().trim_matches([',', ';']).trim() {
        "" => text.trim(),
        text => text,
    };
    if let Some(added) = new.strip_prefix(old).or(new.strip_suffix(old)) {
        return bare(added);
    }
    let is_part = |c: char| c.is_alphanumeric() || matches!(c, '_' | '.');
    let shared = old.chars().zip(new.chars()).take_while(|(a, b)| a == b);
    let mut start: usize = shared.map(|(c, _)| c.len_utf8()).sum();
    let ends = old[start..].chars().rev().zip(new[start..].chars().rev()).take_while(|(a, b)| a == b);
    let behind: usize = ends.map(|(c, _)| c.len_utf8()).sum();
    let mut end = new.len() - behind;
    let removed = &old[start..old.len() - behind];
    if !new[start..end].contains(is_part) && !removed.contains(is_part) {
        return bare(&new[start..end]);
    }
    let in_word = new[..start].ends_with(is_part) || new[end..].starts_with(is_part);
    if start == end && !in_word {
        return "";
    }
    while let Some(c) = new[..start].chars().next_back().filter(|c| is_part(*c)) {
        start -= c.len_utf8();
    }
    while let Some(c) = new[end..].chars().next().filter(|c| is_part(*c)) {
        end += c.len_utf8();
    }
    bare(&new[start..end]).trim_matches('.')
}

/// Whether an advice contains a text as whole words.
fn offers(advice: &str, text: &str) -> bool {
    let is_part = |c: char| c.is_alphanumeric() || c == '_';
    advice.match_indices(text).any(|(at, _)| {
        let (before, after) = (&advice[..at], &advice[at + text.len()..]);
        let begins = !text.starts_with(is_part) || !before.ends_with(is_part);
        let goes_on =
            after.strip_prefix('.').is_some_and(|rest| rest.starts_with(|c: char| c.is_ascii_digit()));
        let ends = !text.ends_with(is_part) || !(after.starts_with(is_part) || goes_on);
        begins && ends
    })
}

/// The advice of a finding: its help and its fix, with either kind of quotes.
fn advice(finding: &Finding) -> String {
    let fix = finding.fix.as_ref().map_or("", |fix| &fix.text);
    format!("{} {fix}", finding.help.as_deref().unwrap_or("")).replace('\'', "\"")
}

fn describe(findings: &[Finding]) -> String {
    findings.iter().map(|f| format!("{f}\n  fix: {:?}\n", f.fix)).collect()
}

/// What is wrong with the findings of a lesson and their advice; empty if nothing is.
fn judge(path: &Path) -> String {
    let name = path.file_stem().unwrap().to_str().unwrap();
    let lesson = std::fs::read_to_string(path).unwrap();
    let correction = Correction::read(&path.with_extension("fix"));
    let findings = check_text(&format!("{name}.md"), &lesson).findings;
    let [finding] = findings.as_slice() else {
        return format!("{name}: {} findings\n{}", findings.len(), describe(&findings));
    };
    if finding.code != correction.code {
        return format!("{name}: not {}\n{}", correction.code, describe(&findings));
    }
    let advice = advice(finding);
    for (old, new) in &correction.replacements {
        let whole = new.replace('\'', "\"");
        let inserted = inserted(old, new).replace('\'', "\"");
        let deletes =
            || advice.contains("delete") || finding.fix.as_ref().is_some_and(|fix| fix.text.is_empty());
        if !(if inserted.is_empty() {
            deletes() || !whole.is_empty() && offers(&advice, &whole)
        } else {
            offers(&advice, &inserted)
        }) {
            return format!("{name}: the help does not say {inserted:?}\n{}", describe(&findings));
        }
    }
    let left = check_text(&format!("{name}.md"), &correction.apply(&lesson)).findings;
    match left.is_empty() {
        true => String::new(),
        false => format!("{name}: after the correction\n{}", describe(&left)),
    }
}

#[test]
fn a_mistake_is_one_finding_whose_help_ends_it() {
    let mut lessons: Vec<PathBuf> = sorted_files(&workspace().join("tests/mistakes"));
    lessons.retain(|path| path.extension().is_some_and(|e| e == "md"));
    assert!(lessons.len() >= 90, "{}", lessons.len());
    let faults = for_each(lessons.len(), |i| judge(&lessons[i]));
    let faults: Vec<String> = faults.into_iter().filter(|fault| !fault.is_empty()).collect();
    assert!(faults.is_empty(), "{} of {}:\n\n{}", faults.len(), lessons.len(), faults.join("\n"));
}

#[test]
fn what_a_correction_inserts() {
    for (old, new, text) in [
        ("abss", "abs", "abs"),
        ("swign", "swing", "swing"),
        ("\"answer\": 0", "\"answer\": 2", "2"),
        ("value", "value; mj.mj_setConst(model, data)", "mj.mj_setConst(model, data)"),
        ("[3]", "[2]", "2"),
        ("1.98", "1.99", "1.99"),
        ("(L", "(ctx.L", "ctx.L"),
        ("mon.", "moon.", "moon"),
        ("true,}", "true}", ""),
        ("1", "1,", ","),
        ("\"q\"", "\"id\": 0, \"q\"", "\"id\": 0"),
        (", \"z < 0\"]", "]", ""),
    ] {
        assert_eq!(inserted(old, new), text, "{old} {new}");
    }
    assert!(offers("write 1.42, or", "1.42") && !offers("write 1.42251", "1.42") && !offers("0 to 21", "2"));
    assert!(!offers("indexes are 1.2", "1") && offers("use index 0, the only one", "0"));
}
