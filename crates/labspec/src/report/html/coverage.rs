//! How much of what a lesson says is claimed: its numbers with units, and its questions.

use crate::check::Checked;
use crate::verify::{self, Stated};

/// The numbers with units of a lesson.
pub(super) struct Coverage {
    /// How many of them a claim is about.
    pub(super) claimed: usize,
    /// The others, in the order of the text.
    pub(super) unclaimed: Vec<Stated>,
}

impl Coverage {
    pub(super) fn measure(c: &Checked) -> Coverage {
        let counted = verify::counted(&c.lesson);
        Coverage { claimed: counted.claimed.len(), unclaimed: counted.left }
    }

    /// All of them.
    pub(super) fn all(&self) -> usize {
        self.claimed + self.unclaimed.len()
    }
}
