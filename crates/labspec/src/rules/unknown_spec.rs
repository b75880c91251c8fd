use labspec_finding::{Example, Finding, Layer, Rule, Severity};
use std::ops::Range;

/// A JSON file holds neither a lab nor a quiz.
pub const UNKNOWN_SPEC: &Rule = &Rule {
    code: "unknown-spec",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Source,
    summary: "a JSON file holds neither a lab nor a quiz",
    why: "the page can show nothing of it",
    bad: Example::Json(r#"⟦{⟧"title": "Falling"}"#),
    good: Example::Json(r#"{"title": "Falling", "model": "ball"}"#),
};

/// Reports an object without any of the keys that identify labs and quizzes.
pub(crate) fn unrecognized(span: Range<usize>) -> Finding {
    Finding::new(UNKNOWN_SPEC, span, "the object is neither a lab nor a quiz")
        .help("add `model` or `xml` for a lab, or `questions` for a quiz")
}
