//! Keys of objects: unknown, missing, of the wrong type. The checks are in `json/read.rs`.

use crate::finding::Severity;
use labspec_finding::{Example, Layer, Rule};

/// A key that the format does not have.
pub static UNKNOWN_KEY: Rule = Rule {
    code: "unknown-key",
    severity: Severity::Error,
    layer: Layer::Structure,
    summary: "an object has a key that the format does not know",
    why: "the page ignores it, so what it should do does not happen",
    bad: Example::Lab(
        r#"{"model": "ball", "readouts": [{"label": "t", "exp": "data.time", "expr": "data.time"}]}"#,
    ),
    good: Example::Lab(r#"{"model": "ball", "readouts": [{"label": "t", "expr": "data.time"}]}"#),
};

/// A key that must be there.
pub static MISSING_KEY: Rule = Rule {
    code: "missing-key",
    severity: Severity::Error,
    layer: Layer::Structure,
    summary: "an object lacks a key that it needs",
    why: "the page shows an empty place, or stops there",
    bad: Example::Lab(r#"{"model": "ball", "readouts": [{"label": "time (s)"}]}"#),
    good: Example::Lab(r#"{"model": "ball", "readouts": [{"label": "time (s)", "expr": "data.time"}]}"#),
};

/// A value of another type than the key has.
pub static WRONG_TYPE: Rule = Rule {
    code: "wrong-type",
    severity: Severity::Error,
    layer: Layer::Structure,
    summary: "a value has another type than its key takes",
    why: "the page takes the value as it is, and computes or shows nonsense with it",
    bad: Example::Lab(r#"{"model": "ball", "stopAt": "2"}"#),
    good: Example::Lab(r#"{"model": "ball", "stopAt": 2}"#),
};

pub(in crate::lint) const RULES: &[&Rule] = &[&UNKNOWN_KEY, &MISSING_KEY, &WRONG_TYPE];
