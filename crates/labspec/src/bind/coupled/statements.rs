//! Statements of the language that are written before and behind a program.

use labspec_core::Model;

/// Statements that correct what a program leaves behind.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Repair {
    /// Before the program: what has to be known from before it.
    pub(crate) before: Vec<String>,
    /// Behind it.
    pub(crate) after: Vec<String>,
    /// Constants have to be computed anew behind them.
    pub(crate) constants: bool,
}

/// Statements on their way.
pub(super) struct Statements<'a> {
    pub(super) model: &'a Model,
    pub(super) text: &'a str,
    pub(super) repair: Repair,
}

impl Statements<'_> {
    /// A name that the program does not have.
    fn name(&self, wanted: &str) -> String {
        let part = |c: char| c.is_alphanumeric() || c == '_' || c == '$';
        let is_used = |name: &str| {
            self.text.split(|c| !part(c)).any(|word| word == name)
                || self.repair.before.iter().any(|s| s.starts_with(&format!("const {name} ")))
        };
        let numbered = (2..100).map(|n| format!("{wanted}{n}"));
        let mut names = std::iter::once(wanted.to_string()).chain(numbered);
        names.find(|name| !is_used(name)).unwrap_or_else(|| format!("{wanted}_as_it_was"))
    }

    /// Keeps a value from before the program, and gives its name.
    pub(super) fn keep(&mut self, wanted: &str, value: &str) -> String {
        let name = self.name(wanted);
        self.repair.before.push(format!("const {name} = {value}"));
        name
    }

    /// Adds a statement behind the program, once.
    pub(super) fn add(&mut self, statement: String) {
        if self.repair.after.contains(&statement) {
            return;
        }
        self.repair.after.push(statement);
    }
}
