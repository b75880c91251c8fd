use super::Check;
use crate::spec::Lab;
use labspec_finding::{Example, Finding, Layer, Rule, Severity};

/// A lab has neither `model` nor `xml`, or has both.
pub const ONE_MODEL: &Rule = &Rule {
    code: "one-model",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Structure,
    summary: "a lab has neither `model` nor `xml`, or has both",
    why: "a lab simulates exactly one model",
    bad: Example::Lab(r#"⟦{⟧"title": "Falling", "readouts": [{"label": "t", "expr": "data.time"}]}"#),
    good: Example::Lab(
        r#"{"title": "Falling", "model": "ball", "readouts": [{"label": "t", "expr": "data.time"}]}"#,
    ),
};

pub(super) const CHECK: Check = Check::Lab(check_lab);

fn check_lab(lab: &Lab, findings: &mut Vec<Finding>) {
    match (&lab.model, &lab.xml) {
        (Some(model), Some(xml)) => findings.push(
            Finding::new(ONE_MODEL, xml.span(), "this lab has both `model` and `xml`")
                .related(model.span(), "the model is named here")
                .help("delete one of the two"),
        ),
        (None, None) => findings.push(
            Finding::new(
                ONE_MODEL,
                lab.span.start..lab.span.start + 1,
                "this lab has neither `model` nor `xml`",
            )
            .help(
                "add \"model\": \"NAME\" for a model in the model folder, or \"xml\": \"<mujoco>…</mujoco>\"",
            ),
        ),
        _ => {}
    }
}
