use super::Check;
use crate::spec::Lab;
use crate::spec::format::LAB;
use labspec_finding::{Example, Finding, Layer, Rule, Severity};

/// `key` is negative.
pub const KEYFRAME_RANGE: &Rule = &Rule {
    code: "keyframe-range",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Structure,
    summary: "`key` is negative",
    why: "keyframes are counted from 0; the page silently ignores a negative one",
    bad: Example::Lab(r#"{"model": "ball", "key": ⟦-1⟧}"#),
    good: Example::Lab(r#"{"model": "ball", "key": 0}"#),
};

pub(super) const CHECK: Check = Check::Lab(check_lab);

fn check_lab(lab: &Lab, findings: &mut Vec<Finding>) {
    if let Some(key) = lab.key.as_ref().filter(|k| !LAB.allows("key", k.value)) {
        let message = format!("`key` is {}, but keyframes are counted from 0", key.value);
        findings.push(
            Finding::new(KEYFRAME_RANGE, key.span.clone(), message)
                .help("write 0 for the first keyframe, or delete `key`"),
        );
    }
}
