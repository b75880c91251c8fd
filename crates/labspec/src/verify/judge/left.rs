//! Counts the claims that no reference engine checks, so that "all verdicts" is not read as "all claims".

use crate::spec::Verify;
use serde::Serialize;

/// The numbers of claims that are not cross-checked, because they depend on runs that are not recorded.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
#[cfg_attr(feature = "report", derive(schemars::JsonSchema), schemars(rename = "notJudged"))]
pub struct Unjudged {
    /// Values of `find`: our own stay in their place.
    pub searches: usize,
    /// Answers with `over`: they are judged in their own runs, and nowhere else in the range.
    pub ranges: usize,
    /// Closed forms of traces, of `exact`.
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
