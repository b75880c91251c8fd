use labspec_finding::{Example, Finding, Layer, Rule, Severity};
use std::ops::Range;

/// A plot has no traces.
pub const EMPTY_PLOT: &Rule = &Rule {
    code: "empty-plot",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Structure,
    summary: "a plot has no traces",
    why: "the page shows an empty frame",
    bad: Example::Lab(r#"{"model": "ball", "plots": [⟦{⟧"ylabel": "height (m)", "traces": []}]}"#),
    good: Example::Lab(
        r#"{"model": "ball", "plots": [{"ylabel": "height (m)", "traces": [{"label": "ball", "expr": "data.qpos[2]"}]}]}"#,
    ),
};

/// Reports a plot without traces.
pub(crate) fn without_traces(span: Range<usize>) -> Finding {
    Finding::new(EMPTY_PLOT, span, "this plot has no traces")
        .help("add \"traces\": [{\"label\": \"height (m)\", \"expr\": \"data.qpos[2]\"}]")
}
