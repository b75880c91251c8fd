//! JSON that a page cannot read. The checks are in `json/`.

use crate::finding::Severity;
use labspec_finding::{Example, Layer, Rule};

/// The JSON of a block is broken.
pub static SYNTAX: Rule = Rule {
    code: "json-syntax",
    severity: Severity::Error,
    layer: Layer::Json,
    summary: "the JSON of a block is broken",
    why: "the page reads the block as a whole, so one wrong character removes the whole lab or quiz",
    bad: Example::Lab(r#"{"model": "ball", "stopAt": 2 "dock": true}"#),
    good: Example::Lab(r#"{"model": "ball", "stopAt": 2, "dock": true}"#),
};

/// A key is written twice in one object.
pub static DUPLICATE_KEY: Rule = Rule {
    code: "duplicate-key",
    severity: Severity::Error,
    layer: Layer::Json,
    summary: "a key is written twice in one object",
    why: "only the last one counts; the other is silently ignored",
    bad: Example::Lab(r#"{"model": "ball", "stopAt": 1, "stopAt": 2}"#),
    good: Example::Lab(r#"{"model": "ball", "stopAt": 2}"#),
};

/// JSON beyond the limits.
pub static LIMIT: Rule = Rule {
    code: "json-limit",
    severity: Severity::Error,
    layer: Layer::Json,
    summary: "the JSON is nested too deeply or holds too many values",
    why: "limits keep a checker and a page responsive whatever they are given",
    bad: Example::Lab(
        r#"{"model": [[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[["ball"]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]}"#,
    ),
    good: Example::Lab(r#"{"model": "ball"}"#),
};

pub(in crate::lint) const RULES: &[&Rule] = &[&SYNTAX, &DUPLICATE_KEY, &LIMIT];
