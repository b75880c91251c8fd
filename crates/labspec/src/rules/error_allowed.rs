use labspec_finding::{Example, Layer, Rule, Severity};

/// An allowance of an error.
pub const ERROR_ALLOWED: &Rule = &Rule {
    code: "error-allowed",
    severity: Severity::Warning,
    layer: Layer::Structure,
    summary: "an error is allowed, and told all the same",
    why: "what is broken or false stays so, whoever has looked at it; only doubts can be put aside",
    bad: Example::Lab(
        r#"{"model": "ball", "controls": [{"label": "mass", "min": 1, "max": 5, "value": 1}], "lint": {"allow": ["⟦control-without-effect⟧"], "why": "later"}}"#,
    ),
    good: Example::Lab(
        r#"{"model": "ball", "controls": [{"label": "mass", "min": 1, "max": 5, "value": 1, "apply": "model.body_mass[1] = value; mj.mj_setConst(model, data)", "reset": true}]}"#,
    ),
};
