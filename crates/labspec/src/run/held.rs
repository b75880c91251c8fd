//! Who holds the programs of a run.

use crate::bind::Programs;
use std::ops::Deref;
use std::sync::Arc;

/// The programs of a lab: lent for one run, or shared with whoever keeps the lab for as long as a page is open.
#[derive(Clone, Debug)]
pub enum Held<'p> {
    /// They belong to someone else.
    Lent(&'p Programs),
    /// They belong to everybody who holds them.
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
