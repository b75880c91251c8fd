use super::Check;
use crate::spec::Lab;
use labspec_core::Model;
use labspec_finding::{Example, Finding, Layer, Rule, Severity};

/// `key` names a keyframe that the model does not have.
pub const KEYFRAME_MISSING: &Rule = &Rule {
    code: "keyframe-missing",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Model,
    summary: "`key` names a keyframe that the model does not have",
    why: "the page silently starts from the default configuration",
    bad: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><body name='rod'><joint name='hinge' axis='0 1 0'/><geom type='capsule' size='.02' fromto='0 0 0 0 0 -1'/></body></worldbody></mujoco>", "key": ⟦1⟧}"#,
    ),
    good: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><body name='rod'><joint name='hinge' axis='0 1 0'/><geom type='capsule' size='.02' fromto='0 0 0 0 0 -1'/></body></worldbody><keyframe><key qpos='1'/></keyframe></mujoco>", "key": 0}"#,
    ),
};

pub(super) const CHECK: Check = Check::Model(check_lab);

fn check_lab(lab: &Lab, model: &Model, findings: &mut Vec<Finding>) {
    let Some(key) = lab.key.as_ref().filter(|k| k.value >= model.nkey as f64) else { return };
    let message = format!("the model has no keyframe {}", key.value);
    findings.push(
        Finding::error(KEYFRAME_MISSING, key.span.clone(), message)
            .why("the page then silently starts from the default configuration")
            .help(match model.nkey {
                0 => {
                    "delete `key`, or add <keyframe><key …/></keyframe> to the model, which has no keyframes"
                        .to_string()
                }
                n => format!("use one of its keyframes, 0 to {}", n - 1),
            }),
    );
}
