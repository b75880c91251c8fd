use crate::bind::{ModelNames, Scope};
use crate::check::assignments::{assignments, without_spaces};
use crate::json::read::Scalar;
use crate::source::Text;
use crate::spec::{Control, ControlKind, Lab};
use labspec_core::Model;
use labspec_expr::{Compiler, Globals, Role, Schema};
use labspec_finding::{Example, Finding, Layer, Rule, Severity};

/// A control without a unit stores degrees in an angle in rad.
pub const DEGREES_WITHOUT_UNIT: &Rule = &Rule {
    code: "degrees-without-unit",
    severity: Severity::Warning,
    exceptions: &[],
    layer: Layer::Program,
    summary: "a control stores numbers that look like degrees in an angle in rad",
    why: "the coordinate of a hinge is in rad: 30 is almost five turns",
    bad: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><body><joint name='hinge' axis='0 1 0' damping='0.1'/><geom type='capsule' size='.02' fromto='0 0 0 0 0 -1'/></body></worldbody></mujoco>", "stopAt": 1, "controls": [{"label": "start", "min": 0, "max": 90, "step": 1, "value": 30, "set": "⟦data.qpos[0]⟧", "init": true, "reset": true}], "readouts": [{"label": "angle", "expr": "data.qpos[0]", "digits": 1}]}"#,
    ),
    good: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><body><joint name='hinge' axis='0 1 0' damping='0.1'/><geom type='capsule' size='.02' fromto='0 0 0 0 0 -1'/></body></worldbody></mujoco>", "stopAt": 1, "controls": [{"label": "start", "unit": "deg", "min": 0, "max": 90, "step": 1, "value": 30, "apply": "data.qpos[0] = lib.rad(value)", "init": true, "reset": true}], "readouts": [{"label": "angle", "expr": "data.qpos[0]", "digits": 1}]}"#,
    ),
};

/// Two turns; a smaller number may be an angle in rad.
const TWO_TURNS: f64 = 4.0 * std::f64::consts::PI;

pub(crate) fn check_controls(lab: &Lab, model: &Model, findings: &mut Vec<Finding>) {
    let names = ModelNames::new(model, Scope::Lab);
    for control in lab.authored_controls() {
        let Some(action) = control.action() else { continue };
        check_unit(lab, control, findings);
        if !looks_like_degrees(control) {
            continue;
        }
        let found = match (&action.set, &action.apply, &action.param) {
            (Some(target), ..) => is_angle(&names, target.as_str()).then(|| target.span()),
            (None, Some(apply), _) => stored_unconverted(&names, apply, "value"),
            (None, None, Some(param)) => {
                let name = format!("ctx.{}", param.value);
                [&lab.setup, &lab.controller]
                    .into_iter()
                    .flatten()
                    .find_map(|t| stored_unconverted(&names, t, &name))
            }
            _ => None,
        };
        let Some(span) = found else { continue };
        let name = action.param.as_ref().map_or("value".to_owned(), |p| format!("ctx.{}", p.value));
        findings.push(
            Finding::new(
                DEGREES_WITHOUT_UNIT,
                span,
                format!("this angle is in rad, but \"{}\" gives degrees", control.label.value),
            )
            .related(control.label.span(), "the control")
            .help(format!(
                "store `lib.rad({name})`, for a `set` with `apply`, and give the control the unit `deg`"
            )),
        );
    }
}

/// Whether the values of a control are degrees: whole numbers, the largest of them more than two turns in rad.
fn looks_like_degrees(control: &Control) -> bool {
    let of_degrees = |x: f64| x % 5.0 == 0.0 && x.abs() <= 720.0;
    match &control.kind {
        ControlKind::Slider { unit: None, min, max, .. } => {
            of_degrees(min.value) && of_degrees(max.value) && max.value.abs().max(min.value.abs()) > TWO_TURNS
        }
        ControlKind::Select { options, .. } => {
            let number = |s: &Scalar| if let Scalar::Number(n) = s { Some(n.value) } else { None };
            let all: Vec<f64> = options.iter().filter_map(|o| number(&o.value)).collect();
            all.len() == options.len()
                && all.iter().all(|x| of_degrees(*x))
                && all.iter().any(|x| x.abs() > TWO_TURNS)
        }
        _ => false,
    }
}

/// The place where a text stores a value without conversion in an angle.
fn stored_unconverted(names: &dyn Schema, text: &Text, name: &str) -> Option<std::ops::Range<usize>> {
    // A fallback, as in `ctx.a || 0`, is no conversion.
    let is_plain = |value: &str| {
        let value = without_spaces(value);
        let inside = value.trim_start_matches(['(', '-']).trim_end_matches(')');
        let rest = inside.strip_prefix(name);
        rest.is_some_and(|rest| rest.is_empty() || rest.starts_with("||") || rest.starts_with("??"))
    };
    let stored = assignments(text)
        .into_iter()
        .find(|a| a.op.is_none() && is_plain(&a.value) && is_angle(names, &a.target))?;
    Some(text.span_of(stored.span.into()))
}

/// Whether an expression is an element that is an angle.
fn is_angle(names: &dyn Schema, target: &str) -> bool {
    let mut globals = Globals::new();
    let Some(program) = Compiler::new(names, &mut globals).expression(target).program else { return false };
    match program.effects().reads.as_slice() {
        [access] if access.count == Some(1) => names.role(access.field, access.first) == Role::Angle,
        _ => false,
    }
}

/// Reports a unit of radians whose value a program converts from degrees.
fn check_unit(lab: &Lab, control: &Control, findings: &mut Vec<Finding>) {
    let ControlKind::Slider { unit: Some(unit), max, min, action, .. } = &control.kind else { return };
    if unit.as_str().trim() != "rad" || max.value.abs().max(min.value.abs()) <= TWO_TURNS {
        return;
    }
    let (name, texts) = match &action.param {
        Some(param) => (format!("ctx.{}", param.value), vec![&lab.setup, &lab.controller]),
        None => ("value".to_owned(), vec![&action.apply]),
    };
    let forms = [format!("lib.rad({name})"), format!("{name}*Math.PI/180"), format!("Math.PI/180*{name}")];
    let converts = |text: &&Text| {
        let text = without_spaces(text.as_str());
        forms.iter().any(|form| text.contains(form))
    };
    if texts.into_iter().flatten().any(|text| converts(&text)) {
        findings.push(
            Finding::new(
                DEGREES_WITHOUT_UNIT,
                unit.span(),
                format!("the unit is rad, but `{name}` is converted from degrees"),
            )
            .why(format!("a student reads {} rad, and the lab takes degrees", max.value))
            .help("write the unit `deg`, or store the value without the conversion"),
        );
    }
}
