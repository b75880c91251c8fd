use crate::bind::ControlProgram;
use crate::check::PreparedLab;
use crate::spec::Lesson;
use labspec_finding::nearest;
use labspec_finding::{Example, Finding, Layer, Rule, Severity};

/// Nothing reads the variable of a `param`.
pub const PARAM_UNREAD: &Rule = &Rule {
    code: "param-unread",
    severity: Severity::Warning,
    exceptions: &[],
    layer: Layer::Program,
    summary: "nothing reads the variable of a `param`",
    why: "the page stores the value as `ctx.NAME`, but no expression of the lesson uses it: moving the control changes nothing",
    bad: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><body name='rod'><joint name='hinge' axis='0 1 0'/><geom type='capsule' size='.02' fromto='0 0 0 0 0 -1'/></body></worldbody></mujoco>", "controls": [{"label": "push", "param": "⟦torqe⟧", "min": 0, "max": 1, "value": 0}], "controller": "data.qfrc_applied[0] = ctx.torque || 0", "readouts": [{"label": "angle", "expr": "data.qpos[0]"}]}"#,
    ),
    good: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><body name='rod'><joint name='hinge' axis='0 1 0'/><geom type='capsule' size='.02' fromto='0 0 0 0 0 -1'/></body></worldbody></mujoco>", "controls": [{"label": "push", "param": "torque", "min": 0, "max": 1, "value": 0}], "controller": "data.qfrc_applied[0] = ctx.torque || 0", "readouts": [{"label": "angle", "expr": "data.qpos[0]"}]}"#,
    ),
};

pub(crate) fn check_params(lesson: &Lesson, ready: &PreparedLab<'_>, findings: &mut Vec<Finding>) {
    let programs = &ready.programs;
    // A text with errors may read it.
    let unknown = ready.mistakes > 0
        || programs.bound().any(|b| b.program.effects().any_ctx || b.program.effects().calls_values);
    if unknown {
        return;
    }
    for (control, (_, program)) in ready.lab.controls.iter().zip(&programs.controls) {
        let Some(action) = control.action() else { continue };
        let (Some(name), ControlProgram::Change(_, bound)) = (&action.param, program) else { continue };
        let reads = |slot: &u32| programs.bound().any(|b| b.program.effects().ctx_reads.contains(slot));
        let does_more = action.set.is_some() || action.apply.is_some();
        // A measure of the lesson may read it.
        let named = lesson.file.text().contains(&format!("ctx.{}", name.value));
        if does_more || named || bound.param.as_ref().is_none_or(reads) {
            continue;
        }
        let others: Vec<&str> = programs
            .bound()
            .flat_map(|b| &b.program.effects().ctx_reads)
            .map(|slot| programs.globals.name(*slot))
            .collect();
        let help = match nearest(&name.value, others) {
            Some(near) => format!("did you mean `{near}`? the lab reads `ctx.{near}`"),
            None => format!("read it as `ctx.{}` where it should act, or delete the control", name.value),
        };
        findings.push(
            Finding::warning(PARAM_UNREAD, name.span(), format!("nothing reads `ctx.{}`", name.value))
                .why(format!("moving \"{}\" changes nothing", control.label.value))
                .help(help),
        );
    }
}
