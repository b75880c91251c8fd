use crate::finding::Finding;
use labspec_finding::{Example, Layer, Rule, Severity};

/// A plot without curves.
pub const EMPTY_PLOT: &Rule = &Rule {
    code: "empty-plot",
    severity: Severity::Error,
    layer: Layer::Structure,
    summary: "a plot has no traces",
    why: "it shows an empty frame",
    bad: Example::Lab(r#"{"model": "ball", "plots": [⟦{⟧"ylabel": "height (m)", "traces": []}]}"#),
    good: Example::Lab(
        r#"{"model": "ball", "plots": [{"ylabel": "height (m)", "traces": [{"label": "ball", "expr": "data.qpos[2]"}]}]}"#,
    ),
};

/// A plot without traces, found while it is read.
pub(crate) fn empty(plot: std::ops::Range<usize>) -> Finding {
    Finding::new(EMPTY_PLOT, plot.start..plot.start + 1, "this plot has no traces")
        .help("add \"traces\": [{\"label\": \"height (m)\", \"expr\": \"data.qpos[2]\"}]")
}
