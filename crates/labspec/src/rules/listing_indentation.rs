use labspec_finding::{Example, Layer, Rule, Severity};

/// A Python listing has lost its indentation.
pub const LISTING_INDENTATION: &Rule = &Rule {
    code: "listing-indentation",
    severity: Severity::Warning,
    layer: Layer::Source,
    summary: "a Python listing has lost its indentation",
    why: "the line below a line that ends with a colon needs indentation; the listing does not run",
    bad: Example::Lesson("```python\nfor step in range(10):\n⟦print(step)⟧\n```\n"),
    good: Example::Lesson("```python\nfor step in range(10):\n    print(step)\n```\n"),
};
