//! The suppression of findings that the author has reviewed.

use super::{Key, Object, Type, key};
use labspec_finding::docs;

static CODE: Type = Type::Text;

/// `lint`, for a lab, a quiz and a question. (It is a function because a constant must not refer to itself.)
pub(super) const fn lint_key() -> Key {
    key(
        "lint",
        Type::Object(&LINT),
        "findings that the author has reviewed and suppresses; the page does not read it",
        r#"{"allow": ["duplicate-readout"], "why": "both are read in the text"}"#,
    )
}

/// The findings that are suppressed for a lab, a quiz or a question.
pub static LINT: Object = Object {
    name: "lint",
    what: "a lint object",
    doc: docs(
        "Findings to suppress for the object that carries it. Errors cannot be suppressed. In prose, a comment before a block does the same: `<!-- labspec allow CODE: reason -->`.",
    ),
    tag: None,
    minimal: r#"{"allow": ["duplicate-readout"], "why": "both are read in the text"}"#,
    keys: &[
        key("allow", Type::List(&CODE), "the codes of the findings", r#"["duplicate-readout"]"#)
            .must("it names the suppressed findings"),
        key(
            "why",
            Type::Text,
            "the reason, for later readers of the lesson",
            r#""both are read in the text""#,
        )
        .must("a later reader of the lesson needs the reason"),
    ],
    key_rules: &[],
};
