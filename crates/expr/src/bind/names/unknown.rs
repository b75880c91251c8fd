//! What is said of a name that means nothing, or that cannot be used like this.

use super::{Use, Walk};
use crate::ast::Name;
use crate::closest;
use crate::parse::MAX_DIAGNOSTICS;
use crate::rules;
use crate::{Finding, Span};

/// Names of the language itself.
pub(super) const LANGUAGE: [&str; 14] = [
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

/// Names that hold functions of the language.
pub(in super::super) const NAMESPACES: [&str; 4] = ["Array", "Number", "String", "Object"];

/// Objects of a browser or of Node that a lesson does not have, and why.
const GLOBALS: &[(&[&str], &str, &str)] = &[
    (
        &[
            "window",
            "document",
            "globalThis",
            "self",
            "global",
            "localStorage",
            "sessionStorage",
            "navigator",
        ],
        "a lesson runs without a page: in a browser, on a command line, in a notebook",
        "use the names of the lab: `model`, `data`, `ctx`",
    ),
    (&["console", "alert", "prompt"], "there is nowhere to print", "show the value in a readout or a trace"),
    (
        &["fetch", "XMLHttpRequest", "WebSocket", "require", "process", "Worker"],
        "a lesson reaches nothing outside itself",
        "put the data into the lab",
    ),
    (
        &["eval", "Function"],
        "text that becomes code while running could not be checked before the run",
        "write the expression itself",
    ),
    (
        &["Date", "performance", "setTimeout", "setInterval", "requestAnimationFrame"],
        "the clock of the wall would make every run different",
        "use the time of the simulation, `data.time`",
    ),
    (
        &["Promise", "Symbol", "Reflect", "Proxy", "RegExp", "Map", "Set", "JSON", "Intl", "arguments"],
        "a lesson works on numbers of the simulation; lists and records are all it needs",
        "keep values in variables of the lab, as `ctx.peak`, in lists `[0, 1]` or in records `{a: 1}`",
    ),
];

/// Members through which JavaScript reaches the machinery behind a value.
pub(in super::super) const MACHINERY: [&str; 5] =
    ["constructor", "prototype", "__proto__", "hasOwnProperty", "valueOf"];

impl Walk<'_, '_> {
    pub(super) fn unknown(&self, name: &str, span: Span, used: Use) -> Finding {
        if name == "value" {
            return Finding::error(rules::NO_VALUE_HERE, span, "there is no `value` here")
                .why("`value` is what a slider or select gives to its own `set` or `apply`")
                .help("give the control a `param` and read it as `ctx.<param>`");
        }
        if let Some((_, why, help)) = GLOBALS.iter().find(|(names, _, _)| names.contains(&name)) {
            return Finding::error(rules::NOT_IN_LANGUAGE, span, format!("`{name}` is not in this language"))
                .why(*why)
                .help(*help);
        }
        let report = match used {
            Use::Callee => {
                Finding::error(rules::UNKNOWN_FUNCTION, span, format!("unknown function `{name}`"))
            }
            _ => Finding::error(rules::UNKNOWN_NAME, span, format!("unknown name `{name}`")),
        };
        if self.found.len() > MAX_DIAGNOSTICS {
            return report; // nobody will read it: not worth a search for what was meant
        }
        match self.meant(name, used) {
            Some(meant) => report.help(format!("did you mean `{meant}`?")).guess(span, meant),
            None => {
                let own = match used {
                    Use::Callee => {
                        "to make a function of your own, write `const f = (x) => …` before".to_owned()
                    }
                    _ => {
                        format!("to keep a number of your own, write `ctx.{name} = …` or `const {name} = …`")
                    }
                };
                let mut known = self.root_names();
                known.extend(["ctx".to_owned(), "Math".to_owned()]);
                report.why(format!("the names here are {}", list(&known))).help(own)
            }
        }
    }

    fn root_names(&self) -> Vec<String> {
        self.around.schema.map_or(Vec::new(), |schema| schema.root_names())
    }

    pub(super) fn undeclared(&self, name: &str, span: Span) -> Finding {
        let report = Finding::error(rules::UNKNOWN_NAME, span, format!("`{name}` is not declared"))
            .why("an assignment without a declaration would make a variable of the whole page");
        match self.nearest(name) {
            Some(meant) => report.help(format!("did you mean `{meant}`?")).guess(span, meant),
            None => report.help(format!(
                "write `const {name} = …` for this text only, or `ctx.{name} = …` to keep it in the lab"
            )),
        }
    }

    /// The name that is probably meant by a misspelt one on the left of `=`.
    fn nearest(&self, name: &str) -> Option<String> {
        let roots = self.root_names();
        closest(name, self.own_names().chain(roots.iter().map(String::as_str))).map(str::to_owned)
    }

    /// The names in reach that the text declares.
    pub(super) fn own_names(&self) -> impl Iterator<Item = &str> {
        self.reach.iter().filter_map(|byte| Some(self.names.declared.get(byte)?.name.as_str()))
    }
}

/// The finding for a second declaration, or one of a name that means something already.
pub(super) fn taken(name: &Name, here: bool) -> Finding {
    let why = if here { "it is declared above" } else { "it already means something in every text of a lab" };
    Finding::error(rules::NAME_TAKEN, name.span, format!("`{}` cannot be declared here", name.text))
        .why(format!("{why}; JavaScript refuses a second declaration"))
        .help(if here {
            "assign it without `const` or `let`, or choose another name"
        } else {
            "choose another name"
        })
}

/// The finding for a use before the declaration.
pub(super) fn too_early(name: &str, span: Span) -> Finding {
    Finding::error(rules::USED_TOO_EARLY, span, format!("`{name}` is used before its declaration"))
        .why("statements run from top to bottom: here the name has no value yet")
        .help(format!("move the declaration of `{name}` up"))
}

/// The finding for a `const` that is assigned.
pub(super) fn constant(name: &str, span: Span) -> Finding {
    Finding::error(rules::ASSIGN_CONST, span, format!("`{name}` is declared with `const`"))
        .why("a `const` name keeps its first value; JavaScript stops the program here")
        .help(format!("declare it with `let {name}`, or use another name"))
}

/// The finding for a name of the language that is assigned.
pub(super) fn not_assignable(name: &str, span: Span) -> Finding {
    let report = Finding::error(rules::NOT_ASSIGNABLE, span, format!("`{name}` cannot be assigned"));
    match name {
        "ctx" => report.why("it holds the variables of the lab").help("assign a variable, as `ctx.peak = 0`"),
        "value" => {
            report.why("it is what the control gives").help("use another name, as `const x = value / 2`")
        }
        _ => report.why("it means the same everywhere").help("use another name"),
    }
}

/// Whether the language itself gives a meaning to a name.
pub(in super::super) fn is_language(name: &str) -> bool {
    LANGUAGE.contains(&name) || name == "value"
}

/// A list of names for a message, cut when it is long.
pub(in super::super) fn list(names: &[String]) -> String {
    const SHOWN: usize = 8;
    let shown: Vec<String> = names.iter().take(SHOWN).map(|n| format!("`{n}`")).collect();
    let more = names.len().saturating_sub(SHOWN);
    if more > 0 { format!("{} and {more} more", shown.join(", ")) } else { shown.join(", ") }
}
