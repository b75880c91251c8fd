use super::Check;
use crate::json::Number;
use crate::spec::{ControlKind, Lab};
use labspec_finding::{Example, Finding, Layer, Rule, Severity};

/// The lower end of a range is not below its upper end.
pub const EMPTY_RANGE: &Rule = &Rule {
    code: "empty-range",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Structure,
    summary: "the lower end of a range is not below its upper end",
    why: "the slider cannot move, or the plot has no height",
    bad: Example::Lab(
        r#"{"model": "ball", "controls": [{"label": "friction", "set": "model.geom_friction[0]", "min": 5, "max": ⟦1⟧, "value": 1}]}"#,
    ),
    good: Example::Lab(
        r#"{"model": "ball", "controls": [{"label": "friction", "set": "model.geom_friction[0]", "min": 1, "max": 2, "value": 1}]}"#,
    ),
};

pub(super) const CHECK: Check = Check::Lab(check_lab);

fn check_lab(lab: &Lab, findings: &mut Vec<Finding>) {
    for control in &lab.controls {
        if let ControlKind::Slider { min, max, .. } = &control.kind {
            findings.extend(ends(min, max, ["min", "max"]).map(|found| {
                found.why("the slider cannot move").help(if min.value > max.value {
                    format!("swap the two ends: `\"min\": {}, \"max\": {}`", max.value, min.value)
                } else {
                    "make `max` larger than `min`".to_string()
                })
            }));
        }
    }
    for plot in &lab.plots {
        if let (Some(min), Some(max)) = (&plot.ymin, &plot.ymax) {
            findings.extend(ends(min, max, ["ymin", "ymax"]).map(|found| {
                found
                    .why("the plot has no height")
                    .help("swap the two, or delete both: the axis then follows the data")
            }));
        }
    }
}

fn ends(min: &Number, max: &Number, [low, high]: [&str; 2]) -> Option<Finding> {
    let message = format!("`{high}` is {}, not above `{low}`, which is {}", max.value, min.value);
    let found = || Finding::new(EMPTY_RANGE, max.span.clone(), message);
    (min.value >= max.value).then(|| found().related(min.span.clone(), "the lower end"))
}
