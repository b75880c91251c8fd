//! What the programs of a lab do that a page lets pass in silence.

use crate::bind::{Bound, ControlProgram, Programs, functions, warning, writes_kind};
use crate::finding::Finding;
use crate::spec::Lab;
use labspec_core::reflect::{Kind, Object};

/// What programs do that a page lets pass in silence.
pub(super) fn check(lab: &Lab, programs: &Programs, findings: &mut Vec<Finding>) {
    for bound in programs.bound() {
        let calls_set_const =
            bound.program.effects().calls.iter().any(|&f| functions::name(f) == Some("mj_setConst"));
        if let Some(field) = writes_kind(bound, Object::Model, &[Kind::Inertial])
            && !calls_set_const
        {
            let name = field.info().name;
            findings.push(
                warning("missing-setconst", bound.text.span(), format!("`model.{name}` is changed without `mj.mj_setConst(model, data)`"))
                    .why("constants that follow from it (subtree masses, inverse weights of contacts) keep the old value: a heavier ball then sinks deeper into the floor than any real one")
                    .help("add `; mj.mj_setConst(model, data)`; it also puts qpos back to the start"),
            );
        }
    }
    for (control, (label, program)) in lab.controls.iter().zip(&programs.controls) {
        let ControlProgram::Change(_, action) = program else { continue };
        let Some(bound) = &action.run else { continue };
        if action.init {
            continue;
        }
        if let Some(field) =
            writes_kind(bound, Object::Data, &[Kind::State, Kind::Input]).filter(|_| !calls_reset(bound))
        {
            findings.push(
                warning(
                    "lost-at-reset",
                    bound.text.span(),
                    format!("what \"{label}\" sets is lost at the next reset"),
                )
                .why(format!(
                    "a reset puts data.{} back, while the control still shows the chosen value",
                    field.info().name
                ))
                .help("add \"init\": true, so that it is applied again after every reset")
                .related(control.label.span(), "the control"),
            );
        }
    }
}

/// Whether a program resets or recomputes the data itself, so that its writes to it are a consequence.
fn calls_reset(bound: &Bound) -> bool {
    bound.program.effects().calls.iter().any(|&f| functions::name(f).is_some_and(|n| n.starts_with("mj_")))
}
