use crate::finding::Finding;
use labspec_finding::{Example, Layer, Rule, Severity};

/// A `verify` object that claims nothing.
pub const VERIFY_NOTHING: &Rule = &Rule {
    code: "verify-nothing",
    severity: Severity::Warning,
    layer: Layer::Structure,
    summary: "a `verify` object claims nothing",
    why: "its runs are made, but nothing is compared with them",
    bad: Example::Lab(
        r#"{"model": "ball", "note": "It rests at 0.10 m.", "verify": ⟦{⟧"runs": {"drop": {"until": 2}}}}"#,
    ),
    good: Example::Lab(
        r#"{"model": "ball", "note": "It rests at 0.10 m.", "verify": {"runs": {"drop": {"until": 2}}, "says": [["0.10 m", "final(data.qpos[2])"]]}}"#,
    ),
};

/// An object without claims, found while it is read.
pub(crate) fn claims_nothing(verify: std::ops::Range<usize>) -> Finding {
    Finding::new(VERIFY_NOTHING, verify.start..verify.start + 1, "nothing is compared with these runs")
        .help("add `options`, `value`, `says` or `exact`")
}
