use crate::bind::{ControlProgram, Programs};
use crate::check::assignments::assignments;
use crate::spec::Lab;
use labspec_finding::{Example, Finding, Layer, Rule, Severity};

/// A variable collects a value over a run, and a reset keeps it.
pub const KEPT_OVER_RESET: &Rule = &Rule {
    code: "kept-over-reset",
    severity: Severity::Warning,
    exceptions: &[],
    layer: Layer::Program,
    summary: "a variable collects a value over a run, and a reset keeps it",
    why: "a reset keeps `ctx`: the second run starts with the maximum or the count of the first one",
    bad: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><body name='rod'><joint name='hinge' axis='0 1 0' damping='0.1'/><geom type='capsule' size='.02' fromto='0 0 0 0 0 -1'/></body></worldbody></mujoco>", "stopAt": 1, "setup": "data.qpos[0] = 0.5", "controller": "⟦ctx.peak = Math.max(ctx.peak || 0, data.qvel[0])⟧", "readouts": [{"label": "peak", "expr": "ctx.peak || 0", "digits": 1}]}"#,
    ),
    good: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><body name='rod'><joint name='hinge' axis='0 1 0' damping='0.1'/><geom type='capsule' size='.02' fromto='0 0 0 0 0 -1'/></body></worldbody></mujoco>", "stopAt": 1, "setup": "data.qpos[0] = 0.5; ctx.peak = 0", "controller": "ctx.peak = Math.max(ctx.peak || 0, data.qvel[0])", "readouts": [{"label": "peak", "expr": "ctx.peak || 0", "digits": 1}]}"#,
    ),
};

pub(crate) fn check_variables(lab: &Lab, programs: &Programs, findings: &mut Vec<Finding>) {
    let (Some(text), Some(controller)) = (&lab.controller, &programs.controller) else { return };
    let all = assignments(text);
    let setup = programs.setup.as_ref().map(|bound| bound.program.effects());
    if setup.is_some_and(|effects| effects.any_ctx || effects.calls_values) {
        return;
    }
    let mut reported: Vec<&str> = Vec::new();
    for assignment in all.iter().filter(|a| a.is_cumulative()) {
        let Some(name) = assignment.target.strip_prefix("ctx.").filter(|name| !name.contains(['.', '[']))
        else {
            continue;
        };
        let of_lab = |slot: &&u32| programs.globals.name(**slot) == name;
        let Some(slot) = controller.program.effects().ctx_writes.iter().find(of_lab) else { continue };
        let of_control = |program: &ControlProgram| match program {
            ControlProgram::Change(_, action) => action.param == Some(*slot),
            ControlProgram::Press(_) => false,
        };
        let is_set = setup.is_some_and(|effects| effects.ctx_writes.contains(slot))
            || programs.controls.iter().any(|(_, program)| of_control(program))
            || all.iter().any(|other| other.target == assignment.target && !other.is_cumulative());
        if is_set || reported.contains(&name) {
            continue;
        }
        reported.push(name);
        let mut start =
            lab.setup.as_ref().map_or(String::new(), |s| s.as_str().trim().trim_end_matches(';').to_owned());
        if !start.is_empty() {
            start.push_str("; ");
        }
        findings.push(
            Finding::new(
                KEPT_OVER_RESET,
                text.span_of(assignment.span.into()),
                format!("a reset keeps `ctx.{name}`, which collects a value over a run"),
            )
            .help(format!("write `{start}ctx.{name} = 0` in `setup`")),
        );
    }
}
