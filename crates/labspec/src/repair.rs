//! Repairs of a text: which of them are kept. The program (`check --fix`) and the editor ask here.
//!
//! A repair is kept if the file has fewer findings of its rule afterwards, no more errors and no more broken blocks, and, when it is
//! called safe, if every trace of every lab that could be run before is the same afterwards, to the last bit. Guesses are made only
//! where they are asked for. All repairs of a file that do not touch each other are tried at once; if they do not go together, the
//! first half and then the second, and so on down to single ones; and again, until nothing changes.

use crate::bind::scene::Models;
use crate::check;
use crate::finding::{Applicability, Finding, Fix};
use crate::interrupt::requested as interrupted;
use crate::rules;
use crate::run::{self, Cell, RunOptions};
use crate::spec::{ControlKind, Lab, Lesson};
use labspec_expr::Value;
use std::cell::OnceCell;
use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;

/// Rounds at most: a repair may make the next one visible.
const ROUNDS: usize = 20;

/// Steps of a run that proves a repair.
const STEPS: usize = 300;

/// The rules whose finding has made the run that shows what the repair changes.
const SHOWN_BY_A_RUN: [&rules::Rule; 1] = [rules::MISSING_SETCONST];

/// What the labs of a lesson show: of each run that can be made (by its number) the samples of each trace and readout (by its
/// number), to the last bit.
pub type Traces = BTreeSet<(usize, usize, Vec<String>)>;

/// What the labs of a lesson show as they start, with each control moved to its ends, and with each button pressed. A lab with an
/// error in it shows nothing: a page does not run it, or not as it is written.
pub fn traces(lesson: &Lesson, models: &Models) -> Traces {
    let mut all = Traces::new();
    for lab in lesson.all_labs() {
        let inside = |f: &Finding| lab.span.start <= f.span.start && f.span.end <= lab.span.end;
        if lesson.findings.iter().any(|f| f.is_error() && inside(f)) {
            continue;
        }
        let Some((model, programs, 0)) = check::bind(lab, models, &mut Vec::new()) else { continue };
        let Ok(steps) = run::count_steps(lab, None, None, model.opt.timestep) else { continue };
        for (number, options) in runs(lab).into_iter().enumerate() {
            let options = RunOptions { steps: Some(steps.min(STEPS)), ..options };
            let Ok(table) = run::run(lab, &model, &programs, &options) else { continue };
            for column in 0..table.columns.len() {
                let samples = table.rows.iter().filter_map(|row| row.get(column)).map(written).collect();
                all.insert((number, column, samples));
            }
        }
    }
    all
}

/// The runs of a lab.
fn runs(lab: &Lab) -> Vec<RunOptions> {
    let mut all = vec![RunOptions::default()];
    for control in &lab.controls {
        let label = &control.label.value;
        let mut set = |value: Value| {
            all.push(RunOptions { set: vec![(label.clone(), value)], ..RunOptions::default() });
        };
        match &control.kind {
            ControlKind::Slider { min, max, .. } => {
                set(Value::Number(min.value));
                set(Value::Number(max.value));
            }
            ControlKind::Select { options, .. } => {
                options.iter().for_each(|choice| set(Value::from(choice.text.value.as_str())));
            }
            ControlKind::Button { .. } => {
                all.push(RunOptions { press: vec![(label.clone(), 0.0)], ..RunOptions::default() });
            }
        }
    }
    all
}

/// A sample as text, every bit of it.
fn written(cell: &Cell) -> String {
    match cell {
        Cell::Number(x) if x.is_nan() => "NaN".into(),
        Cell::Number(x) => format!("{:016x}", x.to_bits()),
        other => format!("{other:?}"),
    }
}

/// A text, and what is found in it.
#[derive(Debug)]
pub struct CheckedText {
    /// The text.
    pub text: String,
    /// What is found.
    pub findings: Vec<Finding>,
    /// How many blocks cannot be read.
    pub broken: usize,
}

impl CheckedText {
    fn errors(&self) -> usize {
        self.findings.iter().filter(|f| f.is_error()).count()
    }

    fn count_of_rule(&self, code: &str) -> usize {
        self.findings.iter().filter(|f| f.code == code).count()
    }
}

/// How a text is judged.
struct RepairJudge<'j> {
    /// What is wrong with it.
    look: &'j dyn Fn(&str) -> CheckedText,
    /// What its labs show.
    shows: &'j dyn Fn(&str) -> Traces,
    /// Whether safe repairs are tried, which have to be proven.
    proves: bool,
}

/// A text with some repairs made, and what its labs show, once somebody asks.
struct TextState {
    looked: CheckedText,
    displayed: OnceCell<Traces>,
}

impl TextState {
    fn new(looked: CheckedText) -> TextState {
        TextState { looked, displayed: OnceCell::new() }
    }

    fn displayed(&self, judge: &RepairJudge<'_>) -> &Traces {
        self.displayed.get_or_init(|| (judge.shows)(&self.looked.text))
    }
}

/// The repaired text, and how many repairs that took. `look` finds what is wrong with a text, `shows` gives what its labs show. Safe
/// repairs are made first and proven; then guesses, where they are asked for.
pub fn repair(
    now: CheckedText,
    guesses: bool,
    look: &dyn Fn(&str) -> CheckedText,
    shows: &dyn Fn(&str) -> Traces,
) -> (String, usize) {
    let mut now = TextState::new(now);
    let mut made = rounds(&mut now, Applicability::Safe, &RepairJudge { look, shows, proves: true });
    if guesses {
        made += rounds(&mut now, Applicability::Unsafe, &RepairJudge { look, shows, proves: false });
        // What a guess has made visible.
        made += rounds(&mut now, Applicability::Safe, &RepairJudge { look, shows, proves: true });
    }
    (now.looked.text, made)
}

/// Makes repairs of a kind until nothing changes; gives how many.
fn rounds(now: &mut TextState, kind: Applicability, judge: &RepairJudge<'_>) -> usize {
    let mut made = 0;
    for _ in 0..ROUNDS {
        let fixes = apart(&now.looked.findings, kind);
        if fixes.is_empty() || interrupted() {
            break;
        }
        let old = now.looked.text.clone();
        let mut applied = BTreeSet::new();
        keep(&old, &fixes, 0..fixes.len(), &mut applied, now, judge);
        if applied.is_empty() {
            break;
        }
        made += applied.len();
    }
    made
}

/// A repair, and the code of its rule.
type Repair = (&'static str, Fix);

/// Keeps the repairs of a part of the list that repair: all of them if they go together, or else what can be kept of each half. Of
/// n repairs with b bad ones that takes about b log n looks. `now` is the old text with those that are kept.
fn keep(
    old: &str,
    fixes: &[Repair],
    part: Range<usize>,
    selected: &mut BTreeSet<usize>,
    now: &mut TextState,
    judge: &RepairJudge<'_>,
) {
    if part.is_empty() || interrupted() {
        return;
    }
    if let Some(next) = attempt(old, fixes, part.clone(), selected, now, judge) {
        selected.extend(part);
        *now = next;
    } else if part.len() > 1 {
        let middle = part.start + part.len() / 2;
        keep(old, fixes, part.start..middle, selected, now, judge);
        keep(old, fixes, middle..part.end, selected, now, judge);
    }
}

/// Repairs that do not touch each other, in the order of the text, with the codes of their rules.
fn apart(findings: &[Finding], kind: Applicability) -> Vec<Repair> {
    let may = |fix: &Fix| fix.applicability == kind;
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
    selected: &BTreeSet<usize>,
    now: &TextState,
    judge: &RepairJudge<'_>,
) -> Option<TextState> {
    let mut codes: BTreeMap<&str, usize> = BTreeMap::new();
    let (mut text, mut at) = (String::with_capacity(old.len()), 0);
    let made = fixes.iter().enumerate().filter(|(i, _)| part.contains(i) || selected.contains(i));
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
    let next = TextState::new((judge.look)(&text));
    let (was, is) = (&now.looked, &next.looked);
    let gone = codes.iter().all(|(code, n)| is.count_of_rule(code) + n <= was.count_of_rule(code));
    if !gone || is.errors() > was.errors() || is.broken > was.broken {
        return None;
    }
    let shown_by_a_run = codes.keys().all(|code| SHOWN_BY_A_RUN.iter().any(|rule| rule.code == *code));
    let proven = !judge.proves || shown_by_a_run || now.displayed(judge).is_subset(next.displayed(judge));
    proven.then_some(next)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rules::UNKNOWN_KEY;

    /// Every `x` is wrong and is repaired to `o`; an `o` behind a `!` is worse.
    fn find_wrong(text: &str) -> CheckedText {
        let wrong = text.match_indices('x');
        let mut findings: Vec<Finding> =
            wrong.map(|(at, _)| Finding::new(UNKNOWN_KEY, at..at + 1, "x").fix(at..at + 1, "o")).collect();
        let worse = text.match_indices("!o").count();
        findings.extend((0..worse).flat_map(|_| {
            [Finding::error(UNKNOWN_KEY, 0..0, "worse"), Finding::error(UNKNOWN_KEY, 0..0, "worse")]
        }));
        CheckedText { text: text.to_string(), findings, broken: 0 }
    }

    #[test]
    fn what_repairs_is_kept_and_what_makes_it_worse_is_not() {
        assert_eq!(
            repair(find_wrong("a x b x"), false, &find_wrong, &|_| Traces::new()),
            ("a o b o".to_string(), 2)
        );
        assert_eq!(
            repair(find_wrong("x !x x"), false, &find_wrong, &|_| Traces::new()),
            ("o !x o".to_string(), 2)
        );
        assert_eq!(repair(find_wrong("!x"), false, &find_wrong, &|_| Traces::new()), ("!x".to_string(), 0));
    }

    #[test]
    fn a_safe_repair_that_changes_what_is_shown_is_not_made() {
        // Only the first letter is shown.
        let shows = |text: &str| Traces::from([(0, 0, vec![text.chars().take(1).collect()])]);
        assert_eq!(repair(find_wrong("x x"), false, &find_wrong, &shows), ("x o".to_string(), 1));
        assert_eq!(repair(find_wrong("a x"), false, &find_wrong, &shows), ("a o".to_string(), 1));
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
            find_wrong(text)
        };
        let (new, made) = repair(find_wrong(&text), false, &counted, &|_| Traces::new());
        assert_eq!((new.matches('o').count(), new.matches("!x").count(), made), (253, 3, 253));
        // Three ways of eight halvings, and once more to see that nothing is left.
        assert!(looks.get() <= 2 * 3 * 8 + 1 + 2 * 3, "{}", looks.get());
        // One that does not fit spoils none of the others.
        let fixes = [("a", Fix::safe(0..1, "o")), ("a", Fix::safe(9..12, "o"))];
        let mut now = TextState::new(find_wrong("x b"));
        let judge = RepairJudge { look: &find_wrong, shows: &|_| Traces::new(), proves: true };
        let mut selected = BTreeSet::new();
        keep("x b", &fixes.map(|(_, fix)| (UNKNOWN_KEY.code, fix)), 0..2, &mut selected, &mut now, &judge);
        assert_eq!((now.looked.text.as_str(), selected.len()), ("o b", 1));
    }
}
