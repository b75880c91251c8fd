use crate::bind::{ControlProgram, Programs};
use crate::check::choices::choices;
use crate::check::programs::{resets, sets};
use crate::check::setconst::digits;
use crate::run::{Session, Start};
use crate::spec::{Control, Lab};
use labspec_core::Model;
use labspec_core::reflect::{FieldId, Kind};
use labspec_expr::{FieldKey, Host, Value};
use labspec_finding::{Example, Finding, Layer, Rule, Severity};

/// A reset discards what a control sets in the data.
pub const LOST_AT_RESET: &Rule = &Rule {
    code: "lost-at-reset",
    severity: Severity::Warning,
    exceptions: &[],
    layer: Layer::Program,
    summary: "a reset discards what a control sets in the data",
    why: "the control still displays its value, but the simulation no longer uses it; `\"init\": true` applies it again",
    bad: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><body name='rod'><joint name='hinge' axis='0 1 0'/><geom type='capsule' size='.02' fromto='0 0 0 0 0 -1'/></body></worldbody></mujoco>", "controls": [{"label": "angle", "set": "⟦data.qpos[0]⟧", "min": 0, "max": 1, "value": 0.5}], "readouts": [{"label": "shown", "expr": "data.qpos[0]"}]}"#,
    ),
    good: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><body name='rod'><joint name='hinge' axis='0 1 0'/><geom type='capsule' size='.02' fromto='0 0 0 0 0 -1'/></body></worldbody></mujoco>", "controls": [{"label": "angle", "set": "data.qpos[0]", "min": 0, "max": 1, "value": 0.5, "init": true}], "readouts": [{"label": "shown", "expr": "data.qpos[0]"}]}"#,
    ),
};

/// Checks controls that set fields that a reset restores.
pub(crate) fn check_resets(lab: &Lab, model: &Model, programs: &Programs, findings: &mut Vec<Finding>) {
    for (index, control) in lab.controls.iter().enumerate() {
        let Some((label, ControlProgram::Change(_, action))) = programs.controls.get(index) else { continue };
        let Some(bound) = action.run.as_ref().filter(|b| !action.init && !resets(b)) else { continue };
        let Some(field) = sets(bound, model) else { continue };
        let Some(lost_value) = describe_lost(control, index, field, lab, model, programs) else { continue };
        findings.push(
            Finding::warning(
                LOST_AT_RESET,
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

/// Moves the control, then resets, and describes the values of the field that are lost. `None` if a setup, a controller or another
/// control sets them again.
fn describe_lost(
    control: &Control,
    index: usize,
    field: FieldId,
    lab: &Lab,
    model: &Model,
    programs: &Programs,
) -> Option<String> {
    let mut programs = programs.clone();
    if let Some((_, ControlProgram::Change(_, action))) = programs.controls.get_mut(index) {
        // The values that it sets are read before the reset.
        action.reset = false;
    }
    let key = FieldKey(field.index() as u32);
    let current = |session: &Session<'_>| -> Vec<f64> {
        (0..session.world.len(key)).map_while(|i| session.world.get(key, i)).collect()
    };
    let differs = |a: &[f64], b: &[f64]| a.iter().zip(b).position(|(x, y)| x.to_bits() != y.to_bits());
    let with = |chosen: &Value| {
        let mut session = Session::start(&programs, model, Start::of_lab(lab));
        session.set_control(index, chosen.clone());
        let set = current(&session);
        session.reset();
        let reset = current(&session);
        let element = differs(&set, &reset)?;
        // A controller may set an input again before the first step.
        if field.info().kind == Kind::Input && programs.controller.is_some() {
            session.step();
            let after_reset = current(&session);
            session.set_control(index, chosen.clone());
            session.step();
            differs(&current(&session), &after_reset)?;
        }
        let name = format!("data.{}[{element}]", field.info().name);
        let [set, reset] =
            [&set, &reset].map(|list| digits(list.get(element).copied().unwrap_or(f64::NAN), 6));
        Some(format!(
            "with \"{}\" at {chosen}, {name} is {set}, and {reset} after a reset",
            control.label.value
        ))
    };
    choices(control).iter().find_map(with)
}
