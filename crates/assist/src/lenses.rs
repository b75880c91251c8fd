//! What stands above a line of a lesson: the values that the last check measured in a run, how a lab ran, and whether its
//! numbers are claimed.
//!
//! Values are stored under the text of their block and of what the block names: after a change elsewhere they are still
//! true, and after a change in the block they are not shown.

use super::check::{block_key, units};
use labspec::check::{Checked, Claim, RanLab};
use labspec::source::Text;
use labspec::spec::{FileKind, Lab, Lesson, Verify, kind_of};
use labspec::verify::{Measured, counted};
use labspec_expr::to_fixed;
use std::collections::BTreeMap;
use std::ops::Range;
use std::path::Path;

/// The maximum number of measures of a line.
const MOST_MEASURES: usize = 8;
/// The number of significant digits of a value.
const DIGITS: i32 = 3;
/// Very long lessons are not searched for numbers.
const MAX_LESSON: usize = 2 << 20;

/// What the runs of a lesson gave, by the text of each block.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct RunValues(BTreeMap<String, Vec<(usize, String)>>);

/// What is said about a place.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum LensKind {
    /// The result of the last check.
    Result(String),
    /// No check has run this text.
    NotRun,
    /// A line of the text has this many numbers without a claim.
    Unclaimed(usize),
}

/// A text above the line of a place.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Lens {
    /// The bytes of the place.
    pub span: Range<usize>,
    /// What is said.
    pub kind: LensKind,
}

/// A lab, or a run of a claim.
enum RunPlace<'l> {
    Lab(&'l Lab),
    /// A run by its name, and whether it is the only one of its claim.
    Run(&'l Verify, &'l Text, bool),
    /// The only run of a claim that names none.
    Whole(&'l Verify),
}

impl RunPlace<'_> {
    fn span(&self) -> Range<usize> {
        match self {
            RunPlace::Lab(lab) => lab.span.clone(),
            RunPlace::Run(_, name, _) => name.span(),
            RunPlace::Whole(verify) => verify.span.clone(),
        }
    }
}

/// The labs and runs of a lesson, in order.
fn run_places(lesson: &Lesson) -> Vec<RunPlace<'_>> {
    let mut all: Vec<RunPlace<'_>> =
        lesson.addressed().into_iter().map(|(_, lab)| RunPlace::Lab(lab)).collect();
    for verify in lesson.verifies() {
        // A comparison has a run for each of its integrators, which its text need not name.
        let named = verify.runs.iter().filter(|run| within(&run.name.span(), &verify.span));
        let alone = verify.runs.len() == 1;
        let before = all.len();
        all.extend(named.map(|run| RunPlace::Run(verify, &run.name, alone)));
        if all.len() == before && !verify.measure.is_empty() {
            all.push(RunPlace::Whole(verify));
        }
    }
    all.sort_by_key(|place| place.span().start);
    all
}

fn within(span: &Range<usize>, outer: &Range<usize>) -> bool {
    outer.start <= span.start && span.end <= outer.end
}

/// The results of a check with all runs.
pub fn run_values(checked: &Checked) -> RunValues {
    let lesson = &checked.lesson;
    let places = run_places(lesson);
    let mut all = RunValues::default();
    for unit in units(lesson) {
        let inside = places.iter().filter(|place| within(&place.span(), &unit));
        let results =
            inside.filter_map(|place| Some((place.span().start - unit.start, result(checked, place)?)));
        all.0.insert(block_key(lesson, &unit), results.collect());
    }
    all
}

/// The result of a lab or a run.
fn result(checked: &Checked, place: &RunPlace<'_>) -> Option<String> {
    let of_claim = |verify: &Verify| checked.claims.iter().find(|claim| claim.span == verify.span);
    match place {
        RunPlace::Lab(lab) => {
            let ran = |ran: &&RanLab| checked.lesson.lab(&ran.address).is_some_and(|l| l.span == lab.span);
            checked.labs.iter().find(ran).map(describe_lab)
        }
        RunPlace::Run(verify, name, alone) => of_claim(verify).map(|claim| describe_run(claim, name, *alone)),
        RunPlace::Whole(verify) => of_claim(verify).map(|claim| match &claim.judgement.unmade {
            Some(reason) => reason.clone(),
            None => describe_measures(claim.judgement.measures.iter().map(|m| (m.name.as_str(), m))),
        }),
    }
}

fn describe_lab(ran: &RanLab) -> String {
    match ran.tried.as_ref().filter(|_| ran.ran) {
        None => "the lab could not run".to_string(),
        Some(tried) => {
            let breaks = if tried.broke { ", it breaks" } else { "" };
            let plural = if tried.runs == 1 { "" } else { "s" };
            format!("{} run{plural}{breaks}", tried.runs)
        }
    }
}

/// The measures of a run: `fall: touch 0.452 s, speed 4.43 m/s`.
fn describe_run(claim: &Claim, name: &Text, alone: bool) -> String {
    let judgement = &claim.judgement;
    if let Some(reason) = &judgement.unmade {
        return format!("{}: {reason}", name.value);
    }
    if let Some(how) = judgement.runs.iter().find(|r| r.span == name.span()).and_then(|r| r.broke.as_ref()) {
        return format!("{} breaks: {how}", name.value);
    }
    let prefix = format!("{}.", name.value);
    let of_run = judgement.measures.iter().filter_map(|m| match m.name.strip_prefix(&prefix) {
        Some(short) => Some((short, m)),
        None => alone.then_some((m.name.as_str(), m)),
    });
    format!("{}: {}", name.value, describe_measures(of_run))
}

/// The values by name. The members of a sweep, `touch[0]`, `touch[1]`, are one list.
fn describe_measures<'m>(measures: impl Iterator<Item = (&'m str, &'m Measured)>) -> String {
    let mut lists: Vec<(&str, Vec<String>, &str)> = Vec::new();
    for (name, measured) in measures {
        let name = name.split('[').next().unwrap_or(name);
        let value = short(measured.value);
        match lists.last_mut().filter(|(last, ..)| *last == name) {
            Some((_, values, _)) => values.push(value),
            None => lists.push((name, vec![value], &measured.unit)),
        }
    }
    let more = lists.len().saturating_sub(MOST_MEASURES);
    let one = |(name, values, unit): &(&str, Vec<String>, &str)| {
        let values = match values.as_slice() {
            [first, .., last] if values.len() > DIGITS as usize => format!("{first} … {last}"),
            all => all.join(", "),
        };
        let space = if unit.is_empty() { "" } else { " " };
        format!("{name} {values}{space}{unit}")
    };
    let mut parts: Vec<String> = lists.iter().take(MOST_MEASURES).map(one).collect();
    if more > 0 {
        parts.push(format!("{more} more"));
    }
    if parts.is_empty() { "no measures".to_string() } else { parts.join(", ") }
}

/// A number with three significant digits.
fn short(x: f64) -> String {
    if x.is_nan() {
        return "no value".to_string();
    }
    if x == 0.0 || !x.is_finite() {
        return x.to_string();
    }
    let exponent = x.abs().log10().floor() as i32;
    if !(-4..=6).contains(&exponent) {
        return format!("{x:.2e}");
    }
    to_fixed(x, (DIGITS - 1 - exponent).max(0) as usize)
}

/// The lenses of a lesson about its runs, in order.
pub fn run_lenses(lesson: &Lesson, values: &RunValues) -> Vec<Lens> {
    let places = run_places(lesson);
    let mut all = Vec::new();
    for unit in units(lesson) {
        let stored = values.0.get(&block_key(lesson, &unit));
        for place in places.iter().filter(|place| within(&place.span(), &unit)) {
            let span = place.span();
            let result =
                stored.and_then(|all| all.iter().find(|(offset, _)| unit.start + offset == span.start));
            let kind = match (result, stored) {
                (Some((_, text)), _) => LensKind::Result(text.clone()),
                // It has been checked, and there is nothing to say.
                (None, Some(_)) => continue,
                (None, None) => LensKind::NotRun,
            };
            all.push(Lens { span, kind });
        }
    }
    all.sort_by_key(|lens| lens.span.start);
    all.dedup_by_key(|lens| lens.span.start);
    all
}

/// The spans of the numbers of the text that no claim covers, outside of labs and quizzes, in order. Only a lesson in
/// Markdown with a lab can claim them beside the text.
pub fn unclaimed_numbers(lesson: &Lesson) -> Vec<Range<usize>> {
    let file = &lesson.file;
    let is_lesson = kind_of(Path::new(&**file.path())) == FileKind::Lesson;
    if !is_lesson || lesson.labs.is_empty() || file.text().len() > MAX_LESSON {
        return Vec::new();
    }
    let numbers = counted(lesson).left.into_iter().filter(|s| !s.answer).map(|s| s.span);
    let is_prose = |span: &Range<usize>| {
        let labs = lesson.labs.iter().map(|lab| &lab.span);
        !labs.chain(lesson.quizzes.iter().map(|quiz| &quiz.span)).any(|block| within(span, block))
    };
    numbers.filter(is_prose).collect()
}

/// One lens for each line with numbers that no claim covers.
pub fn unclaimed_lenses(lesson: &Lesson) -> Vec<Lens> {
    let mut all: Vec<(usize, Lens)> = Vec::new();
    for span in unclaimed_numbers(lesson) {
        let line = lesson.file.position(span.start).line;
        match all.last_mut().filter(|(last, _)| *last == line) {
            Some((_, Lens { kind: LensKind::Unclaimed(count), .. })) => *count += 1,
            _ => all.push((line, Lens { span, kind: LensKind::Unclaimed(1) })),
        }
    }
    all.into_iter().map(|(_, lens)| lens).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use labspec::lint::{ModelFolder, load_lesson};
    use labspec::source::SourceFile;

    #[test]
    fn values_are_short() {
        for (x, text) in [
            (0.4523, "0.452"),
            (4.4294, "4.43"),
            (-12.345, "-12.3"),
            (1234.5, "1235"),
            (0.0, "0"),
            (1e-7, "1.00e-7"),
            (2.5e9, "2.50e9"),
            (f64::NAN, "no value"),
            (f64::INFINITY, "inf"),
        ] {
            assert_eq!(short(x), text);
        }
    }

    #[test]
    fn the_members_of_a_sweep_are_one_list() {
        let measured = |name: &str, value: f64, unit: &str| Measured {
            name: name.to_string(),
            value,
            halved: None,
            unit: unit.to_string(),
        };
        let all = [
            measured("touch", 0.4523, "s"),
            measured("speed[0]", 1.0, "m/s"),
            measured("speed[1]", 2.0, "m/s"),
            measured("far[0]", 1.0, ""),
            measured("far[1]", 2.0, ""),
            measured("far[2]", 3.0, ""),
            measured("far[3]", 4.0, ""),
        ];
        let text = describe_measures(all.iter().map(|m| (m.name.as_str(), m)));
        assert_eq!(text, "touch 0.452 s, speed 1.00, 2.00 m/s, far 1.00 … 4.00");
        assert_eq!(describe_measures(std::iter::empty()), "no measures");
    }

    #[test]
    fn numbers_of_one_line_are_one_lens() {
        let text =
            "It falls 1 m in 0.45 s.\n\n```lab\n{\"model\": \"a\", \"title\": \"9 m\"}\n```\n\nThen 3 m.\n";
        let lesson = load_lesson(SourceFile::new("a.md", text), &ModelFolder::unknown());
        let all = unclaimed_lenses(&lesson);
        let kinds: Vec<_> =
            all.iter().map(|lens| (lesson.file.slice(lens.span.clone()), &lens.kind)).collect();
        assert_eq!(kinds, [("1 m", &LensKind::Unclaimed(2)), ("3 m", &LensKind::Unclaimed(1))]);
        let runs = run_lenses(&lesson, &RunValues::default());
        assert_eq!(runs.iter().map(|lens| &lens.kind).collect::<Vec<_>>(), [&LensKind::NotRun]);
        // Without a lab, nothing can be claimed.
        let prose = load_lesson(SourceFile::new("a.md", "It falls 1 m."), &ModelFolder::unknown());
        assert!(unclaimed_lenses(&prose).is_empty());
    }
}
