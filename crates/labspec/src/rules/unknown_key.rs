use crate::json::read::shorten;
use crate::spec::Meant;
use labspec_finding::{Example, Finding, Layer, Rule, Severity};
use std::ops::Range;

/// An object has a key that the format does not know.
pub const UNKNOWN_KEY: &Rule = &Rule {
    code: "unknown-key",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Structure,
    summary: "an object has a key that the format does not know",
    why: "the page ignores it, so what it should do does not happen",
    bad: Example::Lab(
        r#"{"model": "ball", "readouts": [{"label": "t", "⟦exp⟧": "data.time", "expr": "data.time"}]}"#,
    ),
    good: Example::Lab(r#"{"model": "ball", "readouts": [{"label": "t", "expr": "data.time"}]}"#),
};

/// Reports an unknown key of an object.
pub(crate) fn describe_key(span: Range<usize>, object: &str, key: &str, meant: &Meant) -> Finding {
    let message = match key.trim().is_empty() {
        true => format!("a key of {object} has no name"),
        false => format!("{object} has no key `{}`", shorten(key)),
    };
    let finding = Finding::new(UNKNOWN_KEY, span.clone(), message);
    match meant {
        Meant::There(right) => {
            finding.help(format!("did you mean `{right}`? the object already has it: delete one of the two"))
        }
        Meant::Likely(right) => finding.help(format!("did you mean `{right}`?")).guess(span, *right),
        Meant::Other { key, takes } => finding.help(format!("did you mean `{key}`? it takes {takes}")),
        Meant::Unclear(keys) => finding.help(format!("use one of its keys: {}", keys.join(", "))),
    }
}
