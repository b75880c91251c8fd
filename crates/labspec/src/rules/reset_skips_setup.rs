use super::Check;
use crate::check::assignments::without_spaces;
use crate::spec::{ControlKind, Lab};
use labspec_finding::{Example, Finding, Layer, Rule, Severity};

/// A button resets the data alone, and skips the setup of the lab.
pub const RESET_SKIPS_SETUP: &Rule = &Rule {
    code: "reset-skips-setup",
    severity: Severity::Warning,
    exceptions: &[],
    layer: Layer::Program,
    summary: "a button resets the data alone, and skips the setup of the lab",
    why: "`mj_resetData` restores the model's own start: neither the keyframe of the lab, nor its `setup`, nor its controls are applied again",
    bad: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><body name='rod'><joint name='hinge' axis='0 1 0' damping='0.1'/><geom type='capsule' size='.02' fromto='0 0 0 0 0 -1'/></body></worldbody></mujoco>", "stopAt": 1, "setup": "data.qpos[0] = 0.5", "controls": [{"type": "button", "label": "Reset", "run": "⟦mj.mj_resetData(model, data)⟧"}], "readouts": [{"label": "angle", "expr": "data.qpos[0]", "digits": 1}]}"#,
    ),
    good: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><body name='rod'><joint name='hinge' axis='0 1 0' damping='0.1'/><geom type='capsule' size='.02' fromto='0 0 0 0 0 -1'/></body></worldbody></mujoco>", "stopAt": 1, "setup": "data.qpos[0] = 0.5", "controls": [{"type": "button", "label": "Reset", "run": "sim.reset()"}], "readouts": [{"label": "angle", "expr": "data.qpos[0]", "digits": 1}]}"#,
    ),
};

pub(super) const CHECK: Check = Check::Lab(check_lab);

fn check_lab(lab: &Lab, findings: &mut Vec<Finding>) {
    let is_applied = |action: &crate::spec::Action| action.init || action.param.is_some();
    let has_start = lab.setup.as_ref().is_some_and(|text| !text.as_str().trim().is_empty())
        || lab.key.is_some()
        || lab.controls.iter().filter_map(|c| c.action()).any(is_applied);
    if !has_start {
        return;
    }
    for control in &lab.controls {
        let ControlKind::Button { run } = &control.kind else { continue };
        let text = without_spaces(run.as_str());
        // A button that goes on after the reset makes its own start.
        let mut statements = text.split(';').filter(|s| !s.is_empty());
        let resets = |s: &str| {
            ["mj.mj_resetData(", "mj.mj_resetData"].iter().any(|call| s.starts_with(call))
                && !s.starts_with("mj.mj_resetDataKeyframe")
        };
        let is_reset = statements.next().is_some_and(resets);
        let goes_on = statements.any(|s| !s.starts_with("mj.mj_forward"));
        if is_reset && !goes_on {
            findings.push(
                Finding::new(
                    RESET_SKIPS_SETUP,
                    run.span(),
                    "this resets the data but does not restore the initial state of the lab",
                )
                .help("write `sim.reset()`"),
            );
        }
    }
}
