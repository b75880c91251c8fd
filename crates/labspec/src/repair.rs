//! Applies repairs to a text and decides which of them are kept. The program (`check --fix`) and the editor use this
//! module.
//!
//! A repair is kept if three conditions hold. The file then has fewer findings of its rule, and no more errors or broken
//! blocks. If the repair is called safe, every trace of every lab that could run before is unchanged, bit for bit. Unsafe
//! repairs are made only on request. All repairs of a file that do not touch each other are tried at once. If they fail
//! together, the first half is tried and then the second, down to single ones. This is repeated until nothing changes.

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
use std::hash::{DefaultHasher, Hash, Hasher};
use std::ops::Range;

/// Maximum number of rounds: a repair may reveal the next one.
const ROUNDS: usize = 20;

/// Maximum number of steps of a run that proves a repair.
const STEPS: usize = 20_000;

/// The rules whose checks run the lab to test the repair.
const RULES_WITH_RUNS: [&rules::Rule; 1] = [rules::MISSING_SETCONST];

/// The displayed values of the labs of a lesson: for each lab and each run that can be made (by their indexes), a digest of the
/// samples of each trace and readout (by its index).
pub type Traces = BTreeSet<(usize, usize, usize, u64)>;

/// The displayed values of the labs of a lesson as loaded, with each control moved to its ends, and with each button
/// pressed. A lab with an error has no values, because a page does not run it, or not as written.
pub fn traces(lesson: &Lesson, models: &Models) -> Traces {
    let mut all = Traces::new();
    for (place, lab) in lesson.all_labs().into_iter().enumerate() {
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
                let mut digest = DefaultHasher::new();
                let samples = table.rows.iter().filter_map(|row| row.get(column));
                samples.for_each(|cell| written(cell).hash(&mut digest));
                all.insert((place, number, column, digest.finish()));
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

/// A sample as text, with all bits.
fn written(cell: &Cell) -> String {
    match cell {
        Cell::Number(x) if x.is_nan() => "NaN".into(),
        Cell::Number(x) => format!("{:016x}", x.to_bits()),
        other => format!("{other:?}"),
    }
}

/// A text and its findings.
#[derive(Debug)]
pub struct CheckedText {
    /// The text.
    pub text: String,
    /// Its findings, as far as they are reported.
    pub findings: Vec<Finding>,
    /// The number of its errors, reported or not.
    pub errors: usize,
    /// Number of blocks that cannot be read.
    pub broken: usize,
}

impl CheckedText {
    /// A text whose findings are all reported.
    pub fn new(text: String, findings: Vec<Finding>, broken: usize) -> CheckedText {
        let errors = findings.iter().filter(|f| f.is_error()).count();
        CheckedText { text, findings, errors, broken }
    }

    fn count_of_rule(&self, code: &str) -> usize {
        self.findings.iter().filter(|f| f.code == code).count()
    }
}

/// The functions that evaluate a text.
struct RepairJudge<'j> {
    /// Checks it.
    look: &'j dyn Fn(&str) -> CheckedText,
    /// Runs its labs.
    shows: &'j dyn Fn(&str) -> Traces,
    /// Whether safe repairs are tried, which must be proven.
    proves: bool,
}

/// A text with some repairs, and the displayed values of its labs, computed on first use.
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

/// The repaired text, and the number of repairs. `look` checks a text, `shows` returns the displayed values of its labs.
/// Safe repairs are made first and proven, then unsafe ones on request.
pub fn repair(
    current: CheckedText,
    guesses: bool,
    look: &dyn Fn(&str) -> CheckedText,
    shows: &dyn Fn(&str) -> Traces,
) -> (String, usize) {
    let mut current = TextState::new(current);
    let mut made = rounds(&mut current, Applicability::Safe, &RepairJudge { look, shows, proves: true });
    if guesses {
        made += rounds(&mut current, Applicability::Unsafe, &RepairJudge { look, shows, proves: false });
        // Safe repairs that an unsafe one revealed.
        made += rounds(&mut current, Applicability::Safe, &RepairJudge { look, shows, proves: true });
    }
    (current.looked.text, made)
}

/// Makes repairs of a kind until nothing changes; returns their number.
fn rounds(current: &mut TextState, kind: Applicability, judge: &RepairJudge<'_>) -> usize {
    let mut made = 0;
    for _ in 0..ROUNDS {
        let fixes = disjoint_repairs(&current.looked.findings, kind);
        if fixes.is_empty() || interrupted() {
            break;
        }
        let old = current.looked.text.clone();
        let mut applied = BTreeSet::new();
        keep(&old, &fixes, 0..fixes.len(), &mut applied, current, judge);
        if applied.is_empty() {
            break;
        }
        made += applied.len();
    }
    made
}

/// A repair, and the code of its rule.
type Repair = (&'static str, Fix);

/// Keeps the repairs of a part of the list that succeed: all of them if they succeed together, or else those of each half.
/// With b failing ones among n repairs, this needs about b log n checks. `current` is the old text with the repairs that are
/// kept.
fn keep(
    old: &str,
    fixes: &[Repair],
    part: Range<usize>,
    selected: &mut BTreeSet<usize>,
    current: &mut TextState,
    judge: &RepairJudge<'_>,
) {
    if part.is_empty() || interrupted() {
        return;
    }
    if let Some(next) = attempt(old, fixes, part.clone(), selected, current, judge) {
        selected.extend(part);
        *current = next;
    } else if part.len() > 1 {
        let middle = part.start + part.len() / 2;
        keep(old, fixes, part.start..middle, selected, current, judge);
        keep(old, fixes, middle..part.end, selected, current, judge);
    }
}

/// Repairs that do not touch each other, in the order of the text, with the codes of their rules.
fn disjoint_repairs(findings: &[Finding], kind: Applicability) -> Vec<Repair> {
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

/// The old text with the selected repairs and a part of the others, if these succeed.
fn attempt(
    old: &str,
    fixes: &[Repair],
    part: Range<usize>,
    selected: &BTreeSet<usize>,
    current: &TextState,
    judge: &RepairJudge<'_>,
) -> Option<TextState> {
    let mut codes: BTreeMap<&str, usize> = BTreeMap::new();
    let (mut text, mut offset) = (String::with_capacity(old.len()), 0);
    let made = fixes.iter().enumerate().filter(|(i, _)| part.contains(i) || selected.contains(i));
    for (i, (code, fix)) in made {
        // A repair whose span is outside of the text fails.
        old.get(fix.span.clone())?;
        text.push_str(old.get(offset..fix.span.start)?);
        text.push_str(&fix.text);
        offset = fix.span.end;
        if part.contains(&i) {
            *codes.entry(code).or_default() += 1;
        }
    }
    text.push_str(old.get(offset..)?);
    let next = TextState::new((judge.look)(&text));
    let (was, is) = (&current.looked, &next.looked);
    let gone = codes.iter().all(|(code, n)| is.count_of_rule(code) + n <= was.count_of_rule(code));
    if !gone || is.errors > was.errors || is.broken > was.broken {
        return None;
    }
    let shown_by_a_run = codes.keys().all(|code| RULES_WITH_RUNS.iter().any(|rule| rule.code == *code));
    let proven = !judge.proves || shown_by_a_run || current.displayed(judge).is_subset(next.displayed(judge));
    proven.then_some(next)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rules::UNKNOWN_KEY;

    /// Every `x` is an error and is repaired to `o`; an `o` after a `!` is worse.
    fn find_wrong(text: &str) -> CheckedText {
        let wrong = text.match_indices('x');
        let mut findings: Vec<Finding> = wrong
            .map(|(offset, _)| {
                Finding::new(UNKNOWN_KEY, offset..offset + 1, "x").fix(offset..offset + 1, "o")
            })
            .collect();
        let worse = text.match_indices("!o").count();
        findings.extend((0..worse).flat_map(|_| {
            [Finding::error(UNKNOWN_KEY, 0..0, "worse"), Finding::error(UNKNOWN_KEY, 0..0, "worse")]
        }));
        CheckedText::new(text.to_string(), findings, 0)
    }

    #[test]
    fn successful_repairs_are_kept_and_harmful_ones_are_not() {
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
    fn a_repair_that_changes_displayed_values_is_not_safe() {
        // Only the first character is displayed.
        let shows = |text: &str| Traces::from([(0, 0, 0, text.chars().next().map_or(0, u64::from))]);
        assert_eq!(repair(find_wrong("x x"), false, &find_wrong, &shows), ("x o".to_string(), 1));
        assert_eq!(repair(find_wrong("a x"), false, &find_wrong, &shows), ("a o".to_string(), 1));
    }

    /// With three failing ones among 256 repairs, all others are made, with the number of checks of a bisection; one by one
    /// would need 256.
    #[test]
    fn bad_repairs_are_found_by_bisection() {
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
        // Three paths of eight bisections, and once more to see that nothing is left.
        assert!(looks.get() <= 2 * 3 * 8 + 1 + 2 * 3, "{}", looks.get());
        // A repair outside of the text does not affect the others.
        let fixes = [("a", Fix::safe(0..1, "o")), ("a", Fix::safe(9..12, "o"))];
        let mut current = TextState::new(find_wrong("x b"));
        let judge = RepairJudge { look: &find_wrong, shows: &|_| Traces::new(), proves: true };
        let mut selected = BTreeSet::new();
        keep(
            "x b",
            &fixes.map(|(_, fix)| (UNKNOWN_KEY.code, fix)),
            0..2,
            &mut selected,
            &mut current,
            &judge,
        );
        assert_eq!((current.looked.text.as_str(), selected.len()), ("o b", 1));
    }
}
