//! The sources of models for labs: a folder, a map in memory, or a function.

use labspec_core::xml::{FileProblem, Files};
use std::collections::BTreeMap;

/// Models by the names that labs use: without folder and extension.
///
/// There are three kinds: maps and lists in memory, closures `Fn(&str) -> Option<String>`, and, for a folder,
/// [`ModelFolder`](crate::lint::ModelFolder), which can replace all of them.
pub trait Models: Send + Sync {
    /// The MJCF of a model; `None` when there is no model of this name.
    fn text(&self, name: &str) -> Option<String>;

    /// The bytes of a compiled model ([`labspec_core::Model::to_bytes`]), which a [`Player`](crate::Player) uses instead of the
    /// text; `None` when there is only a text, or no model of this name. A [`Checker`](crate::Checker) needs the text.
    fn compiled(&self, name: &str) -> Option<Vec<u8>> {
        let _ = name;
        None
    }

    /// The names of all models, if they are known: then a misspelt name gets a suggestion.
    fn names(&self) -> Option<Vec<String>> {
        None
    }

    /// A file that a model names: included text, a mesh, an image. `path` is relative to the location of the models. By
    /// default, models may include only each other, as `NAME.xml`.
    ///
    /// # Errors
    /// The reason why there are no bytes; more than `limit` bytes are refused.
    fn file(&self, path: &str, limit: usize) -> Result<Vec<u8>, FileProblem> {
        let text = path.strip_suffix(".xml").and_then(|name| self.text(name)).ok_or(FileProblem::Missing)?;
        if text.len() > limit { Err(FileProblem::TooLarge) } else { Ok(text.into_bytes()) }
    }
}

/// No models: for labs with an inline model, `xml`.
#[derive(Clone, Copy, Debug)]
pub struct NoModels;

impl Models for NoModels {
    fn text(&self, _: &str) -> Option<String> {
        None
    }

    fn names(&self) -> Option<Vec<String>> {
        Some(Vec::new())
    }
}

/// Models in memory, by name.
impl Models for BTreeMap<String, String> {
    fn text(&self, name: &str) -> Option<String> {
        self.get(name).cloned()
    }

    fn names(&self) -> Option<Vec<String>> {
        Some(self.keys().cloned().collect())
    }
}

/// A few models: pairs of name and MJCF.
impl<const N: usize> Models for [(&str, &str); N] {
    fn text(&self, name: &str) -> Option<String> {
        self.iter().find(|(listed, _)| *listed == name).map(|(_, text)| (*text).to_string())
    }

    fn names(&self) -> Option<Vec<String>> {
        Some(self.iter().map(|(name, _)| (*name).to_string()).collect())
    }
}

impl<F: Fn(&str) -> Option<String> + Send + Sync> Models for F {
    fn text(&self, name: &str) -> Option<String> {
        self(name)
    }
}

/// The files of models, for the model compiler.
pub(crate) struct FilesOf<'m>(pub(crate) &'m dyn Models);

impl Files for FilesOf<'_> {
    fn read(&self, path: &str, limit: usize) -> Result<Vec<u8>, FileProblem> {
        self.0.file(path, limit)
    }
}
