use crate::bind::ControlProgram;
use crate::check::observations::ObservedLab;
use crate::spec::Control;
use labspec_expr::Effects;
use labspec_finding::{Example, Finding, Layer, Rule, Severity};

/// Only the setup reads the value of a control, and the control does not reset.
pub const NEEDS_RESET: &Rule = &Rule {
    code: "needs-reset",
    severity: Severity::Warning,
    exceptions: &[],
    layer: Layer::Run,
    summary: "only the setup reads the value of a control, and the control does not reset",
    why: "nothing happens when a student moves it: the setup runs only when the lab loads and at a reset",
    bad: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><body name='rod'><joint name='hinge' axis='0 1 0'/><geom type='capsule' size='.02' fromto='0 0 0 0 0 -1'/></body></worldbody></mujoco>", "setup": "data.qpos[0] = ctx.start", "stopAt": 0.5, "controls": [{"label": "⟦start⟧", "param": "start", "min": 0, "max": 1, "value": 0.5}], "readouts": [{"label": "angle", "expr": "data.qpos[0]"}]}"#,
    ),
    good: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><body name='rod'><joint name='hinge' axis='0 1 0'/><geom type='capsule' size='.02' fromto='0 0 0 0 0 -1'/></body></worldbody></mujoco>", "setup": "data.qpos[0] = ctx.start", "stopAt": 0.5, "controls": [{"label": "start", "param": "start", "reset": true, "min": 0, "max": 1, "value": 0.5}], "readouts": [{"label": "angle", "expr": "data.qpos[0]"}]}"#,
    ),
};

/// Reports a control without effect on a running lab, because only the setup reads the stored value. `why`: the tested cases.
pub(super) fn check_setup(
    observed: &ObservedLab<'_>,
    control: &Control,
    index: usize,
    why: &str,
) -> Option<Finding> {
    let programs = &observed.bench.ready.programs;
    let (_, ControlProgram::Change(_, action)) = programs.controls.get(index)? else { return None };
    let stored = action.run.as_ref().map(|b| b.program.effects().ctx_writes.clone()).unwrap_or_default();
    let slots: Vec<u32> = stored.into_iter().chain(action.param).collect();
    let reads = |effects: &Effects| slots.iter().any(|s| effects.ctx_reads.contains(s));
    let setup = programs.setup.as_ref().is_some_and(|b| reads(b.program.effects()));
    let writes = action.run.as_ref().is_some_and(|b| !b.program.own_writes().is_empty());
    let message = format!("\"{}\" takes effect only after a reset", control.label.value);
    (setup && !action.reset && !writes).then(|| {
        Finding::warning(NEEDS_RESET, control.label.span(), message)
            .why(format!("only the setup reads its value, and the setup runs only at a reset. {why}"))
            .help("add \"reset\": true")
    })
}
