use crate::json::read::shorten;
use labspec_finding::{Example, Finding, Layer, Rule, Severity};
use std::ops::Range;

/// A key is written twice in one object.
pub const DUPLICATE_KEY: &Rule = &Rule {
    code: "duplicate-key",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Json,
    summary: "a key is written twice in one object",
    why: "only the last value counts; the page silently ignores the others",
    bad: Example::Lab(r#"{"model": "ball", "stopAt": 1, "⟦stopAt⟧": 2}"#),
    good: Example::Lab(r#"{"model": "ball", "stopAt": 2}"#),
};

/// Reports a repeated key. `first`: the place of its first occurrence.
pub(crate) fn duplicate(span: Range<usize>, key: &str, first: Option<Range<usize>>) -> Finding {
    let key = if key.is_empty() { "a key without a name".into() } else { format!("`{}`", shorten(key)) };
    let finding = Finding::new(DUPLICATE_KEY, span, format!("{key} appears twice in one object"))
        .help("keep one of the two");
    match first {
        Some(first) => finding.related(first, "the first one, which the page ignores"),
        None => finding,
    }
}
