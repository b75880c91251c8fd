//! The curves of labs in the runs of the claims of a lesson, for a report that draws them.

use super::claims;
use super::resolved_labs::record_curves;
use crate::bind::scene::Models;
use crate::spec::Lesson;
use crate::verify::{Curves, RunCache};
use std::ops::Range;

/// Maximum number of drawn runs of one claim.
const RUNS: usize = 24;

/// The runs of one `verify` object.
#[derive(Clone, Debug, PartialEq)]
pub struct VerifyCurves {
    /// The bytes of the object.
    pub span: Range<usize>,
    /// The curves of each run, for at most `RUNS` runs.
    pub runs: Vec<Curves>,
}

/// Repeats the runs of every claim and records the traces of its lab.
pub fn curves(lesson: &Lesson, models: &Models) -> Vec<VerifyCurves> {
    let ready = super::of_claims(lesson, models);
    let stage = RunCache::new(models, lesson.conventions.languages);
    let owners = claims::owners(lesson).into_iter();
    let drawn = owners.filter_map(|(_, owner)| {
        let (verify, lab, _) = owner.claim(lesson)?;
        let runs = record_curves(lesson, &ready, verify, lab, &stage, RUNS);
        (!runs.is_empty()).then(|| VerifyCurves { span: verify.span.clone(), runs })
    });
    drawn.collect()
}
