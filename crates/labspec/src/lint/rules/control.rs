//! Sliders, selects and buttons that cannot do what they promise.

use super::plot::{DISTINCT, repeated};
use crate::finding::{Finding, Severity};
use crate::spec::{ControlKind, Lab};
use labspec_finding::{Example, Layer, Rule};

/// `min` is not below `max`.
pub static EMPTY_RANGE: Rule = Rule {
    code: "empty-range",
    severity: Severity::Error,
    layer: Layer::Structure,
    summary: "the lower end of a range is not below its upper end",
    why: "the slider cannot move, or the plot has no height",
    bad: Example::Lab(
        r#"{"model": "ball", "controls": [{"label": "friction", "set": "model.geom_friction[0]", "min": 5, "max": 1, "value": 1}]}"#,
    ),
    good: Example::Lab(
        r#"{"model": "ball", "controls": [{"label": "friction", "set": "model.geom_friction[0]", "min": 1, "max": 5, "value": 1}]}"#,
    ),
};

/// A start value that the slider cannot show.
pub static SLIDER_VALUE: Rule = Rule {
    code: "slider-value",
    severity: Severity::Error,
    layer: Layer::Structure,
    summary: "the start value of a slider lies outside of its range",
    why: "the page moves the slider to the nearest end, but the lab starts with the value that is written here",
    bad: Example::Lab(
        r#"{"model": "ball", "controls": [{"label": "friction", "set": "model.geom_friction[0]", "min": 1, "max": 5, "value": 0.1}]}"#,
    ),
    good: Example::Lab(
        r#"{"model": "ball", "controls": [{"label": "friction", "set": "model.geom_friction[0]", "min": 0.1, "max": 5, "value": 0.1}]}"#,
    ),
};

/// A step that the range has no room for.
pub static SLIDER_STEP: Rule = Rule {
    code: "slider-step",
    severity: Severity::Error,
    layer: Layer::Structure,
    summary: "the step of a slider is not positive, or larger than its range",
    why: "the slider cannot be moved",
    bad: Example::Lab(
        r#"{"model": "ball", "controls": [{"label": "friction", "set": "model.geom_friction[0]", "min": 1, "max": 5, "step": 10, "value": 1}]}"#,
    ),
    good: Example::Lab(
        r#"{"model": "ball", "controls": [{"label": "friction", "set": "model.geom_friction[0]", "min": 1, "max": 5, "step": 0.1, "value": 1}]}"#,
    ),
};

/// A select that starts with none of its options.
pub static SELECT_VALUE: Rule = Rule {
    code: "select-value",
    severity: Severity::Error,
    layer: Layer::Structure,
    summary: "the start value of a select is none of its options",
    why: "the page shows the first option, but the lab starts with the value that is written here",
    bad: Example::Lab(
        r#"{"model": "ball", "controls": [{"type": "select", "label": "integrator", "set": "model.opt.integrator", "options": [["Euler", 0], ["RK4", 1]], "value": 3}]}"#,
    ),
    good: Example::Lab(
        r#"{"model": "ball", "controls": [{"type": "select", "label": "integrator", "set": "model.opt.integrator", "options": [["Euler", 0], ["RK4", 1]], "value": 1}]}"#,
    ),
};

/// Options that are not pairs, or none at all.
pub static SELECT_OPTIONS: Rule = Rule {
    code: "select-options",
    severity: Severity::Error,
    layer: Layer::Structure,
    summary: "the options of a select are not a list of [text, value] pairs",
    why: "the page shows the first element and assigns the second",
    bad: Example::Lab(
        r#"{"model": "ball", "controls": [{"type": "select", "label": "integrator", "set": "model.opt.integrator", "options": ["Euler", ["RK4", 1]], "value": 1}]}"#,
    ),
    good: Example::Lab(
        r#"{"model": "ball", "controls": [{"type": "select", "label": "integrator", "set": "model.opt.integrator", "options": [["Euler", 0], ["RK4", 1]], "value": 1}]}"#,
    ),
};

/// A control that changes nothing.
pub static NO_EFFECT: Rule = Rule {
    code: "control-without-effect",
    severity: Severity::Error,
    layer: Layer::Structure,
    summary: "a slider or select has none of `set`, `apply` and `param`",
    why: "it moves, but nothing in the lab changes",
    bad: Example::Lab(
        r#"{"model": "ball", "controls": [{"label": "mass", "min": 1, "max": 5, "value": 1}]}"#,
    ),
    good: Example::Lab(
        r#"{"model": "ball", "controls": [{"label": "friction", "set": "model.geom_friction[0]", "min": 1, "max": 5, "value": 1}]}"#,
    ),
};

/// Two controls with one label.
pub static DUPLICATE_CONTROL: Rule = Rule {
    code: "duplicate-control",
    severity: Severity::Warning,
    layer: Layer::Structure,
    summary: "two controls of a lab have the same label",
    why: "a student cannot tell them apart, and neither can a run that sets controls by their labels",
    bad: Example::Lab(
        r#"{"model": "ball", "controls": [{"label": "push", "type": "button", "run": "data.qvel[0] = 1"}, {"label": "push", "type": "button", "run": "data.qvel[1] = 1"}]}"#,
    ),
    good: Example::Lab(
        r#"{"model": "ball", "controls": [{"label": "push along x", "type": "button", "run": "data.qvel[0] = 1"}, {"label": "push along y", "type": "button", "run": "data.qvel[1] = 1"}]}"#,
    ),
};

/// A control with `set` and `apply`.
pub static APPLY_UNUSED: Rule = Rule {
    code: "apply-unused",
    severity: Severity::Warning,
    layer: Layer::Structure,
    summary: "a control has both `set` and `apply`",
    why: "the page does what `set` says and never looks at `apply`: those statements do nothing",
    bad: Example::Lab(
        r#"{"model": "ball", "controls": [{"label": "friction", "set": "model.geom_friction[0]", "apply": "mj.mj_setConst(model, data)", "min": 1, "max": 5, "value": 1}]}"#,
    ),
    good: Example::Lab(
        r#"{"model": "ball", "controls": [{"label": "mass", "apply": "model.body_mass[1] = value; mj.mj_setConst(model, data)", "min": 1, "max": 5, "value": 1, "reset": true}]}"#,
    ),
};

pub(in crate::lint) const RULES: &[&Rule] = &[
    &EMPTY_RANGE,
    &SLIDER_VALUE,
    &SLIDER_STEP,
    &SELECT_VALUE,
    &SELECT_OPTIONS,
    &NO_EFFECT,
    &DUPLICATE_CONTROL,
    &APPLY_UNUSED,
];

/// A select without options, found while it is read.
pub(crate) fn nothing_offered(span: std::ops::Range<usize>) -> Finding {
    Finding::new(&SELECT_OPTIONS, span.start..span.start + 1, "this select offers nothing")
        .help("write \"options\": [[\"Euler\", 0], [\"RK4\", 1]]")
}

pub(in crate::lint) fn check(lab: &Lab, findings: &mut Vec<Finding>) {
    for control in &lab.controls {
        match &control.kind {
            ControlKind::Slider { min, max, step, value, .. } => {
                if min.value >= max.value {
                    findings.push(
                        Finding::new(
                            &EMPTY_RANGE,
                            max.span.clone(),
                            format!("`max` is {}, not above `min`, which is {}", max.value, min.value),
                        )
                        .why("the slider cannot move")
                        .related(min.span.clone(), "the lower end")
                        .help(if min.value > max.value {
                            "swap the two ends"
                        } else {
                            "make `max` larger than `min`"
                        }),
                    );
                    continue;
                }
                if !(min.value..=max.value).contains(&value.value) {
                    let end = if value.value < min.value { min } else { max };
                    findings.push(
                        Finding::new(
                            &SLIDER_VALUE,
                            value.span.clone(),
                            format!(
                                "the start value {} is not between {} and {}",
                                value.value, min.value, max.value
                            ),
                        )
                        .related(end.span.clone(), "the nearest end")
                        .help("change the value, or widen the range so that it holds the value"),
                    );
                }
                if let Some(step) =
                    step.as_ref().filter(|s| s.value <= 0.0 || s.value > max.value - min.value)
                {
                    findings.push(
                        Finding::new(
                            &SLIDER_STEP,
                            step.span.clone(),
                            format!(
                                "a step of {} in a range from {} to {}",
                                step.value, min.value, max.value
                            ),
                        )
                        .help(format!(
                            "leave `step` out for a hundredth of the range, {}",
                            (max.value - min.value) / 100.0
                        )),
                    );
                }
            }
            ControlKind::Select { options, value, .. } => {
                if !options.is_empty() && !options.iter().any(|o| o.value.same(value)) {
                    let all: Vec<String> = options.iter().take(8).map(|o| o.value.show()).collect();
                    findings.push(
                        Finding::new(
                            &SELECT_VALUE,
                            value.span(),
                            format!("{} is none of the options", value.show()),
                        )
                        .help(format!("write one of their values: {}", all.join(", "))),
                    );
                }
            }
            ControlKind::Button { .. } => {}
        }
        if let Some(action) = control.action()
            && let (Some(set), Some(apply)) = (&action.set, &action.apply)
        {
            findings.push(
                Finding::new(
                    &APPLY_UNUSED,
                    apply.span(),
                    format!(
                        "{} never does this: it also has `set`",
                        crate::json::read::named(control.label.as_str())
                    ),
                )
                .related(set.span(), "what it does instead")
                .help(format!(
                    "leave `set` out, and begin these statements with `{} = value;`",
                    crate::json::read::shorten(set.as_str())
                )),
            );
        }
        if let Some(action) = control.action()
            && action.set.is_none()
            && action.apply.is_none()
            && action.param.is_none()
        {
            findings.push(
                Finding::new(&NO_EFFECT, control.label.span(), format!("{} changes nothing", crate::json::read::named(control.label.as_str())))
                    .help("add \"set\": the field that gets the value, \"apply\": statements that use `value`, or \"param\": a name read as ctx.NAME"),
            );
        }
    }
    let labels = lab.controls.iter().map(|c| &c.label);
    repeated(&DUPLICATE_CONTROL, "controls have the label", DISTINCT, labels, findings);
}
