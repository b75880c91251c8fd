//! Ownership of the programs of a run.

use crate::bind::Programs;
use std::ops::Deref;
use std::sync::Arc;

/// The programs of a lab: borrowed for one run, or shared, for a lab on a page.
#[derive(Clone, Debug)]
pub enum ProgramsRef<'p> {
    /// Borrowed.
    Lent(&'p Programs),
    /// Shared.
    Shared(Arc<Programs>),
}

impl Deref for ProgramsRef<'_> {
    type Target = Programs;

    #[inline]
    fn deref(&self) -> &Programs {
        match self {
            ProgramsRef::Lent(programs) => programs,
            ProgramsRef::Shared(programs) => programs,
        }
    }
}

impl<'p> From<&'p Programs> for ProgramsRef<'p> {
    fn from(programs: &'p Programs) -> ProgramsRef<'p> {
        ProgramsRef::Lent(programs)
    }
}

impl From<Arc<Programs>> for ProgramsRef<'_> {
    fn from(programs: Arc<Programs>) -> Self {
        ProgramsRef::Shared(programs)
    }
}
