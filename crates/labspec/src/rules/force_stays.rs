use crate::bind::{Bound, ControlProgram, Programs};
use crate::check::assignments::{assignments, without_spaces};
use crate::spec::{ControlKind, Lab};
use labspec_core::reflect::data;
use labspec_expr::Access;
use labspec_finding::{Example, Finding, Layer, Rule, Severity};

/// A button applies a force, and nothing takes it away.
pub const FORCE_STAYS: &Rule = &Rule {
    code: "force-stays",
    severity: Severity::Warning,
    exceptions: &[],
    layer: Layer::Program,
    summary: "a button applies a force that is never removed",
    why: "an applied force acts until it is set again: what looks like a kick pushes until the next reset",
    bad: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><body name='rod'><joint name='hinge' axis='0 1 0' damping='0.1'/><geom type='capsule' size='.02' fromto='0 0 0 0 0 -1'/></body></worldbody></mujoco>", "stopAt": 1, "setup": "data.qpos[0] = 0.5", "controls": [{"type": "button", "label": "Kick", "run": "⟦data.qfrc_applied[0] = 3⟧"}], "readouts": [{"label": "angle", "expr": "data.qpos[0]", "digits": 1}]}"#,
    ),
    good: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><body name='rod'><joint name='hinge' axis='0 1 0' damping='0.1'/><geom type='capsule' size='.02' fromto='0 0 0 0 0 -1'/></body></worldbody></mujoco>", "stopAt": 1, "setup": "data.qpos[0] = 0.5", "controls": [{"type": "button", "label": "Kick", "run": "data.qvel[0] += 3"}], "readouts": [{"label": "angle", "expr": "data.qpos[0]", "digits": 1}]}"#,
    ),
};

/// Words of a label that announce a lasting force.
const LASTING: [&str; 8] = ["on", "constant", "hold", "steady", "switch", "start", "wind", "toggle"];

pub(crate) fn check_buttons(lab: &Lab, programs: &Programs, findings: &mut Vec<Finding>) {
    for (index, (control, (_, program))) in lab.controls.iter().zip(&programs.controls).enumerate() {
        let (ControlKind::Button { run }, ControlProgram::Press(Some(bound))) = (&control.kind, program)
        else {
            continue;
        };
        let words = super::label_names_another::words_of(&control.label.value);
        let forces = applied(bound);
        if forces.is_empty()
            || words.iter().any(|word| LASTING.contains(&word.as_str()))
            || others(programs, index).flat_map(applied).any(|a| forces.iter().any(|b| a.field == b.field))
        {
            continue;
        }
        let all = assignments(run);
        let is_force = |target: &str| target.contains("frc_applied");
        let stores = || all.iter().filter(|a| is_force(&a.target));
        // A button that reads the force, or that has a case without it, switches.
        let text = without_spaces(run.as_str());
        let switches = text.matches("frc_applied").count() > stores().count()
            || stores().any(|a| a.number() == Some(0.0) || a.is_cumulative() || a.value.contains('?'));
        let Some(first) = stores().next().filter(|_| !switches) else { continue };
        findings.push(
            Finding::new(
                FORCE_STAYS,
                run.span_of(first.span.into()),
                format!("the force that \"{}\" applies is never removed", control.label.value),
            )
            .help(format!(
                "for a kick, change the velocity, as `data.qvel[0] += 1`; or set `{}` to 0 again in `controller`",
                first.target
            )),
        );
    }
}

/// The programs besides the probes and the control with this index.
fn others(programs: &Programs, index: usize) -> impl Iterator<Item = &Bound> {
    let controls = programs.controls.iter().enumerate().filter(move |(i, _)| *i != index);
    let controls = controls.filter_map(|(_, (_, program))| match program {
        ControlProgram::Change(_, action) => action.run.as_ref(),
        ControlProgram::Press(run) => run.as_ref(),
    });
    controls.chain(&programs.controller)
}

/// The elements of applied forces that a program writes.
fn applied(bound: &Bound) -> Vec<Access> {
    let fields = [data::qfrc_applied, data::xfrc_applied].map(|f| f.index() as u32);
    bound.program.own_writes().into_iter().filter(|write| fields.contains(&write.field.0)).collect()
}
