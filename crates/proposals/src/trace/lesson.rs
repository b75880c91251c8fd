//! The trace of all numbers of a lesson.

use super::formula::bindings;
use super::lab::TracedLab;
use super::rank::{self, Origin};
use labspec::bind::scene::Models;
use labspec::interrupt;
use labspec::spec::{LabAddress, Lesson};
use labspec::verify::{PERTURBED_BACK, PERTURBED_START, RunCache, Stated, answered, claimed, stated};
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
    pub(crate) labs: Vec<TracedLab<'l>>,
}

/// Finds the origin of every number of a lesson. Labs that cannot run are left out. `report_progress` receives descriptions
/// of the current activity.
pub fn trace<'l>(lesson: &'l Lesson, models: &Models, report_progress: &mut dyn FnMut(&str)) -> Traces<'l> {
    let numbers = stated(lesson);
    let stage = RunCache::new(models);
    let mut labs = Vec::new();
    for (address, lab) in lesson.addressed() {
        report_progress(&format!("trying lab {address}"));
        labs.extend(TracedLab::measure(lesson, (address, lab), &numbers, models, &stage));
    }
    let bindings = bindings(&numbers);
    let claimed: Vec<Range<usize>> = claimed(lesson).into_iter().chain(answered(lesson)).collect();
    let origin_of = |s: &Stated| match interrupt::requested() {
        _ if claimed.iter().any(|at| at.start < s.span.end && s.span.start < at.end) => Origin::Claimed,
        true => Origin::Unknown,
        false => rank::origin(s, &numbers, &labs, &bindings),
    };
    let mut origins: Vec<Origin> = numbers.iter().map(origin_of).collect();
    mark_unsteady(&numbers, &mut origins, &labs, &stage);
    rank::share(&numbers, &mut origins);
    let numbers =
        numbers.into_iter().zip(origins).map(|(stated, origin)| Traced { stated, origin }).collect();
    Traces { numbers, labs }
}

/// Repeats the runs of the origins with perturbed starts: an origin whose digits change is unsteady.
fn mark_unsteady(numbers: &[Stated], origins: &mut [Origin], labs: &[TracedLab<'_>], stage: &RunCache<'_>) {
    let mut again: BTreeMap<(usize, usize), [Vec<f64>; 2]> = BTreeMap::new();
    for (s, origin) in numbers.iter().zip(origins) {
        let Origin::From(hit) = origin else { continue };
        let Some((l, t)) = hit.place else { continue };
        let Some((tried, trial)) = labs.get(l).and_then(|tried| Some((tried, tried.trials.get(t)?))) else {
            continue;
        };
        let moved = again.entry((l, t)).or_insert_with(|| {
            [PERTURBED_START, PERTURBED_BACK].map(|numerics| tried.values_of(trial, stage, numerics))
        });
        let Some(at) = tried.candidates.iter().position(|c| c.text == hit.measure) else { continue };
        let Some(nominal) = tried.values.get(t).and_then(|v| v.get(at)) else { continue };
        let differs = |other: &Vec<f64>| {
            other.get(at).is_some_and(|x| s.read.differ(hit.value, hit.value * x / nominal))
        };
        if moved.iter().any(differs) {
            *origin = Origin::Unsteady(hit.clone());
        }
    }
}

impl Traces<'_> {
    /// The address of a lab, and the description of one of its runs.
    pub fn run(&self, lab: usize, trial: usize) -> Option<(&LabAddress, &str)> {
        let tried = self.labs.get(lab)?;
        Some((&tried.address, &tried.trials.get(trial)?.words))
    }
}
