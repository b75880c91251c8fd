use labspec_finding::{Example, Finding, Layer, Rule, Severity};
use std::ops::Range;

/// A `verify` object claims nothing.
pub const VERIFY_NOTHING: &Rule = &Rule {
    code: "verify-nothing",
    severity: Severity::Warning,
    exceptions: &[],
    layer: Layer::Structure,
    summary: "a `verify` object claims nothing",
    why: "its runs are executed, but the checker compares nothing with them",
    bad: Example::Lab(
        r#"{"model": "ball", "note": "It rests at 0.10 m.", "verify": ⟦{⟧"runs": {"drop": {"until": 2}}}}"#,
    ),
    good: Example::Lab(
        r#"{"model": "ball", "note": "It rests at 0.10 m.", "verify": {"runs": {"drop": {"until": 2}}, "says": [["0.10 m", "final(data.qpos[2])"]]}}"#,
    ),
};

/// Reports a definition with claims: they are not about any text.
pub(crate) fn claims_in_definition(span: Range<usize>) -> Finding {
    Finding::new(VERIFY_NOTHING, span, "the claims of a definition are not checked")
        .why("a definition has only runs, measures and searches, which other `verify` objects use")
        .help("move the claims into the `verify` object that uses it")
}

/// Reports a `verify` object that has only runs.
pub(crate) fn claims_nothing(span: Range<usize>) -> Finding {
    Finding::new(VERIFY_NOTHING, span, "nothing is compared with these runs")
        .help("add `options`, `value`, `says` or `exact`")
}
