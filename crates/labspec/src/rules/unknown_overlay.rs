use super::Check;
use crate::json::{nearest, read::named};
use crate::spec::Lab;
use crate::spec::format::{OVERLAYS, texts};
use labspec_finding::{Example, Finding, Layer, Rule, Severity};

/// `overlays` or `toggles` names something that the page cannot draw.
pub const UNKNOWN_OVERLAY: &Rule = &Rule {
    code: "unknown-overlay",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Structure,
    summary: "`overlays` or `toggles` names something that the page cannot draw",
    why: "the page draws nothing, or the checkbox does nothing",
    bad: Example::Lab(r#"{"model": "ball", "toggles": ["⟦contact⟧"]}"#),
    good: Example::Lab(r#"{"model": "ball", "toggles": ["contacts"]}"#),
};

pub(super) const CHECK: Check = Check::Lab(check_lab);

fn check_lab(lab: &Lab, findings: &mut Vec<Finding>) {
    let written = lab.toggles.iter().chain(lab.overlays.iter().map(|(name, _)| name));
    for name in written.filter(|name| texts(&OVERLAYS).all(|overlay| overlay != name.as_str())) {
        let found =
            Finding::new(UNKNOWN_OVERLAY, name.span(), format!("{} is not an overlay", named(name.as_str())));
        findings.push(match nearest(name.as_str(), texts(&OVERLAYS)) {
            Some(right) => found.help(format!("did you mean `{right}`?")).guess(name.span(), right),
            None => found.help(format!("use one of: {}", texts(&OVERLAYS).collect::<Vec<_>>().join(", "))),
        });
    }
}
