//! What an author has looked at and wants to keep as it is.

use super::{Key, Object, Type, key};

static CODE: Type = Type::Text;

/// `lint`, on a lab, a quiz and a question. (A function: a constant may not lead back to itself.)
pub(super) const fn lint_key() -> Key {
    key(
        "lint",
        Type::Object(&LINT),
        "findings that the author has looked at and does not want to hear of again; the page does not read it",
        r#"{"allow": ["duplicate-readout"], "why": "both are read in the text"}"#,
    )
}

/// What is not told of a lab, a quiz or a question.
pub static LINT: Object = Object {
    name: "lint",
    what: "a lint object",
    doc: "Findings that are not told of the object that carries it. What is wrong (an error) is told all the same. \
          In prose the same is said by a comment before a block: `<!-- labspec allow CODE: reason -->`.",
    tag: None,
    minimal: r#"{"allow": ["duplicate-readout"], "why": "both are read in the text"}"#,
    keys: &[
        key("allow", Type::List(&CODE), "the codes of the findings", r#"["duplicate-readout"]"#)
            .must("it says which findings are meant"),
        key(
            "why",
            Type::Text,
            "the reason, for those who read the lesson later",
            r#""both are read in the text""#,
        )
        .must("whoever reads the lesson later has to know why"),
    ],
    together: &[],
};
