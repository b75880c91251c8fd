//! The names that claims of a `verify` object can read, from its text alone, for an editor: the object may have errors, and
//! its runs are not bound.

use super::layout::{NumberLayout, RunShape};
use super::outcome::SweepMember;
use super::outcome_names::OutcomeNames;
use crate::bind::ModelNames;
use crate::spec::{Find, Run, Verify};
use labspec_expr::Schema;

/// The runs and measures of a `verify` object.
#[derive(Debug)]
pub struct ClaimNames(NumberLayout);

impl ClaimNames {
    /// The names in its options, values and quotes.
    pub fn of_claims(verify: &Verify) -> ClaimNames {
        let found = verify.find.iter().map(|find| find.name.value.clone());
        ClaimNames(NumberLayout::from_runs(&shapes(verify, &|_| true), found))
    }

    /// The names in the condition of a search, which reads a single run.
    pub fn of_search(verify: &Verify, find: &Find) -> ClaimNames {
        let is_read = |run: &Run| find.run.as_ref().is_none_or(|name| name.value == run.name.value);
        ClaimNames(NumberLayout::from_runs(&shapes(verify, &is_read), std::iter::empty()))
    }

    /// These names over those of the lab.
    pub fn over<'a>(&'a self, lab: ModelNames<'a>) -> impl Schema + 'a {
        OutcomeNames::new(&self.0, lab)
    }
}

/// The members of all runs that `is_read` accepts.
fn shapes(verify: &Verify, is_read: &dyn Fn(&Run) -> bool) -> Vec<RunShape> {
    let measures: Vec<String> = verify.measure.iter().map(|(name, _)| name.value.clone()).collect();
    if verify.runs.is_empty() {
        return vec![("run".to_string(), None, measures)];
    }
    let mut all = Vec::new();
    for run in verify.runs.iter().filter(|run| is_read(run)) {
        let name = &run.name.value;
        match run.sweep.as_ref().filter(|sweep| sweep.is_list()) {
            None => all.push((name.clone(), None, measures.clone())),
            Some(sweep) => {
                // The values do not matter for the names.
                let member = |index| SweepMember { index, values: vec![f64::NAN; sweep.axes.len()] };
                all.extend((0..sweep.count()).map(|i| (name.clone(), Some(member(i)), measures.clone())));
            }
        }
    }
    all
}
