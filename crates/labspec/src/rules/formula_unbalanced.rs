use labspec_finding::{Example, Layer, Rule, Severity};

/// A formula that is not closed, or something in it.
pub const FORMULA_UNBALANCED: &Rule = &Rule {
    code: "formula-unbalanced",
    severity: Severity::Warning,
    layer: Layer::Structure,
    summary: "a formula, or something in it, is opened and not closed",
    why: "the page shows the source of the formula, or an error in red, instead of it",
    bad: Example::Quiz(
        r#"{"id": "fall", "questions": [{"kind": "open", "q": "Why is it ⟦$\\frac{1}{2 g t^2$⟧?"}]}"#,
    ),
    good: Example::Quiz(
        r#"{"id": "fall", "questions": [{"kind": "open", "q": "Why is it $\\frac{1}{2} g t^2$?"}]}"#,
    ),
};
