//! `labspec check --fix`: what has a safe repair is repaired, and every repair is checked before it is written.
//!
//! A repair is kept if the file has fewer findings of its rule afterwards, no more errors and no more broken blocks. All repairs of
//! a file that do not touch each other are tried at once; if they do not go together, the first half and then the second, and so
//! on down to single ones; and again, until nothing changes. All other bytes of the file stay what they are.

use super::course::{Plan, collect, is_other_json};
use super::policy::Policies;
use super::target::model_folder_within;
use super::{Failure, interrupted, print, write_file};
use crate::bind::scene::Models;
use crate::check;
use crate::finding::{Applicability, Finding, Fix};
use crate::lint::{load_lesson, load_lesson_file};
use crate::report::{printable, printable_path};
use crate::source::SourceFile;
use crate::spec::{FileKind, Lesson, kind_of};
use similar::TextDiff;
use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;
use std::path::Path;

/// Rounds at most: a repair may make the next one visible.
const ROUNDS: usize = 20;

/// What is repaired, and whether it is written.
#[derive(Clone, Copy, Debug)]
pub(super) struct Mode {
    /// Guesses, too.
    pub(super) guesses: bool,
    /// Show what would change, and change nothing.
    pub(super) diff: bool,
}

/// How many repairs were made, in how many files.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Repaired {
    pub(super) fixes: usize,
    pub(super) files: usize,
}

/// Repairs every lesson.
///
/// # Errors
/// A file cannot be written. One that cannot be read is left to the check.
pub(super) fn fix(plan: &Plan<'_>, mode: Mode) -> Result<Repaired, Failure> {
    let mut policies = Policies::new(plan.policy)?;
    let mut repaired = Repaired::default();
    for (path, named) in collect(plan.paths).0 {
        if interrupted() {
            break;
        }
        if !matches!(kind_of(&path), FileKind::Lesson | FileKind::Json) {
            continue;
        }
        let folder = model_folder_within(plan.models, &path, plan.paths)?;
        let Ok(lesson) = load_lesson_file(&path, &folder) else { continue };
        if !named && is_other_json(&lesson) {
            continue;
        }
        let policy = policies.of(&path)?;
        let models = Models::new(folder);
        let look = |lesson: Lesson| {
            let found = check::examine(&lesson, &models, plan.depth);
            let broken = lesson.broken.len();
            let checked = check::join(lesson, found, plan.depth);
            let mut findings = checked.findings;
            policy.apply(&mut findings);
            Looked { text: checked.lesson.file.text().to_string(), findings, broken }
        };
        let old = lesson.file.text().to_string();
        let name = lesson.file.path().clone();
        let again = |text: &str| look(load_lesson(SourceFile::new(name.clone(), text), models.folder()));
        let (new, count) = repair(look(lesson), mode.guesses, &again);
        if count == 0 || interrupted() {
            continue;
        }
        repaired.fixes += count;
        repaired.files += 1;
        if mode.diff {
            print(&difference(&path, &old, &new))?;
        } else {
            write_file(&path, &new)?;
        }
    }
    Ok(repaired)
}

/// A text, and what is found in it.
struct Looked {
    text: String,
    findings: Vec<Finding>,
    broken: usize,
}

impl Looked {
    fn errors(&self) -> usize {
        self.findings.iter().filter(|f| f.is_error()).count()
    }

    fn of(&self, code: &str) -> usize {
        self.findings.iter().filter(|f| f.code == code).count()
    }
}

/// The repaired text, and how many repairs that took.
fn repair(mut now: Looked, guesses: bool, look: &dyn Fn(&str) -> Looked) -> (String, usize) {
    let mut made = 0;
    for _ in 0..ROUNDS {
        let fixes = apart(&now.findings, guesses);
        if fixes.is_empty() || interrupted() {
            break;
        }
        let old = now.text.clone();
        let mut kept = BTreeSet::new();
        keep(&old, &fixes, 0..fixes.len(), &mut kept, &mut now, look);
        if kept.is_empty() {
            break;
        }
        made += kept.len();
    }
    (now.text, made)
}

/// A repair, and the code of its rule.
type Repair = (&'static str, Fix);

/// Keeps the repairs of a part of the list that repair: all of them if they go together, or else what can be kept of each half. Of
/// n repairs with b bad ones that takes about b log n looks. `now` is the old text with those that are kept.
fn keep(
    old: &str,
    fixes: &[Repair],
    part: Range<usize>,
    kept: &mut BTreeSet<usize>,
    now: &mut Looked,
    look: &dyn Fn(&str) -> Looked,
) {
    if part.is_empty() || interrupted() {
        return;
    }
    if let Some(next) = attempt(old, fixes, part.clone(), kept, now, look) {
        kept.extend(part);
        *now = next;
    } else if part.len() > 1 {
        let middle = part.start + part.len() / 2;
        keep(old, fixes, part.start..middle, kept, now, look);
        keep(old, fixes, middle..part.end, kept, now, look);
    }
}

/// Repairs that do not touch each other, in the order of the text, with the codes of their rules.
fn apart(findings: &[Finding], guesses: bool) -> Vec<Repair> {
    let may = |fix: &Fix| match fix.applicability {
        Applicability::Safe => true,
        Applicability::Unsafe => guesses,
        Applicability::Display => false,
    };
    let mut all: Vec<Repair> =
        findings.iter().filter_map(|f| Some((f.code, f.fix.clone().filter(may)?))).collect();
    all.sort_by_key(|(_, fix)| (fix.span.start, fix.span.end));
    all.dedup_by(|a, b| a.1 == b.1);
    let mut end = None;
    all.retain(|(_, fix)| {
        let free = end.is_none_or(|end| fix.span.start > end);
        if free {
            end = Some(fix.span.end);
        }
        free
    });
    all
}

/// The old text with what is kept and a part of the repairs, if these repair.
fn attempt(
    old: &str,
    fixes: &[Repair],
    part: Range<usize>,
    kept: &BTreeSet<usize>,
    now: &Looked,
    look: &dyn Fn(&str) -> Looked,
) -> Option<Looked> {
    let mut codes: BTreeMap<&str, usize> = BTreeMap::new();
    let (mut text, mut at) = (String::with_capacity(old.len()), 0);
    let made = fixes.iter().enumerate().filter(|(i, _)| part.contains(i) || kept.contains(i));
    for (i, (code, fix)) in made {
        // A repair that does not fit the text is none.
        old.get(fix.span.clone())?;
        text.push_str(old.get(at..fix.span.start)?);
        text.push_str(&fix.text);
        at = fix.span.end;
        if part.contains(&i) {
            *codes.entry(code).or_default() += 1;
        }
    }
    text.push_str(old.get(at..)?);
    let next = look(&text);
    let gone = codes.iter().all(|(code, n)| next.of(code) + n <= now.of(code));
    (gone && next.errors() <= now.errors() && next.broken <= now.broken).then_some(next)
}

/// What changes in a file, as `diff -u` shows it.
fn difference(path: &Path, old: &str, new: &str) -> String {
    let name = printable_path(path);
    let diff = TextDiff::from_lines(old, new);
    let text =
        diff.unified_diff().context_radius(3).header(&format!("a/{name}"), &format!("b/{name}")).to_string();
    text.split('\n').map(printable).collect::<Vec<_>>().join("\n")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rules::UNKNOWN_KEY;

    /// Every `x` is wrong and is repaired to `o`; an `o` behind a `!` is worse.
    fn look(text: &str) -> Looked {
        let wrong = text.match_indices('x');
        let mut findings: Vec<Finding> =
            wrong.map(|(at, _)| Finding::new(UNKNOWN_KEY, at..at + 1, "x").fix(at..at + 1, "o")).collect();
        let worse = text.match_indices("!o").count();
        findings.extend((0..worse).flat_map(|_| {
            [Finding::error(UNKNOWN_KEY, 0..0, "worse"), Finding::error(UNKNOWN_KEY, 0..0, "worse")]
        }));
        Looked { text: text.to_string(), findings, broken: 0 }
    }

    #[test]
    fn what_repairs_is_kept_and_what_makes_it_worse_is_not() {
        assert_eq!(repair(look("a x b x"), false, &look), ("a o b o".to_string(), 2));
        assert_eq!(repair(look("x !x x"), false, &look), ("o !x o".to_string(), 2));
        assert_eq!(repair(look("!x"), false, &look), ("!x".to_string(), 0));
    }

    /// Of 256 repairs with three bad ones all others are made, in about as many looks as halving takes: one by one would be 256.
    #[test]
    fn bad_repairs_are_found_by_halves() {
        let mut text = "x ".repeat(256);
        for bad in [400, 222, 0] {
            text.insert(bad, '!');
        }
        let looks = std::cell::Cell::new(0);
        let counted = |text: &str| {
            looks.set(looks.get() + 1);
            look(text)
        };
        let (new, made) = repair(look(&text), false, &counted);
        assert_eq!((new.matches('o').count(), new.matches("!x").count(), made), (253, 3, 253));
        // Three ways of eight halvings, and once more to see that nothing is left.
        assert!(looks.get() <= 2 * 3 * 8 + 1 + 2 * 3, "{}", looks.get());
        // One that does not fit spoils none of the others.
        let fixes = [("a", Fix::safe(0..1, "o")), ("a", Fix::safe(9..12, "o"))];
        let mut now = look("x b");
        let mut kept = BTreeSet::new();
        keep("x b", &fixes.map(|(_, fix)| (UNKNOWN_KEY.code, fix)), 0..2, &mut kept, &mut now, &look);
        assert_eq!((now.text.as_str(), kept.len()), ("o b", 1));
    }
}
