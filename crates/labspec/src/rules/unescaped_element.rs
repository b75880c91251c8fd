use labspec_finding::{Example, Layer, Rule, Severity};

/// An MJCF element that is not escaped.
pub const UNESCAPED_ELEMENT: &Rule = &Rule {
    code: "unescaped-element",
    severity: Severity::Warning,
    layer: Layer::Structure,
    summary: "the name of a model element stands in the text as a tag",
    why: "a browser takes it for HTML: the name disappears, or a form control appears",
    bad: Example::Lesson("Both are set in the ⟦<option>⟧ element.\n"),
    good: Example::Lesson("Both are set in the `<option>` element, that is &lt;option&gt;.\n"),
};
