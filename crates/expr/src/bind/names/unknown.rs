//! Messages about names that are unknown or cannot be used in this way.

use super::language::list_names;
use super::python::{self, Instead};
use super::walk::{NameUse, NameWalk};
use crate::bind::source::TextKind;
use crate::host_terms::HostTerms;
use crate::parse::MAX_DIAGNOSTICS;
use crate::rules;
use labspec_finding::{Finding, Span, nearest};

/// Names of a browser or of Node.
const PAGE_NAMES: [&str; 8] =
    ["window", "document", "globalThis", "self", "global", "localStorage", "sessionStorage", "navigator"];
/// Usual names of libraries of Python.
const PYTHON_NAMES: [&str; 6] = ["np", "numpy", "jnp", "torch", "scipy", "plt"];
const PRINT_NAMES: [&str; 4] = ["console", "alert", "prompt", "print"];
const NETWORK_NAMES: [&str; 6] = ["fetch", "XMLHttpRequest", "WebSocket", "require", "process", "Worker"];
const CODE_NAMES: [&str; 2] = ["eval", "Function"];
const CLOCK_NAMES: [&str; 5] = ["Date", "performance", "setTimeout", "setInterval", "requestAnimationFrame"];
const OTHER_GLOBALS: [&str; 10] =
    ["Promise", "Symbol", "Reflect", "Proxy", "RegExp", "Map", "Set", "JSON", "Intl", "arguments"];

/// Why the language does not have such a name, and what to use instead.
fn explain_absent(name: &str, host_terms: &HostTerms) -> Option<(String, String)> {
    let HostTerms { lab, lesson, .. } = host_terms;
    let (why, help) = match name {
        _ if PAGE_NAMES.contains(&name) => (
            format!("a {lesson} must run without a page: in a browser, on a command line, in a notebook"),
            format!("use a name of the {lab}: {}", host_terms.names),
        ),
        _ if PYTHON_NAMES.contains(&name) => (
            "it is a library of Python".into(),
            "use `Math`, as `Math.sqrt(x)`, and lists, as `[1, 2].map(x => 2 * x)`".into(),
        ),
        _ if PRINT_NAMES.contains(&name) => {
            ("there is no console".into(), format!("show the value in {}", host_terms.display))
        }
        _ if NETWORK_NAMES.contains(&name) => (
            format!("a {lesson} cannot access anything outside itself"),
            format!("put the data into the {lab}"),
        ),
        _ if CODE_NAMES.contains(&name) => (
            "code that is generated at run time cannot be checked before the run".into(),
            "write the expression itself".into(),
        ),
        _ if CLOCK_NAMES.contains(&name) => {
            ("the wall clock would make every run different".into(), host_terms.clock.into())
        }
        _ if OTHER_GLOBALS.contains(&name) => (
            format!("a {lesson} works on numbers, and needs only lists and records"),
            format!(
                "store values in variables of the {lab}, as `ctx.peak`, in lists `[0, 1]` or in records `{{a: 1}}`"
            ),
        ),
        _ => return None,
    };
    Some((why, help))
}

impl NameWalk<'_, '_> {
    pub(super) fn unknown(&self, name: &str, span: Span, used: NameUse) -> Finding {
        let host_terms = self.host_terms();
        if name == "value" {
            return Finding::error(rules::NO_VALUE_HERE, span, "`value` is not defined here")
                .why(host_terms.input.0)
                .help(host_terms.input.1);
        }
        if let Some((why, help)) = explain_absent(name, host_terms) {
            return Finding::error(rules::NOT_IN_LANGUAGE, span, format!("`{name}` is not in this language"))
                .why(why)
                .help(help);
        }
        let report = match used {
            NameUse::Callee => {
                Finding::error(rules::UNKNOWN_FUNCTION, span, format!("unknown function `{name}`"))
            }
            _ => Finding::error(rules::UNKNOWN_NAME, span, format!("unknown name `{name}`")),
        };
        if self.found.len() > MAX_DIAGNOSTICS {
            return report; // the message is not displayed, so the search for a suggestion is skipped
        }
        let roots = self.root_names();
        match python::instead_of(name, |root| roots.iter().any(|other| other == root)) {
            Some(Instead::Name(meant)) => {
                return report.help(format!("did you mean `{meant}`?")).guess(span, meant);
            }
            Some(Instead::Advice(help)) => {
                return report.why(format!("`{name}` is a word of Python")).help(help);
            }
            None => {}
        }
        match self.meant(name, used) {
            Some(meant) => report.help(format!("did you mean `{meant}`?")).guess(span, meant),
            None => {
                let help = match used {
                    NameUse::Callee => {
                        "to define your own function, write `const f = (x) => …` first".to_owned()
                    }
                    _ if self.around.mode == TextKind::Statements => {
                        format!(
                            "to define your own number, write `ctx.{name} = …` or `const {name} = …` before it"
                        )
                    }
                    _ => format!(
                        "to define your own number, {}",
                        host_terms.own_number.replace("{name}", name)
                    ),
                };
                let mut names = self.root_names();
                names.extend(["ctx".to_owned(), "Math".to_owned()]);
                report.why(format!("the names here are {}", list_names(&names))).help(help)
            }
        }
    }

    /// The terms of the host.
    fn host_terms(&self) -> &'static HostTerms {
        self.around.schema.map_or(&HostTerms::PLAIN, |schema| schema.host_terms())
    }

    fn root_names(&self) -> Vec<String> {
        self.around.schema.map_or(Vec::new(), |schema| schema.root_names())
    }

    pub(super) fn undeclared(&self, name: &str, span: Span) -> Finding {
        let report = Finding::error(rules::UNKNOWN_NAME, span, format!("`{name}` is not declared"))
            .why("an assignment without a declaration would create a global variable");
        match self.nearest(name) {
            Some(meant) => report.help(format!("did you mean `{meant}`?")).guess(span, meant),
            None => report.help(format!(
                "write `let {name} = …` for this text only, or `ctx.{name} = …` to keep it in the {}",
                self.host_terms().lab
            )),
        }
    }

    /// A suggestion for a misspelt name on the left of `=`.
    fn nearest(&self, name: &str) -> Option<String> {
        let roots = self.root_names();
        nearest(name, self.text_names().chain(roots.iter().map(String::as_str))).map(str::to_owned)
    }

    /// The names in scope that the text declares.
    pub(super) fn text_names(&self) -> impl Iterator<Item = &str> {
        self.reach.iter().filter_map(|byte| Some(self.names.declared.get(byte)?.name.as_str()))
    }
}
