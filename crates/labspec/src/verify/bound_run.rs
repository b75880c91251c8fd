//! A run of a `verify` object with its own texts compiled, and the lab that it is of.

use super::run_cache::BoundLab;
use crate::bind::{DisplayedLabels, ModelNames, Scope};
use crate::source::Text;
use crate::spec::Run;
use labspec_expr::{Globals, Program};

/// A program with the text that it came from.
#[derive(Debug)]
pub(super) struct CompiledText<'a> {
    pub(super) text: &'a Text,
    pub(super) program: Program,
}

/// A lab with the measures that are taken in its runs.
#[derive(Debug)]
pub(super) struct BoundScene<'a> {
    pub(super) scene: BoundLab<'a>,
    pub(super) globals: Globals,
    pub(super) measures: Vec<(&'a str, CompiledText<'a>)>,
    /// What it shows under labels, and which of them are asked for.
    pub(super) displayed: DisplayedLabels,
}

/// A run with its own texts compiled.
#[derive(Debug)]
pub(super) struct BoundRun<'a> {
    pub(super) name: &'a str,
    pub(super) spec: Option<&'a Run>,
    pub(super) setup: Option<CompiledText<'a>>,
    pub(super) stop: Option<CompiledText<'a>>,
    /// Its place in a sweep, and its value there; with the control that is set to it, where it is no attribute of the model.
    pub(super) swept: Option<(usize, f64)>,
    pub(super) control: Option<(&'a Text, f64)>,
    /// No student need be able to choose this value.
    pub(super) freely: bool,
    /// The place of its lab in the list.
    pub(super) scene: usize,
}

impl<'a> BoundRun<'a> {
    /// A run without texts of its own, of the lab at this place.
    pub(super) fn new(name: &'a str, spec: Option<&'a Run>, scene: usize) -> BoundRun<'a> {
        BoundRun { name, spec, setup: None, stop: None, swept: None, control: None, freely: false, scene }
    }
}

impl BoundRun<'_> {
    /// How conditions call it: `fall`, `fall[2]`.
    pub(super) fn title(&self) -> String {
        match self.swept {
            Some((i, _)) => format!("{}[{i}]", self.name),
            None => self.name.to_string(),
        }
    }
}

impl BoundScene<'_> {
    /// The names of a measure, or of what it is compared with.
    pub(super) fn names(&self, scope: Scope) -> ModelNames<'_> {
        ModelNames::new(&self.scene.model, scope)
            .with(&self.scene.programs.functions)
            .showing(&self.displayed)
    }
}
