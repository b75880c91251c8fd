use labspec_finding::{Example, Layer, Rule, Severity};

/// Underscores that Markdown took for emphasis.
pub const LISTING_UNDERSCORES: &Rule = &Rule {
    code: "listing-underscores",
    severity: Severity::Warning,
    layer: Layer::Source,
    summary: "a Python listing lost the underscores of `__name__`",
    why: "Markdown takes double underscores for emphasis outside of a fence; the listing does not run",
    bad: Example::Lesson("```python\n⟦if name⟧ == \"main\":\n    main()\n```\n"),
    good: Example::Lesson("```python\nif __name__ == \"__main__\":\n    main()\n```\n"),
};
