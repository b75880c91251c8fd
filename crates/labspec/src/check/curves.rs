//! What the labs show in the runs that the claims of a lesson rest on, for a report that draws it.

use super::claims;
use super::resolved_labs::record_curves;
use crate::bind::scene::Models;
use crate::spec::Lesson;
use crate::verify::{Curves, Stage};
use std::ops::Range;

/// Most runs of one claim that are drawn.
const RUNS: usize = 24;

/// The runs of one `verify` object.
#[derive(Clone, Debug, PartialEq)]
pub struct Drawn {
    /// The bytes of the object.
    pub span: Range<usize>,
    /// What the traces show in each run; no more runs than a page can show.
    pub runs: Vec<Curves>,
}

/// Makes the runs of every claim once more and records what the plots of its lab show.
pub fn curves(lesson: &Lesson, models: &Models) -> Vec<Drawn> {
    let ready = super::of_claims(lesson, models);
    let stage = Stage::new(models);
    let owners = claims::owners(lesson).into_iter();
    let drawn = owners.filter_map(|(_, owner)| {
        let (verify, lab, _) = owner.claim(lesson)?;
        let runs = record_curves(lesson, &ready, verify, lab, &stage, RUNS);
        (!runs.is_empty()).then(|| Drawn { span: verify.span.clone(), runs })
    });
    drawn.collect()
}
