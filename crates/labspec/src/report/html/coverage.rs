//! How much of what a lesson says is claimed: its numbers with units, and its questions.

use crate::check::Checked;
use crate::trace::answered;
use crate::verify::{self, Stated};

/// The numbers with units of a lesson.
pub(super) struct Coverage {
    /// How many of them a claim is about.
    pub(super) claimed: usize,
    /// The others, in the order of the text.
    pub(super) unclaimed: Vec<Stated>,
}

impl Coverage {
    pub(super) fn of(c: &Checked) -> Coverage {
        let mut claimed = verify::claimed(&c.lesson);
        // Cells of tables are quoted where they stand.
        claimed.extend(c.claims.iter().flat_map(|claim| &claim.judgement.quotes).map(|q| q.span.clone()));
        claimed.extend(answered(&c.lesson));
        let meets = |s: &Stated| claimed.iter().any(|at| at.start < s.span.end && s.span.start < at.end);
        let (met, others): (Vec<Stated>, Vec<Stated>) =
            verify::stated(&c.lesson).into_iter().partition(meets);
        // A bound cannot be quoted alone: nobody has forgotten it.
        let unclaimed: Vec<Stated> = others.into_iter().filter(|s| !s.bound).collect();
        Coverage { claimed: met.len(), unclaimed }
    }

    /// All of them.
    pub(super) fn all(&self) -> usize {
        self.claimed + self.unclaimed.len()
    }
}
