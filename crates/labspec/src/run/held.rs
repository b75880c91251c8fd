//! Ownership of the programs of a run.

use crate::bind::Programs;
use std::ops::Deref;
use std::sync::Arc;

/// The programs of a lab: borrowed for one run, or shared, for a lab on a page.
#[derive(Clone, Debug)]
pub enum Held<'p> {
    /// Borrowed.
    Lent(&'p Programs),
    /// Shared.
    Shared(Arc<Programs>),
}

impl Deref for Held<'_> {
    type Target = Programs;

    #[inline]
    fn deref(&self) -> &Programs {
        match self {
            Held::Lent(programs) => programs,
            Held::Shared(programs) => programs,
        }
    }
}

impl<'p> From<&'p Programs> for Held<'p> {
    fn from(programs: &'p Programs) -> Held<'p> {
        Held::Lent(programs)
    }
}

impl From<Arc<Programs>> for Held<'_> {
    fn from(programs: Arc<Programs>) -> Self {
        Held::Shared(programs)
    }
}
