//! The programs of a lab, and the fields that they access.

use super::coupled::Coupled;
use crate::source::Text;
use labspec_bind::Functions;
use labspec_core::AccessSet;
use labspec_core::reflect::{FieldId, FieldSet, Kind, Object};
use labspec_expr::{Effects, Globals, Program, Value};

/// A text and its compiled program.
#[derive(Clone, Debug)]
pub struct Bound {
    /// The text, with its source map.
    pub text: Text,
    /// The program.
    pub program: Program,
}

/// A trace or a readout.
#[derive(Clone, Debug)]
pub struct Probe {
    /// Column name: `plot/0/label` or `readout/label`.
    pub name: String,
    /// `None` when the expression has errors, which are reported.
    pub bound: Option<Bound>,
}

/// The program of a slider or a select.
#[derive(Clone, Debug)]
pub struct ActionProgram {
    /// The `ctx` variable that gets the value.
    pub param: Option<u32>,
    /// The statements.
    pub run: Option<Bound>,
    /// Whether it is applied again after every reset.
    pub init: bool,
    /// Whether a change resets the lab.
    pub reset: bool,
}

/// The program of a control.
#[derive(Clone, Debug)]
pub enum ControlProgram {
    /// A slider or a select, with its start value.
    Change(Value, ActionProgram),
    /// A button.
    Press(Option<Bound>),
}

/// All programs of a lab.
#[derive(Clone, Debug)]
pub struct Programs {
    /// Runs after loading and after every reset.
    pub setup: Option<Bound>,
    /// Runs before every step.
    pub controller: Option<Bound>,
    /// Label and program of each control, in order.
    pub controls: Vec<(String, ControlProgram)>,
    /// Traces, then readouts.
    pub probes: Vec<Probe>,
    /// The `ctx` variables.
    pub globals: Globals,
    /// The fields that all programs read and write.
    pub access: AccessSet,
    /// Functions of the embedding program that they may call.
    pub functions: Functions,
    /// The model that they were compiled for (`Model::identity`).
    pub model: u64,
    /// The correction that is applied after the programs, for tests of coupled parameters.
    pub(crate) coupled: Option<Coupled>,
    /// A correction that a run only observes: whether it would change anything.
    pub(crate) observed: Option<Coupled>,
}

impl Programs {
    /// Every program with its text.
    pub fn bound(&self) -> impl Iterator<Item = &Bound> {
        let controls = self.controls.iter().filter_map(|(_, c)| match c {
            ControlProgram::Change(_, action) => action.run.as_ref(),
            ControlProgram::Press(run) => run.as_ref(),
        });
        let probes = self.probes.iter().filter_map(|p| p.bound.as_ref());
        self.setup.iter().chain(&self.controller).chain(controls).chain(probes)
    }

    /// The effects of the control with this label.
    pub(crate) fn effects_of(&self, label: &str) -> Option<&Effects> {
        match self.control(label)?.1 {
            ControlProgram::Change(_, action) => Some(action.run.as_ref()?.program.effects()),
            ControlProgram::Press(run) => Some(run.as_ref()?.program.effects()),
        }
    }

    /// The control with this label, and its index.
    pub fn control(&self, label: &str) -> Option<(usize, &ControlProgram)> {
        self.controls.iter().enumerate().find(|(_, (l, _))| l == label).map(|(i, (_, c))| (i, c))
    }
}

/// Adds what a program accesses to an access set.
pub fn include(effects: &Effects, set: &mut AccessSet) {
    if effects.reads_everything {
        set.reads = FieldSet::ALL;
    }
    if effects.writes_everything {
        set.writes = FieldSet::ALL;
    }
    for access in &effects.reads {
        if let Some(field) = FieldId::new(access.field.0 as usize) {
            set.reads.insert_elements(field, access.first, access.count);
        }
    }
    for access in &effects.writes {
        // A derived field that a function recomputes is not written by the program, and does not change a plan.
        if let Some(field) = FieldId::new(access.field.0 as usize).filter(|f| f.info().kind != Kind::Derived)
        {
            set.writes.insert(field);
        }
    }
}

/// The first field of one of these kinds that a program writes.
pub(crate) fn writes_kind(bound: &Bound, object: Object, kinds: &[Kind]) -> Option<FieldId> {
    let mut fields = bound.program.effects().writes.iter().filter_map(|a| FieldId::new(a.field.0 as usize));
    fields.find(|f| f.info().object == object && kinds.contains(&f.info().kind))
}
