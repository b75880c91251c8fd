//! Counts the claims that no reference engine checks, so that "all verdicts" is not read as "all claims".

use crate::spec::Verify;
use serde::Serialize;

/// Claims that a reference engine does not check, because they depend on runs other than the recorded ones.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Unjudged {
    /// Searches: our own results are used.
    pub searches: usize,
    /// Answers over a range: only their own runs are compared, not the other values of the range.
    pub ranges: usize,
    /// Closed forms of traces.
    #[serde(rename = "closedForms")]
    pub forms: usize,
}

impl Unjudged {
    /// The counts of a `verify` object.
    pub(crate) fn count(verify: &Verify) -> Unjudged {
        let ranges = usize::from(!verify.over.is_empty());
        Unjudged { searches: verify.find.len(), ranges, forms: verify.exact.len() }
    }

    /// The sum of both.
    pub fn and(self, other: Unjudged) -> Unjudged {
        Unjudged {
            searches: self.searches + other.searches,
            ranges: self.ranges + other.ranges,
            forms: self.forms + other.forms,
        }
    }
}
