//! The fraction of a lesson's statements with a claim: its numbers with units, and its questions.

use crate::check::Checked;
use crate::verify::{self, Stated};
use std::collections::HashSet;
use std::ops::Range;

/// The numbers with units of a lesson.
pub(super) struct NumberCoverage {
    /// Number of those with a claim.
    pub(super) claimed: usize,
    /// The others, in the order of the text.
    pub(super) unclaimed: Vec<Stated>,
}

impl NumberCoverage {
    pub(super) fn measure(c: &Checked) -> NumberCoverage {
        let counted = verify::counted(&c.lesson);
        let spans: HashSet<&Range<usize>> = c.printed.iter().map(|number| &number.span).collect();
        let is_printed = |s: &Stated| spans.contains(&s.span);
        let (printed, unclaimed): (Vec<Stated>, Vec<Stated>) = counted.left.into_iter().partition(is_printed);
        NumberCoverage { claimed: counted.claimed.len() + printed.len(), unclaimed }
    }

    /// Number of all.
    pub(super) fn all(&self) -> usize {
        self.claimed + self.unclaimed.len()
    }
}
