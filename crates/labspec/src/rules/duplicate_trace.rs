use super::Check;
use super::repeated::{DISTINCT, repeated};
use crate::spec::Lab;
use labspec_finding::{Example, Finding, Layer, Rule, Severity};

/// Two traces of a plot have the same label.
pub const DUPLICATE_TRACE: &Rule = &Rule {
    code: "duplicate-trace",
    severity: Severity::Warning,
    exceptions: &[],
    layer: Layer::Structure,
    summary: "two traces of a plot have the same label",
    why: "a student cannot tell them apart in the legend",
    bad: Example::Lab(
        r#"{"model": "ball", "plots": [{"traces": [{"label": "z", "expr": "data.qpos[2]"}, {"label": "⟦z⟧", "expr": "data.qpos[7]"}]}]}"#,
    ),
    good: Example::Lab(
        r#"{"model": "ball", "plots": [{"traces": [{"label": "height", "expr": "data.qpos[2]"}, {"label": "angle", "expr": "data.qpos[7]"}]}]}"#,
    ),
};

pub(super) const CHECK: Check = Check::Lab(check_lab);

fn check_lab(lab: &Lab, findings: &mut Vec<Finding>) {
    for plot in &lab.plots {
        let labels = plot.traces.iter().map(|t| &t.label);
        repeated(DUPLICATE_TRACE, "traces of this plot have the label", DISTINCT, labels, findings);
    }
}
