use labspec_finding::{Example, Layer, Rule, Severity};

/// A block that is not indented.
pub const LISTING_INDENTATION: &Rule = &Rule {
    code: "listing-indentation",
    severity: Severity::Warning,
    layer: Layer::Source,
    summary: "a Python listing lost its indentation",
    why: "a line that ends with a colon needs an indented line below it; the listing does not run",
    bad: Example::Lesson("```python\nfor step in range(10):\n⟦print(step)⟧\n```\n"),
    good: Example::Lesson("```python\nfor step in range(10):\n    print(step)\n```\n"),
};
