use labspec_finding::{Example, Layer, Rule, Severity};

/// A formula or a group in it is not closed.
pub const FORMULA_UNBALANCED: &Rule = &Rule {
    code: "formula-unbalanced",
    severity: Severity::Warning,
    layer: Layer::Structure,
    summary: "a formula or a group in it is not closed",
    why: "the page shows the source of the formula, or an error in red",
    bad: Example::Quiz(
        r#"{"id": "fall", "questions": [{"kind": "open", "q": "Why is it ⟦$\\frac{1}{2 g t^2$⟧?"}]}"#,
    ),
    good: Example::Quiz(
        r#"{"id": "fall", "questions": [{"kind": "open", "q": "Why is it $\\frac{1}{2} g t^2$?"}]}"#,
    ),
};
