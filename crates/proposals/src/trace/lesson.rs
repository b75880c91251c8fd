//! The trace of all numbers of a lesson.

use super::formula::bindings;
use super::lab::TracedLab;
use super::neighbours;
use super::origin::Origin;
use super::rank;
use super::tables::{TracedTable, tables};
use labspec::bind::scene::Models;
use labspec::interrupt;
use labspec::markdown::BlockKind;
use labspec::spec::{LabAddress, Lesson};
use labspec::verify::{HALVED, PERTURBED_BACK, PERTURBED_START, RunCache, Stated, answered, claimed, stated};
use std::collections::BTreeMap;
use std::ops::Range;

/// A number and its origin.
#[derive(Clone, Debug)]
pub struct Traced {
    /// The number.
    pub stated: Stated,
    /// The origin.
    pub origin: Origin,
}

/// The results for a lesson.
pub struct Traces<'l> {
    /// All numbers with a unit, in the order of the text.
    pub numbers: Vec<Traced>,
    /// The labs that cannot run, or that have no value in any run: no number can be traced to them.
    pub without_values: Vec<LabAddress>,
    pub(crate) labs: Vec<TracedLab<'l>>,
    pub(crate) tables: Vec<TracedTable>,
}

/// Finds the origin of every number of a lesson. Labs that cannot run are left out. `report_progress` receives descriptions
/// of the current activity.
pub fn trace<'l>(lesson: &'l Lesson, models: &Models, report_progress: &mut dyn FnMut(&str)) -> Traces<'l> {
    let numbers = stated(lesson);
    let stage = RunCache::new(models, lesson.conventions.languages);
    let (mut labs, mut without_values) = (Vec::new(), Vec::new());
    for (address, lab) in lesson.addressed() {
        report_progress(&format!("trying lab {address}"));
        match TracedLab::measure(lesson, (address.clone(), lab), &numbers, models, &stage) {
            Some(traced) if traced.has_values() => labs.push(traced),
            _ => without_values.push(address),
        }
    }
    let bindings = bindings(&numbers);
    let claimed: Vec<Range<usize>> = claimed(lesson).into_iter().chain(answered(lesson)).collect();
    let origin_of = |s: &Stated| match interrupt::requested() {
        _ if claimed.iter().any(|span| span.start < s.span.end && s.span.start < span.end) => Origin::Claimed,
        true => Origin::Unknown,
        false => rank::origin(s, &numbers, &labs, &bindings, &rank::Siblings::default()),
    };
    let mut origins: Vec<Origin> = numbers.iter().map(origin_of).collect();
    if !interrupt::requested() {
        neighbours::compare_siblings(&numbers, &mut origins, &labs, &bindings);
        neighbours::compare_contrasts(&numbers, &mut origins, &labs, &bindings);
    }
    mark_unsteady(&numbers, &mut origins, &labs, &stage);
    neighbours::doubt_coarse(&numbers, &mut origins);
    neighbours::share_exact(&numbers, &mut origins);
    neighbours::share(&numbers, &mut origins);
    let outputs = outputs(lesson);
    for (s, origin) in numbers.iter().zip(&mut origins) {
        if let (Origin::Unknown | Origin::Chance(_), Some(line)) = (&*origin, printed_by(s, &outputs)) {
            *origin = Origin::Listed(line);
        }
    }
    let numbers =
        numbers.into_iter().zip(origins).map(|(stated, origin)| Traced { stated, origin }).collect();
    let tables = if interrupt::requested() { Vec::new() } else { tables(lesson, &labs, &stage) };
    Traces { numbers, without_values, labs, tables }
}

/// The numbers that listings print: each with the line of its output in the lesson.
fn outputs(lesson: &Lesson) -> Vec<(String, usize)> {
    let mut all = Vec::new();
    let mut follows_listing = false;
    for block in &lesson.scan.blocks {
        let BlockKind::Code { language, .. } = &block.kind else { continue };
        let is_listing = LISTINGS.contains(&language.as_str());
        if !is_listing && follows_listing {
            let line = lesson.file.position(block.span.start).line;
            let is_part = |c: char| c.is_ascii_digit() || matches!(c, '.' | 'e' | 'E');
            let numbers = block
                .body
                .value
                .split(|c: char| !is_part(c))
                .filter(|part| part.contains(|c: char| c.is_ascii_digit()));
            all.extend(numbers.map(|number| (number.to_string(), line)));
        }
        follows_listing = is_listing;
    }
    all
}

/// Languages of listings whose output is below them.
const LISTINGS: [&str; 4] = ["python", "py", "python3", "pycon"];
/// A number with fewer digits occurs in outputs by chance.
const PRINTED_DIGITS: usize = 3;

/// The line of the output that contains the digits of a number.
fn printed_by(s: &Stated, outputs: &[(String, usize)]) -> Option<usize> {
    let digits: String = s
        .quote
        .chars()
        .skip_while(|c| !c.is_ascii_digit())
        .take_while(|c| c.is_ascii_digit() || *c == '.')
        .collect();
    let significant = digits.trim_start_matches(['0', '.']).chars().filter(char::is_ascii_digit).count();
    if significant < PRINTED_DIGITS {
        return None;
    }
    outputs.iter().find(|(number, _)| *number == digits).map(|(_, line)| *line)
}

/// Repeats the runs of the origins with perturbed starts: an origin whose digits change is unsteady. One whose digits change with
/// half the timestep is fragile.
fn mark_unsteady(numbers: &[Stated], origins: &mut [Origin], labs: &[TracedLab<'_>], stage: &RunCache<'_>) {
    let mut again: BTreeMap<(usize, usize), [Vec<f64>; 3]> = BTreeMap::new();
    for (s, origin) in numbers.iter().zip(origins) {
        let Origin::From(hit) = origin else { continue };
        let mut hit = hit.clone();
        let Some((l, t)) = hit.place else { continue };
        let Some((tried, trial)) = labs.get(l).and_then(|tried| Some((tried, tried.trials.get(t)?))) else {
            continue;
        };
        let moved = again.entry((l, t)).or_insert_with(|| {
            [PERTURBED_START, PERTURBED_BACK, HALVED].map(|numerics| tried.values_of(trial, stage, numerics))
        });
        let Some(index) = tried.candidates.iter().position(|c| c.text == hit.measure) else { continue };
        let Some(nominal) = tried.values.get(t).and_then(|v| v.get(index)) else { continue };
        let differs = |other: &Vec<f64>| {
            other.get(index).is_some_and(|x| s.read.differ(hit.value, hit.value * x / nominal))
        };
        let [moves, back, halves] = moved.each_ref().map(differs);
        hit.fragile = halves;
        *origin = if moves || back { Origin::Unsteady(hit) } else { Origin::From(hit) };
    }
}

impl Traces<'_> {
    /// The address of a lab, and the description of one of its runs.
    pub fn run(&self, lab: usize, trial: usize) -> Option<(&LabAddress, &str)> {
        let tried = self.labs.get(lab)?;
        Some((&tried.address, &tried.trials.get(trial)?.words))
    }
}
