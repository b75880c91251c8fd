use super::Check;
use crate::json::read::named;
use crate::spec::{Lab, Readout};
use labspec_finding::{Example, Finding, Layer, Rule, Severity};

/// Two readouts have the same expression.
pub const SAME_READOUT: &Rule = &Rule {
    code: "same-readout",
    severity: Severity::Warning,
    exceptions: &[],
    layer: Layer::Structure,
    summary: "two readouts have the same expression",
    why: "one of them is a copy whose expression was not changed. The rule skips a readout with more decimals whose label shares a word with the other",
    bad: Example::Lab(
        r#"{"model": "ball", "readouts": [{"label": "height (m)", "expr": "data.qpos[2]"}, {"label": "angle (rad)", "expr": "⟦data.qpos[2]⟧"}]}"#,
    ),
    good: Example::Lab(
        r#"{"model": "ball", "readouts": [{"label": "height (m)", "expr": "data.qpos[2]"}, {"label": "angle (rad)", "expr": "data.qpos[7]"}]}"#,
    ),
};

pub(super) const CHECK: Check = Check::Lab(check_lab);

/// Whether two labels have a common word.
fn share(a: &str, b: &str) -> bool {
    let words = |text: &str| -> Vec<String> {
        let parts = text.split(|c: char| !c.is_alphanumeric()).filter(|w| w.chars().count() > 1);
        parts.map(str::to_lowercase).collect()
    };
    let others = words(b);
    a.trim() == b.trim() || words(a).iter().any(|w| others.contains(w)) || others.is_empty()
}

fn check_lab(lab: &Lab, findings: &mut Vec<Finding>) {
    for (i, readout) in lab.readouts.iter().enumerate() {
        // More decimals of the same number may be intended; another name for it is not.
        let more =
            |r: &Readout| r.digits() != readout.digits() && share(r.label.as_str(), readout.label.as_str());
        let copy = |r: &&Readout| r.expr.value == readout.expr.value && !more(r);
        let Some(first) = lab.readouts.iter().take(i).find(copy) else { continue };
        let [a, b] = [&first.label, &readout.label].map(|l| named(l.as_str()));
        findings.push(
            Finding::new(SAME_READOUT, readout.expr.span(), format!("{b} is the same number as {a}"))
                .why("both use the same expression, so they always print the same number")
                .related(first.expr.span(), "the first one")
                .help("change the expression to what the label says, or delete the readout"),
        );
    }
}
