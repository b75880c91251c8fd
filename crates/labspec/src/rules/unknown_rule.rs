use labspec_finding::nearest;
use labspec_finding::{Example, Finding, Layer, Rule, Severity};
use std::ops::Range;

/// `allow` names an unknown rule.
pub const UNKNOWN_RULE: &Rule = &Rule {
    code: "unknown-rule",
    severity: Severity::Warning,
    exceptions: &[],
    layer: Layer::Structure,
    summary: "`allow` names an unknown rule",
    why: "it suppresses nothing: the intended finding is still reported",
    bad: Example::Lab(
        r#"{"model": "ball", "readouts": [{"label": "z", "expr": "data.qpos[2]"}], "lint": {"allow": ["⟦duplicate-readouts⟧"], "why": "both are read"}}"#,
    ),
    good: Example::Lab(r#"{"model": "ball", "readouts": [{"label": "z", "expr": "data.qpos[2]"}]}"#),
};

/// Reports a suppression of an unknown code, and names the nearest one.
pub(crate) fn name_nearest(
    code: &str,
    span: Range<usize>,
    rules: impl Iterator<Item = &'static Rule>,
) -> Finding {
    let found = Finding::new(UNKNOWN_RULE, span, format!("`allow` names the unknown rule `{code}`"));
    match nearest(code, rules.map(|r| r.code)) {
        Some(near) => found.help(format!("did you mean `{near}`?")),
        None => found.help("run `labspec explain` for a list of all rules"),
    }
}
