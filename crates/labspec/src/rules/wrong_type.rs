use labspec_finding::{Example, Layer, Rule, Severity};

/// A value has another type than its key takes.
pub const WRONG_TYPE: &Rule = &Rule {
    code: "wrong-type",
    severity: Severity::Error,
    layer: Layer::Structure,
    summary: "a value has another type than its key takes",
    why: "the page uses the value as it is, and computes or shows nonsense",
    bad: Example::Lab(r#"{"model": "ball", "stopAt": ⟦"2"⟧}"#),
    good: Example::Lab(r#"{"model": "ball", "stopAt": 2}"#),
};
