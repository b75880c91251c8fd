//! What the programs of a lab do that a page lets pass in silence.

use super::choices::choices;
use super::setconst;
use crate::bind::{Bound, ControlProgram, Programs, functions};
use crate::finding::Finding;
use crate::rules;
use crate::run::{Session, Start};
use crate::spec::{Control, Lab};
use labspec_core::Model;
use labspec_core::reflect::{FieldId, Kind, Object, data};
use labspec_expr::{FieldKey, Host, Value};

/// What programs do that a page lets pass in silence.
pub(super) fn check_programs(lab: &Lab, model: &Model, programs: &Programs, findings: &mut Vec<Finding>) {
    setconst::check_setconst(lab, model, programs, findings);
    for (index, control) in lab.controls.iter().enumerate() {
        let Some((label, ControlProgram::Change(_, action))) = programs.controls.get(index) else { continue };
        let Some(bound) = action.run.as_ref().filter(|b| !action.init && !resets(b)) else { continue };
        let Some(field) = sets(bound, model) else { continue };
        let Some(lost_value) = lost(control, index, field, lab, model, programs) else { continue };
        findings.push(
            Finding::warning(
                rules::LOST_AT_RESET,
                bound.text.span(),
                format!("a reset discards what \"{label}\" sets"),
            )
            .why(format!(
                "a reset restores data.{}, but the control still displays the chosen value: {lost_value}",
                field.info().name
            ))
            .help("add \"init\": true, so that every reset applies it again")
            .related(control.label.span(), "the control"),
        );
    }
}

/// The first field of the data that a program sets itself, of those that a reset puts back.
pub(super) fn sets(bound: &Bound, model: &Model) -> Option<FieldId> {
    let set_const = bound.program.effects().calls.iter().any(|&f| functions::name(f) == Some("mj_setConst"));
    let writes = bound.program.own_writes();
    let mut set = writes.iter().filter(|w| {
        let Some(field) = FieldId::new(w.field.0 as usize) else { return false };
        let info = field.info();
        // Beside mj_setConst, all of qpos is put back to what it was: no choice of the student.
        let put_back =
            set_const && field == data::qpos && w.first == 0 && w.count.is_none_or(|n| n == model.nq);
        info.object == Object::Data && matches!(info.kind, Kind::State | Kind::Input) && !put_back
    });
    set.next().and_then(|w| FieldId::new(w.field.0 as usize))
}

/// Whether a program starts the simulation anew itself, so that what it sets is the start that it wants.
pub(super) fn resets(bound: &Bound) -> bool {
    let reset = |name| matches!(name, "mj_resetData" | "mj_resetDataKeyframe" | "reset");
    bound.program.effects().calls.iter().any(|&f| functions::name(f).is_some_and(reset))
}

/// Moves the control, then resets: what of the field is lost, in words. `None` when a setup, a controller or another
/// control sets it again.
fn lost(
    control: &Control,
    index: usize,
    field: FieldId,
    lab: &Lab,
    model: &Model,
    programs: &Programs,
) -> Option<String> {
    let mut programs = programs.clone();
    if let Some((_, ControlProgram::Change(_, action))) = programs.controls.get_mut(index) {
        // What it sets is looked at before the reset.
        action.reset = false;
    }
    let key = FieldKey(field.index() as u32);
    let now = |session: &Session<'_>| -> Vec<f64> {
        (0..session.world.len(key)).map_while(|i| session.world.get(key, i)).collect()
    };
    let differs = |a: &[f64], b: &[f64]| a.iter().zip(b).position(|(x, y)| x.to_bits() != y.to_bits());
    let with = |chosen: &Value| {
        let mut session = Session::start(&programs, model, Start::of_lab(lab));
        session.set_control(index, chosen.clone());
        let set = now(&session);
        session.reset();
        let reset = now(&session);
        let at = differs(&set, &reset)?;
        // A controller may set an input again before the first step.
        if field.info().kind == Kind::Input && programs.controller.is_some() {
            session.step();
            let after_reset = now(&session);
            session.set_control(index, chosen.clone());
            session.step();
            differs(&now(&session), &after_reset)?;
        }
        let name = format!("data.{}[{at}]", field.info().name);
        let [set, reset] =
            [&set, &reset].map(|list| setconst::digits(list.get(at).copied().unwrap_or(f64::NAN), 6));
        Some(format!(
            "with \"{}\" at {chosen}, {name} is {set}, and {reset} after a reset",
            control.label.value
        ))
    };
    choices(control).iter().find_map(with)
}
