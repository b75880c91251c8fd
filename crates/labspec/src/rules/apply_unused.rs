use super::Check;
use crate::json::read::{named, shorten};
use crate::spec::Control;
use labspec_finding::{Example, Finding, Layer, Rule, Severity};

/// A control has both `set` and `apply`.
pub const APPLY_UNUSED: &Rule = &Rule {
    code: "apply-unused",
    severity: Severity::Warning,
    exceptions: &[],
    layer: Layer::Structure,
    summary: "a control has both `set` and `apply`",
    why: "the page runs `set` and ignores `apply`, so those statements do nothing",
    bad: Example::Lab(
        r#"{"model": "ball", "controls": [{"label": "friction", "set": "model.geom_friction[0]", "apply": "⟦mj.mj_setConst(model, data)⟧", "min": 1, "max": 5, "value": 1}]}"#,
    ),
    good: Example::Lab(
        r#"{"model": "ball", "controls": [{"label": "mass", "apply": "model.body_mass[1] = value; mj.mj_setConst(model, data)", "min": 1, "max": 5, "value": 1, "reset": true}]}"#,
    ),
};

pub(super) const CHECK: Check = Check::Control(check_control);

fn check_control(control: &Control, findings: &mut Vec<Finding>) {
    let Some(action) = control.action() else { return };
    if let (Some(set), Some(apply)) = (&action.set, &action.apply) {
        let label = named(control.label.as_str());
        findings.push(
            Finding::new(
                APPLY_UNUSED,
                apply.span(),
                format!("{label} never runs `apply`, because it also has `set`"),
            )
            .related(set.span(), "the page runs this instead")
            .help(format!(
                "delete `set`, and begin these statements with `{} = value;`",
                shorten(set.as_str())
            )),
        );
    }
}
