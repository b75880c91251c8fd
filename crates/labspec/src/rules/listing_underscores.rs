use labspec_finding::{Example, Layer, Rule, Severity};

/// A Python listing has lost the underscores of `__name__`.
pub const LISTING_UNDERSCORES: &Rule = &Rule {
    code: "listing-underscores",
    severity: Severity::Warning,
    layer: Layer::Source,
    summary: "a Python listing has lost the underscores of `__name__`",
    why: "Markdown reads double underscores outside a fence as emphasis; the listing does not run",
    bad: Example::Lesson("```python\n⟦if name⟧ == \"main\":\n    main()\n```\n"),
    good: Example::Lesson("```python\nif __name__ == \"__main__\":\n    main()\n```\n"),
};
