use crate::bind::{ControlProgram, ModelNames, Programs, Scope};
use crate::spec::Lab;
use labspec_core::Model;
use labspec_core::reflect::FieldId;
use labspec_expr::{Access, Schema};
use labspec_finding::{Example, Finding, Layer, Rule, Severity};

/// Two controls set the same number.
pub const SAME_TARGET: &Rule = &Rule {
    code: "same-target",
    severity: Severity::Warning,
    exceptions: &[],
    layer: Layer::Program,
    summary: "two controls set the same number",
    why: "each of the two overwrites the value of the other, which still displays its own",
    bad: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><body><joint name='hinge' axis='0 1 0' damping='0.1'/><geom type='capsule' size='.02' fromto='0 0 0 0 0 -1'/></body></worldbody></mujoco>", "stopAt": 1, "setup": "data.qpos[0] = 0.5", "controls": [{"label": "damping", "min": 0, "max": 1, "value": 0.1, "set": "model.dof_damping[0]"}, {"label": "armature", "min": 0, "max": 1, "value": 0.1, "set": "⟦model.dof_damping[0]⟧"}], "readouts": [{"label": "angle", "expr": "data.qpos[0]", "digits": 1}]}"#,
    ),
    good: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><body><joint name='hinge' axis='0 1 0' damping='0.1'/><geom type='capsule' size='.02' fromto='0 0 0 0 0 -1'/></body></worldbody></mujoco>", "stopAt": 1, "setup": "data.qpos[0] = 0.5", "controls": [{"label": "damping", "min": 0, "max": 1, "value": 0.1, "set": "model.dof_damping[0]"}, {"label": "stiffness", "min": 0, "max": 1, "value": 0, "set": "model.jnt_stiffness[0]"}], "readouts": [{"label": "angle", "expr": "data.qpos[0]", "digits": 1}]}"#,
    ),
};

pub(crate) fn check_targets(lab: &Lab, model: &Model, programs: &Programs, findings: &mut Vec<Finding>) {
    let mut seen: Vec<(String, &str)> = Vec::new();
    for (control, (_, program)) in lab.authored_controls().iter().zip(&programs.controls) {
        let (Some(action), ControlProgram::Change(_, change)) = (control.action(), program) else { continue };
        let label = control.label.value.as_str();
        let place = action.set.as_ref().or(action.param.as_ref()).or(action.apply.as_ref());
        let Some(place) = place else { continue };
        let target = match (&action.param, &change.run) {
            (Some(param), _) => Some(format!("ctx.{}", param.value)),
            (None, Some(bound)) if bound.program.effects().uses_value => {
                match bound.program.own_writes().as_slice() {
                    [access] if bound.program.effects().ctx_writes.is_empty() => element(access, model),
                    _ => None,
                }
            }
            _ => None,
        };
        let Some(target) = target else { continue };
        if let Some((_, first)) = seen.iter().find(|(other, _)| *other == target) {
            findings.push(
                Finding::new(
                    SAME_TARGET,
                    place.span(),
                    format!("\"{label}\" sets `{target}`, as \"{first}\" does"),
                )
                .help("set another element or another variable, or delete one of the two controls"),
            );
        }
        seen.push((target, label));
    }
}

/// A single element that a program sets.
fn element(access: &Access, model: &Model) -> Option<String> {
    let field = FieldId::new(access.field.0 as usize).filter(|_| access.count == Some(1))?;
    let named = ModelNames::new(model, Scope::Lab).named_element(access.field, access.first);
    Some(named.unwrap_or_else(|| format!("{}[{}]", field.info().name, access.first)))
}
