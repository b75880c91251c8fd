use labspec_finding::{Example, Layer, Rule, Severity};

/// A value of another type than the key has.
pub const WRONG_TYPE: &Rule = &Rule {
    code: "wrong-type",
    severity: Severity::Error,
    layer: Layer::Structure,
    summary: "a value has another type than its key takes",
    why: "the page takes the value as it is, and computes or shows nonsense with it",
    bad: Example::Lab(r#"{"model": "ball", "stopAt": ⟦"2"⟧}"#),
    good: Example::Lab(r#"{"model": "ball", "stopAt": 2}"#),
};
