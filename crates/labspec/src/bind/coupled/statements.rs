//! Statements of the language that are written before and after a program.

use labspec_core::Model;

/// Statements that correct coupled parameters.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Repair {
    /// Before the program: they store values from before it.
    pub(crate) before: Vec<String>,
    /// After the program.
    pub(crate) after: Vec<String>,
    /// Whether constants must be recomputed after them.
    pub(crate) constants: bool,
}

/// Statements while they are written.
pub(super) struct StatementWriter<'a> {
    pub(super) model: &'a Model,
    pub(super) text: &'a str,
    pub(super) repair: Repair,
}

impl StatementWriter<'_> {
    /// A name that the program does not use.
    fn name(&self, preferred: &str) -> String {
        let part = |c: char| c.is_alphanumeric() || c == '_' || c == '$';
        let is_used = |name: &str| {
            self.text.split(|c| !part(c)).any(|word| word == name)
                || self.repair.before.iter().any(|s| s.starts_with(&format!("const {name} ")))
        };
        let numbered = (2..100).map(|n| format!("{preferred}{n}"));
        let mut names = std::iter::once(preferred.to_string()).chain(numbered);
        names.find(|name| !is_used(name)).unwrap_or_else(|| format!("{preferred}_as_it_was"))
    }

    /// Stores a value from before the program, and returns its name.
    pub(super) fn keep(&mut self, preferred: &str, value: &str) -> String {
        let name = self.name(preferred);
        self.repair.before.push(format!("const {name} = {value}"));
        name
    }

    /// Adds a statement after the program, once.
    pub(super) fn add(&mut self, statement: String) {
        if self.repair.after.contains(&statement) {
            return;
        }
        self.repair.after.push(statement);
    }
}
