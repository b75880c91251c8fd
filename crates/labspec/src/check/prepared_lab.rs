//! A lab whose programs are bound: the input of rules about programs and runs.

use crate::bind::{ControlProgram, Programs};
use crate::json::read::named;
use crate::spec::{Control, ControlKind, Lab};
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

/// A program of a lab that has errors, so that a run is made without it: what the run shows is not what the lab describes.
/// `pressed` contains the labels of the buttons that the run presses.
pub(crate) fn program_with_errors(lab: &Lab, programs: &Programs, pressed: &[&str]) -> Option<String> {
    if lab.setup.is_some() && programs.setup.is_none() {
        return Some("the `setup` of its lab has errors".into());
    }
    if lab.controller.is_some() && programs.controller.is_none() {
        return Some("the `controller` of its lab has errors".into());
    }
    let mut controls = lab.controls.iter().zip(&programs.controls);
    let broken = controls.find(|(control, (_, program))| match program {
        ControlProgram::Change(_, action) => action.run.is_none() && has_statements(control),
        ControlProgram::Press(run) => run.is_none() && pressed.contains(&control.label.as_str()),
    });
    broken.map(|(control, _)| format!("the control {} of its lab has errors", named(control.label.as_str())))
}

/// Whether a slider or a select has statements, besides the `ctx` variable that it sets.
fn has_statements(control: &Control) -> bool {
    match &control.kind {
        ControlKind::Slider { action, .. } | ControlKind::Select { action, .. } => {
            action.set.is_some() || action.apply.is_some()
        }
        ControlKind::Button { .. } => false,
    }
}
