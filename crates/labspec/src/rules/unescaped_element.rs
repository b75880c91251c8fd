use labspec_finding::{Example, Layer, Rule, Severity};

/// The text contains the name of an MJCF element as a tag.
pub const UNESCAPED_ELEMENT: &Rule = &Rule {
    code: "unescaped-element",
    severity: Severity::Warning,
    layer: Layer::Structure,
    summary: "the text contains the name of an MJCF element as a tag",
    why: "a browser reads it as HTML: the name disappears, or a form control appears",
    bad: Example::Lesson("Both are set in the ⟦<option>⟧ element.\n"),
    good: Example::Lesson("Both are set in the `<option>` element, that is &lt;option&gt;.\n"),
};
