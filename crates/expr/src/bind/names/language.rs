//! The names of the language itself, and the findings about names that are used against their meaning.

use crate::ast::Name;
use crate::rules;
use labspec_finding::{Finding, Span};

/// Names of the language itself.
pub(super) const LANGUAGE_NAMES: [&str; 14] = [
    "Math",
    "NaN",
    "Infinity",
    "undefined",
    "isNaN",
    "isFinite",
    "ctx",
    "Array",
    "Number",
    "String",
    "Boolean",
    "Object",
    "parseFloat",
    "parseInt",
];

/// Names that contain functions of the language.
pub(in crate::bind) const NAMESPACES: [&str; 4] = ["Array", "Number", "String", "Object"];

/// Members through which JavaScript exposes the internals of a value.
pub(in crate::bind) const INTERNAL_MEMBERS: [&str; 5] =
    ["constructor", "prototype", "__proto__", "hasOwnProperty", "valueOf"];

/// The finding for a second declaration, or for a declaration of a name that already has a meaning.
pub(super) fn report_redeclared(name: &Name, here: bool) -> Finding {
    let why = if here { "it is declared above" } else { "it already has a meaning in every text" };
    Finding::error(rules::NAME_TAKEN, name.span, format!("`{}` cannot be declared here", name.text))
        .why(format!("{why}; JavaScript rejects a second declaration"))
        .help(if here {
            "assign it without `const` or `let`, or choose another name"
        } else {
            "choose another name"
        })
}

/// The finding for a use before the declaration.
pub(super) fn report_too_early(name: &str, span: Span) -> Finding {
    Finding::error(rules::USED_TOO_EARLY, span, format!("`{name}` is used before its declaration"))
        .why("statements run from top to bottom: here the name has no value yet")
        .help(format!("move the declaration of `{name}` up"))
}

/// The finding for an assignment to a `const`.
pub(super) fn report_constant(name: &str, span: Span) -> Finding {
    Finding::error(rules::ASSIGN_CONST, span, format!("`{name}` is declared with `const`"))
        .why("a `const` name keeps its first value; JavaScript stops the program here")
        .help(format!("declare it with `let {name}`, or use another name"))
}

/// The finding for an assignment to a name of the language.
pub(super) fn report_not_assignable(name: &str, span: Span) -> Finding {
    let report = Finding::error(rules::NOT_ASSIGNABLE, span, format!("`{name}` cannot be assigned"));
    match name {
        "ctx" => report.why("it holds the global variables").help("assign a variable, as `ctx.peak = 0`"),
        "value" => report.why("it is set from outside").help("use another name, as `const x = value / 2`"),
        _ => report.why("it has the same meaning everywhere").help("use another name"),
    }
}

/// Whether the language itself defines a name.
pub(in crate::bind) fn is_language(name: &str) -> bool {
    LANGUAGE_NAMES.contains(&name) || name == "value"
}

/// A list of names for a message, truncated if it is long.
pub(in crate::bind) fn list_names(names: &[String]) -> String {
    const MAX_LISTED: usize = 8;
    let listed: Vec<String> = names.iter().take(MAX_LISTED).map(|n| format!("`{n}`")).collect();
    let more = names.len().saturating_sub(MAX_LISTED);
    if more > 0 { format!("{} and {more} more", listed.join(", ")) } else { listed.join(", ") }
}
