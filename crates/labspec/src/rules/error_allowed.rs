use labspec_finding::{Example, Finding, Layer, Rule, Severity};
use std::ops::Range;

/// An error cannot be suppressed.
pub const ERROR_ALLOWED: &Rule = &Rule {
    code: "error-allowed",
    severity: Severity::Warning,
    exceptions: &[],
    layer: Layer::Structure,
    summary: "an error cannot be suppressed",
    why: "a broken or false lesson stays broken, whoever has reviewed it; only warnings and notes can be suppressed",
    bad: Example::Lab(
        r#"{"model": "ball", "controls": [{"label": "mass", "min": 1, "max": 5, "value": 1}], "lint": {"allow": ["⟦control-without-effect⟧"], "why": "later"}}"#,
    ),
    good: Example::Lab(
        r#"{"model": "ball", "controls": [{"label": "mass", "min": 1, "max": 5, "value": 1, "apply": "model.body_mass[1] = value; mj.mj_setConst(model, data)", "reset": true}]}"#,
    ),
};

/// Reports a suppression of an error.
pub(crate) fn refuse(code: &str, span: Range<usize>) -> Finding {
    Finding::new(ERROR_ALLOWED, span, format!("`{code}` is an error and cannot be suppressed"))
        .help("fix the error, then delete this code")
}
