use crate::bind::{Bound, ControlProgram, Programs, functions};
use crate::check::setconst::digits;
use crate::run::{Session, Start};
use crate::spec::Lab;
use labspec_core::Model;
use labspec_core::reflect::data;
use labspec_expr::{FieldKey, Host};
use labspec_finding::{Example, Finding, Layer, Rule, Severity};

/// A lab starts in one state, and a reset puts it into another.
pub const START_NOT_RESET: &Rule = &Rule {
    code: "start-not-reset",
    severity: Severity::Warning,
    exceptions: &[],
    layer: Layer::Program,
    summary: "a lab starts in one state, and a reset puts it into another",
    why: "a student sees another experiment after the first reset. A common cause is `mj_setConst` in a control: when the lab loads, it puts qpos back to that of the model, and the keyframe of the lab is lost until a reset",
    bad: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><body name='rod'><joint name='hinge' axis='0 1 0'/><geom type='capsule' size='.02' fromto='0 0 0 0 0 -1'/></body></worldbody><keyframe><key qpos='.6'/></keyframe></mujoco>", "key": ⟦0⟧, "controls": [{"label": "armature", "apply": "model.dof_armature[0] = value; mj.mj_setConst(model, data)", "reset": true, "min": 0, "max": 1, "value": 0.5}], "readouts": [{"label": "angle (rad)", "expr": "data.qpos[0]"}]}"#,
    ),
    good: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><body name='rod'><joint name='hinge' axis='0 1 0'/><geom type='capsule' size='.02' fromto='0 0 0 0 0 -1'/></body></worldbody></mujoco>", "setup": "data.qpos[0] = 0.6", "controls": [{"label": "armature", "apply": "model.dof_armature[0] = value; mj.mj_setConst(model, data)", "reset": true, "min": 0, "max": 1, "value": 0.5}], "readouts": [{"label": "angle (rad)", "expr": "data.qpos[0]"}]}"#,
    ),
};

/// The largest difference of two coordinates that are the same.
const SAME: f64 = 1e-9;

/// Whether the program of a control may change qpos when the lab loads: by itself, or by `mj_setConst`.
fn may_move(program: &ControlProgram) -> bool {
    let ControlProgram::Change(_, action) = program else { return false };
    action.run.as_ref().is_some_and(|bound| {
        let effects = bound.program.effects();
        effects.writes_everything
            || effects.calls_values
            || calls(bound, |name| name.starts_with("mj_"))
            || effects.writes.iter().any(|access| access.field.0 as usize == data::qpos.index())
    })
}

/// Whether a program calls a function of the engine with such a name.
fn calls(bound: &Bound, is_meant: impl Fn(&str) -> bool) -> bool {
    bound.program.effects().calls.iter().filter_map(|f| functions::name(*f)).any(is_meant)
}

/// Compares the state after loading with that after a reset. A lab whose resets differ among themselves draws its state at random.
pub(crate) fn check_start(lab: &Lab, model: &Model, programs: &Programs, findings: &mut Vec<Finding>) {
    if !programs.controls.iter().any(|(_, program)| may_move(program)) {
        return;
    }
    let mut session = Session::start(programs, model, Start::of_lab(lab));
    let pose = |session: &Session<'_>| -> Vec<f64> {
        let key = FieldKey(data::qpos.index() as u32);
        (0..session.world.len(key)).map_while(|i| session.world.get(key, i)).collect()
    };
    let start = pose(&session);
    session.reset();
    let first = pose(&session);
    session.reset();
    let second = pose(&session);
    let differing = |a: &[f64], b: &[f64]| a.iter().zip(b).position(|(x, y)| (x - y).abs() > SAME);
    let (Some(i), None) = (differing(&start, &first), differing(&first, &second)) else { return };
    if session.ended().is_some() {
        return;
    }
    let [before, after] = [&start, &first].map(|list| digits(list.get(i).copied().unwrap_or(f64::NAN), 6));
    let message = format!("the lab starts with data.qpos[{i}] at {before}, and a reset puts it to {after}");
    let of_model = session.world.model.qpos0.get(i).zip(start.get(i));
    let is_of_model = of_model.is_some_and(|(x, y)| (x - y).abs() <= SAME);
    let setconst = lab.controls.iter().zip(&programs.controls).find_map(|(control, (_, program))| {
        let ControlProgram::Change(_, action) = program else { return None };
        let bound = action.run.as_ref()?;
        let is_cause = is_of_model && lab.key.is_some() && calls(bound, |name| name == "mj_setConst");
        is_cause.then_some((control, bound))
    });
    let span = lab.key.as_ref().map_or(lab.span.clone(), |key| key.span.clone());
    let finding = Finding::new(START_NOT_RESET, span, message);
    findings.push(match setconst {
        Some((control, bound)) => finding
            .why("when the lab loads, `mj_setConst` puts qpos back to that of the model; a reset restores the keyframe")
            .help("set the start in `setup`, which runs after the controls and after every reset")
            .related(bound.text.span(), format!("the control \"{}\"", control.label.as_str())),
        None => finding.help("set the start in `setup`, which runs after the controls and after every reset"),
    });
}
