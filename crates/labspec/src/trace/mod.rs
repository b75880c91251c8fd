//! Where the numbers of a lesson come from: `labspec trace`.
//!
//! | stage | module |
//! |---|---|
//! | the numbers that a reader sees | `verify::stated` |
//! | runs that the text names: settings of controls, presses, timesteps | `trials` |
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
mod trials;

pub use propose::blocks;
pub use rank::{Hit, Origin};

use crate::bind::scene::Models;
use crate::check;
use crate::source::{SourceMap, Text};
use crate::spec::{Lab, LabAddress, Lesson};
use crate::verify::{Allowance, Stated, stated};
use candidates::Candidate;
use std::ops::Range;
use trials::Trial;

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
    let allowance = Allowance::default();
    let mut labs = Vec::new();
    for (address, lab) in lesson.addressed() {
        tell(&format!("trying lab {address}"));
        let Some((model, programs, _)) = check::bind(lab, models, &mut Vec::new()) else { continue };
        let questions = lesson.quizzes.iter().flat_map(|quiz| quiz.numbered());
        let owner = questions.map(|(_, q)| q.span.clone()).find(|span| span.contains(&lab.span.start));
        let trials = trials::trials(lab, &numbers);
        let candidates = candidates::candidates(lab, &model, &programs, &numbers);
        let values =
            trials.iter().map(|t| trials::values(t, lab, &model, &programs, &candidates, &allowance));
        let values = values.collect();
        labs.push(Tried { address, lab, owner, trials, candidates, values });
    }
    let bindings = formula::bindings(&numbers);
    let found = |s: &Stated| rank::origin(s, &numbers, &labs, &bindings);
    let mut origins: Vec<Origin> = numbers.iter().map(found).collect();
    rank::share(&numbers, &mut origins);
    let numbers =
        numbers.into_iter().zip(origins).map(|(stated, origin)| Traced { stated, origin }).collect();
    Traces { numbers, labs }
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
fn words(text: &str) -> impl Iterator<Item = String> + '_ {
    let parts = text.split(|c: char| !c.is_alphanumeric()).filter(|w| w.chars().count() > 2);
    parts.map(str::to_lowercase)
}
