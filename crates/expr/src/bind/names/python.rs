//! Names of Python, and what they are called here.

/// What to write instead of a name.
pub(super) enum Instead {
    /// Another name, which replaces it.
    Name(&'static str),
    /// Something else, as a sentence.
    Advice(&'static str),
}

/// What to write instead of a name of Python or of its programs for MuJoCo. `has_root` says whether the host has an object.
pub(super) fn instead_of(name: &str, has_root: impl Fn(&str) -> bool) -> Option<Instead> {
    use Instead::{Advice, Name};
    Some(match name {
        "True" => Name("true"),
        "False" => Name("false"),
        "None" => Name("null"),
        "pi" => Name("Math.PI"),
        "int" => Name("Math.trunc"),
        "float" => Name("Number"),
        "m" | "mjmodel" if has_root("model") => Name("model"),
        "d" | "mjdata" if has_root("data") => Name("data"),
        "len" => Advice("write `list.length`"),
        "sum" => Advice("write `list.reduce((a, b) => a + b, 0)`"),
        "range" => Advice("count with `for (let i = 0; i < n; i++) { … }`"),
        "elif" => Advice("write `else if (…)`"),
        "pass" => Advice("write `{}` for a block without statements"),
        "not" => Advice("write `!` before the value"),
        _ => return None,
    })
}
