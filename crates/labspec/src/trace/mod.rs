//! Where the numbers of a lesson come from: `labspec trace`.
//!
//! | stage | module |
//! |---|---|
//! | the numbers that a reader sees | `verify::stated` |
//! | what the lesson claims already | `verify::claimed`, `verify::answered` |
//! | runs that the text names: settings of controls, presses, timesteps | `trials` |
//! | the same with what the lab's setup changed of the model put back | `restored` |
//! | what could be measured in each: readouts, traces, contacts, constants of the model | `candidates` |
//! | formulas that stand before the number itself | `formula` |
//! | which of all that is simplest, and whether chance explains it | `rank` |
//! | what an author takes over | `propose` |
//!
//! A number is traced when a simple measure of a run that the text speaks of has the digits that are printed, and when so few
//! things were tried before it that chance does not explain it.

mod candidates;
mod formula;
mod propose;
mod rank;
mod restored;
mod trials;

pub(crate) use candidates::Candidate;
pub(crate) use propose::Block;
pub use propose::{blocks, laid_out};
pub use rank::{Hit, Origin};
pub(crate) use trials::{Trial, si, trials};

use crate::bind::Programs;
use crate::bind::scene::Models;
use crate::check;
use crate::interrupt;
use crate::run::StepVariant;
use crate::source::{SourceMap, Text};
use crate::spec::{Lab, LabAddress, Lesson};
use crate::verify::{NUDGED, NUDGED_BACK, Stage, Stated, answered, claimed, stated};
use labspec_core::Model;
use std::collections::BTreeMap;
use std::ops::Range;
use std::sync::Arc;

/// A number, and where it comes from.
#[derive(Clone, Debug)]
pub struct Traced {
    /// The number.
    pub stated: Stated,
    /// Where it comes from.
    pub origin: Origin,
}

/// A lab with everything that was measured in it.
pub(crate) struct Tried<'l> {
    pub(crate) address: LabAddress,
    pub(crate) lab: &'l Lab,
    /// The question that it belongs to.
    pub(crate) owner: Option<Range<usize>>,
    model: Arc<Model>,
    programs: Programs,
    pub(crate) trials: Vec<Trial>,
    pub(crate) candidates: Vec<Candidate>,
    /// Value of every candidate in every trial; NaN where there is none.
    pub(crate) values: Vec<Vec<f64>>,
}

/// What was found in a lesson.
pub struct Traces<'l> {
    /// Every number with a unit, in the order of the text.
    pub numbers: Vec<Traced>,
    pub(crate) labs: Vec<Tried<'l>>,
}

/// Looks where every number of a lesson comes from. Labs that cannot run are left out. `tell` is told what is being done.
pub fn trace<'l>(lesson: &'l Lesson, models: &Models, tell: &mut dyn FnMut(&str)) -> Traces<'l> {
    let numbers = stated(lesson);
    let stage = Stage::new(models);
    let mut labs = Vec::new();
    for (address, lab) in lesson.addressed() {
        tell(&format!("trying lab {address}"));
        let Some((model, programs, _)) = check::bind(lab, models, &mut Vec::new()) else { continue };
        let questions = lesson.quizzes.iter().flat_map(|quiz| quiz.numbered());
        let owner = questions.map(|(_, q)| q.span.clone()).find(|span| span.contains(&lab.span.start));
        let trials = restored::with(trials(lab, &numbers), lab, &model, &programs);
        let candidates = candidates::candidates(lab, &model, &programs, &numbers);
        let made =
            |t: &Trial, numerics| trials::values(t, lab, &model, &programs, &candidates, &stage, numerics);
        let values = trials.iter().map(|t| made(t, StepVariant::NOMINAL)).collect();
        labs.push(Tried { address, lab, owner, model, programs, trials, candidates, values });
    }
    let bindings = formula::bindings(&numbers);
    let claimed: Vec<Range<usize>> = claimed(lesson).into_iter().chain(answered(lesson)).collect();
    let found = |s: &Stated| match interrupt::requested() {
        _ if claimed.iter().any(|at| at.start < s.span.end && s.span.start < at.end) => Origin::Claimed,
        true => Origin::Unknown,
        false => rank::origin(s, &numbers, &labs, &bindings),
    };
    let mut origins: Vec<Origin> = numbers.iter().map(found).collect();
    steady(&numbers, &mut origins, &labs, &stage);
    rank::share(&numbers, &mut origins);
    let numbers =
        numbers.into_iter().zip(origins).map(|(stated, origin)| Traced { stated, origin }).collect();
    Traces { numbers, labs }
}

/// Tries what was found again, from starts that nobody could tell from the lab's own: digits that then change are told apart.
fn steady(numbers: &[Stated], origins: &mut [Origin], labs: &[Tried<'_>], stage: &Stage<'_>) {
    let mut again: BTreeMap<(usize, usize), [Vec<f64>; 2]> = BTreeMap::new();
    for (s, origin) in numbers.iter().zip(origins) {
        let Origin::From(hit) = origin else { continue };
        let Some((l, t)) = hit.place else { continue };
        let Some((tried, trial)) = labs.get(l).and_then(|tried| Some((tried, tried.trials.get(t)?))) else {
            continue;
        };
        let moved = again
            .entry((l, t))
            .or_insert_with(|| [NUDGED, NUDGED_BACK].map(|numerics| tried.values_of(trial, stage, numerics)));
        let Some(at) = tried.candidates.iter().position(|c| c.text == hit.measure) else { continue };
        let Some(own) = tried.values.get(t).and_then(|v| v.get(at)) else { continue };
        let differs =
            |other: &Vec<f64>| other.get(at).is_some_and(|x| s.read.differ(hit.value, hit.value * x / own));
        if moved.iter().any(differs) {
            *origin = Origin::Unsteady(hit.clone());
        }
    }
}

impl Tried<'_> {
    /// Makes a run of the lab, and takes every measure. What breaks has no values.
    pub(crate) fn values_of(&self, trial: &Trial, stage: &Stage<'_>, numerics: StepVariant) -> Vec<f64> {
        let Tried { lab, model, programs, candidates, .. } = self;
        trials::values(trial, lab, model, programs, candidates, stage, numerics)
    }
}

impl Traces<'_> {
    /// The address of a lab, and what is done in one of its runs.
    pub fn run(&self, lab: usize, trial: usize) -> Option<(&LabAddress, &str)> {
        let tried = self.labs.get(lab)?;
        Some((&tried.address, &tried.trials.get(trial)?.words))
    }
}

/// A text that stands nowhere.
fn text(value: &str) -> Text {
    Text { value: value.to_string(), map: SourceMap::point(0) }
}

/// The words of a text, in small letters, that say something.
pub(crate) fn split_words(text: &str) -> impl Iterator<Item = String> + '_ {
    let parts = text.split(|c: char| !c.is_alphanumeric()).filter(|w| w.chars().count() > 2);
    parts.map(str::to_lowercase)
}
