//! A lab whose programs are bound: the input of rules about programs and runs.

use crate::bind::Programs;
use crate::spec::Lab;
use crate::verify;
use labspec_core::Model;
use std::sync::Arc;

/// A lab with its model and programs.
pub(crate) struct PreparedLab<'l> {
    pub(crate) lab: &'l Lab,
    pub(crate) model: Arc<Model>,
    pub(crate) programs: Programs,
    /// Number of errors in its code.
    pub(crate) mistakes: usize,
}

impl<'l> PreparedLab<'l> {
    pub(crate) fn scene(&'l self) -> verify::BoundLab<'l> {
        verify::BoundLab::new(self.lab, &self.model, &self.programs)
    }
}
