use super::Check;
use crate::source::Text;
use crate::spec::{Control, ControlKind, Lab};
use labspec_core::Model;
use labspec_finding::{Example, Finding, Layer, Rule, Severity};

/// A control gives the gravity a direction upward.
pub const GRAVITY_UPWARD: &Rule = &Rule {
    code: "gravity-upward",
    severity: Severity::Warning,
    exceptions: &[],
    layer: Layer::Program,
    summary: "a control turns the gravity of the model upward",
    why: "gravity is a vector, and its third number is below 0 where things fall: with 9.81, everything flies up as soon as the control is moved",
    bad: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><body name='ball' pos='0 0 1'><freejoint/><geom size='.05'/></body></worldbody></mujoco>", "controls": [{"label": "gravity (m/s²)", "set": "⟦model.opt.gravity[2]⟧", "min": 0, "max": 20, "step": 0.01, "value": 9.81, "reset": true}], "readouts": [{"label": "height (m)", "expr": "data.qpos[2]"}]}"#,
    ),
    good: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><body name='ball' pos='0 0 1'><freejoint/><geom size='.05'/></body></worldbody></mujoco>", "controls": [{"label": "gravity (m/s²)", "set": "model.opt.gravity[2]", "min": -20, "max": 0, "step": 0.01, "value": -9.81, "reset": true}], "readouts": [{"label": "height (m)", "expr": "data.qpos[2]"}]}"#,
    ),
};

pub(super) const CHECK: Check = Check::Model(check_controls);

/// The vertical part of the gravity, as programs name it.
const GRAVITY: &str = "model.opt.gravity[2]";

/// Reports controls that give only values above 0 where the gravity of the model is below 0. A range with both signs is meant.
fn check_controls(lab: &Lab, model: &Model, findings: &mut Vec<Finding>) {
    if model.opt.gravity[2] >= 0.0 {
        return;
    }
    for control in lab.controls.iter().filter(|control| !is_meant(control.label.as_str())) {
        let is_up = |text: &&Text| is_upward(text.as_str(), control);
        let Some(text) = control.action().and_then(|a| a.set.as_ref()).filter(is_up).or_else(|| {
            let statements = match &control.kind {
                ControlKind::Button { run } => Some(run),
                _ => control.action().and_then(|action| action.apply.as_ref()),
            };
            statements.filter(|text| sets_upward(text.as_str(), control))
        }) else {
            continue;
        };
        findings.push(
            Finding::new(
                GRAVITY_UPWARD,
                text.span(),
                "this turns the gravity upward: its third number is above 0",
            )
            .help(format!("write `{GRAVITY} = -value` in `apply`, or give the control values below 0")),
        );
    }
}

/// Whether a label says that something acts upward.
fn is_meant(label: &str) -> bool {
    let words = super::label_names_another::words_of(label);
    words.iter().any(|word| {
        ["up", "upward", "upwards", "net", "oben", "aufwärts", "haut", "arriba"].contains(&word.as_str())
    })
}

/// Whether `set` names the gravity, and no value of the control is below 0.
fn is_upward(set: &str, control: &Control) -> bool {
    without_spaces(set) == GRAVITY && is_positive(control)
}

/// Whether statements assign the gravity the value of the control, or a number, above 0.
fn sets_upward(statements: &str, control: &Control) -> bool {
    let text = without_spaces(statements);
    let Some((_, rest)) = text.split_once(&format!("{GRAVITY}=")) else { return false };
    match rest.split(';').next().unwrap_or(rest) {
        "value" => is_positive(control),
        number => number.parse::<f64>().is_ok_and(|x| x > 0.0),
    }
}

fn without_spaces(text: &str) -> String {
    text.split_whitespace().collect()
}

/// Whether the values of a control are above 0, or 0.
fn is_positive(control: &Control) -> bool {
    match &control.kind {
        ControlKind::Slider { min, max, .. } => min.value >= 0.0 && max.value > 0.0,
        ControlKind::Select { options, .. } => {
            let numbers = options.iter().map(|option| option.value.number());
            let numbers: Option<Vec<f64>> = numbers.collect();
            numbers.is_some_and(|all| all.iter().all(|x| *x >= 0.0) && all.iter().any(|x| *x > 0.0))
        }
        ControlKind::Button { .. } => false,
    }
}
