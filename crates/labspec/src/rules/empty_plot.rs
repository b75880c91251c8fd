use labspec_finding::{Example, Layer, Rule, Severity};

/// A plot has no traces.
pub const EMPTY_PLOT: &Rule = &Rule {
    code: "empty-plot",
    severity: Severity::Error,
    layer: Layer::Structure,
    summary: "a plot has no traces",
    why: "the page shows an empty frame",
    bad: Example::Lab(r#"{"model": "ball", "plots": [⟦{⟧"ylabel": "height (m)", "traces": []}]}"#),
    good: Example::Lab(
        r#"{"model": "ball", "plots": [{"ylabel": "height (m)", "traces": [{"label": "ball", "expr": "data.qpos[2]"}]}]}"#,
    ),
};
