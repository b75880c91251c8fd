use labspec_finding::{Example, Layer, Rule, Severity};

/// A Python listing has lost its line breaks.
pub const LISTING_LINE_BREAKS: &Rule = &Rule {
    code: "listing-line-breaks",
    severity: Severity::Warning,
    layer: Layer::Source,
    summary: "a Python listing has lost its line breaks",
    why: "several statements are on one line, which Python does not accept",
    bad: Example::Lesson("```python\ndef fall(h): z = 1.0 ⟦v = 0.0 return z - v * h⟧\n```\n"),
    good: Example::Lesson("```python\ndef fall(h):\n    z = 1.0\n    v = 0.0\n    return z - v * h\n```\n"),
};
