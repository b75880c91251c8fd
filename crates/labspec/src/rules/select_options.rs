use labspec_finding::{Example, Layer, Rule, Severity};

/// The options of a select are not a list of pairs of text and value.
pub const SELECT_OPTIONS: &Rule = &Rule {
    code: "select-options",
    severity: Severity::Error,
    layer: Layer::Structure,
    summary: "the options of a select are not a list of [text, value] pairs",
    why: "the page shows the first element and assigns the second",
    bad: Example::Lab(
        r#"{"model": "ball", "controls": [{"type": "select", "label": "integrator", "set": "model.opt.integrator", "options": [⟦"Euler"⟧, ["RK4", 1]], "value": 1}]}"#,
    ),
    good: Example::Lab(
        r#"{"model": "ball", "controls": [{"type": "select", "label": "integrator", "set": "model.opt.integrator", "options": [["Euler", 0], ["RK4", 1]], "value": 1}]}"#,
    ),
};
