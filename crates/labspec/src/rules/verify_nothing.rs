use labspec_finding::{Example, Finding, Layer, Rule, Severity};
use std::ops::Range;

/// A `verify` object claims nothing.
pub const VERIFY_NOTHING: &Rule = &Rule {
    code: "verify-nothing",
    severity: Severity::Warning,
    layer: Layer::Structure,
    summary: "a `verify` object claims nothing",
    why: "its runs are made, but the checker compares nothing with them",
    bad: Example::Lab(
        r#"{"model": "ball", "note": "It rests at 0.10 m.", "verify": ⟦{⟧"runs": {"drop": {"until": 2}}}}"#,
    ),
    good: Example::Lab(
        r#"{"model": "ball", "note": "It rests at 0.10 m.", "verify": {"runs": {"drop": {"until": 2}}, "says": [["0.10 m", "final(data.qpos[2])"]]}}"#,
    ),
};

/// Reports a `verify` object that has only runs.
pub(crate) fn claims_nothing(span: Range<usize>) -> Finding {
    Finding::new(VERIFY_NOTHING, span, "nothing is compared with these runs")
        .help("add `options`, `value`, `says` or `exact`")
}
