//! What no judge looks at, counted: so that "all verdicts" is not read as if everything had been judged.

use crate::spec::Verify;
use serde::Serialize;

/// Claims of which a judge says nothing: they rest on other runs than those that it is asked to make.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Left {
    /// Values that are searched for: our own stay in their place.
    pub searches: usize,
    /// Answers that hold over a range: they are judged in their own runs, and nowhere else in it.
    pub ranges: usize,
    /// Closed forms of traces.
    #[serde(rename = "closedForms")]
    pub forms: usize,
}

impl Left {
    /// Those of a `verify` object.
    pub(crate) fn count(verify: &Verify) -> Left {
        let ranges = usize::from(!verify.over.is_empty());
        Left { searches: verify.find.len(), ranges, forms: verify.exact.len() }
    }

    /// Both together.
    pub fn and(self, other: Left) -> Left {
        Left {
            searches: self.searches + other.searches,
            ranges: self.ranges + other.ranges,
            forms: self.forms + other.forms,
        }
    }
}
