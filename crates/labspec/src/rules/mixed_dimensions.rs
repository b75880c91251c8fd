use crate::bind::Bound;
use crate::source::Text;
use labspec_bind::units::written;
use labspec_expr::{DimensionClash, TextDimensions};
use labspec_finding::{Example, Finding, Layer, Rule, Severity};

/// An expression adds or compares quantities of different dimensions.
pub const MIXED_DIMENSIONS: &Rule = &Rule {
    code: "mixed-dimensions",
    severity: Severity::Warning,
    exceptions: &[(Severity::Note, "in statements, because a controller may have gains of 1")],
    layer: Layer::Program,
    summary: "an expression adds or compares quantities of different dimensions",
    why: "a sum of metres and seconds means nothing: often an index is off by one, or a factor is missing. In statements it is only a note, because a controller may have gains of 1. A literal factor may carry a unit, so a sum with one is not reported",
    bad: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><body name='left'><joint name='left' type='slide'/><geom size='.05'/></body><body name='right' pos='1 0 0'><joint name='right' type='slide'/><geom size='.05'/></body></worldbody></mujoco>", "setup": "data.qvel[0] = 0.1", "readouts": [{"label": "place", "expr": "⟦data.qpos[0] + data.qvel[0]⟧"}]}"#,
    ),
    good: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><body name='left'><joint name='left' type='slide'/><geom size='.05'/></body><body name='right' pos='1 0 0'><joint name='right' type='slide'/><geom size='.05'/></body></worldbody></mujoco>", "setup": "data.qvel[0] = 0.1", "readouts": [{"label": "place", "expr": "data.qpos[0] + data.qvel[0] * data.time"}]}"#,
    ),
};

/// Reports sums and comparisons of incompatible quantities.
pub(crate) fn clashes(bound: &Bound, measured: &TextDimensions, severity: Severity) -> Vec<Finding> {
    measured.clashes.iter().map(|clash| clash_finding(&bound.text, clash, severity)).collect()
}

/// The finding about one of them.
pub(crate) fn clash_finding(text: &Text, clash: &DimensionClash, severity: Severity) -> Finding {
    let message = format!("{} and {} are added or compared", written(&clash.left), written(&clash.right));
    let mut found = Finding::new(MIXED_DIMENSIONS, text.span_of(clash.span.into()), message)
        .help("check the index and the field: one of the two may be a different quantity than intended");
    found.severity = severity;
    found
}
