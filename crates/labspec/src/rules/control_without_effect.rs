use super::Check;
use crate::json::read::named;
use crate::spec::Control;
use labspec_finding::{Example, Finding, Layer, Rule, Severity};

/// A slider or select has no `set`, `apply` or `param`.
pub const CONTROL_WITHOUT_EFFECT: &Rule = &Rule {
    code: "control-without-effect",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Structure,
    summary: "a slider or select has no `set`, `apply` or `param`",
    why: "the control moves, but nothing in the lab changes",
    bad: Example::Lab(
        r#"{"model": "ball", "controls": [{"label": "⟦mass⟧", "min": 1, "max": 5, "value": 1}]}"#,
    ),
    good: Example::Lab(
        r#"{"model": "ball", "controls": [{"label": "friction", "set": "model.geom_friction[0]", "min": 1, "max": 2, "value": 1}]}"#,
    ),
};

pub(super) const CHECK: Check = Check::Control(check_control);

fn check_control(control: &Control, findings: &mut Vec<Finding>) {
    let Some(action) = control.action() else { return };
    if action.set.is_none() && action.apply.is_none() && action.param.is_none() {
        let message = format!("{} changes nothing", named(control.label.as_str()));
        findings.push(Finding::new(CONTROL_WITHOUT_EFFECT, control.label.span(), message).help(
            "add \"set\": the field that gets the value, \"apply\": statements that use `value`, or \"param\": a name read as ctx.NAME",
        ));
    }
}
