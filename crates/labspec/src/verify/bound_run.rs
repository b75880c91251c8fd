//! A run of a `verify` object with its compiled texts, and the lab of the run.

use super::outcome::SweepMember;
use super::run_cache::BoundLab;
use crate::bind::{DisplayedLabels, ModelNames, Scope};
use crate::source::Text;
use crate::spec::Run;
use labspec_expr::{Globals, Program, Value};
use std::borrow::Cow;

/// A program and its source text.
#[derive(Clone, Debug)]
pub(super) struct CompiledText<'a> {
    /// The text of the lesson, or that of one element of a list in it.
    pub(super) text: Cow<'a, Text>,
    pub(super) program: Program,
}

/// A lab with the measures that are evaluated in its runs.
#[derive(Debug)]
pub(super) struct BoundScene<'a> {
    pub(super) scene: BoundLab<'a>,
    pub(super) globals: Globals,
    /// By name. The elements of a list are `name[0]`, `name[1]`, ….
    pub(super) measures: Vec<(Cow<'a, str>, CompiledText<'a>)>,
    /// The values that the lab displays under labels, and the labels that are read.
    pub(super) displayed: DisplayedLabels,
}

/// A run with its compiled texts.
#[derive(Clone, Debug)]
pub(super) struct BoundRun<'a> {
    pub(super) name: &'a str,
    pub(super) spec: Option<&'a Run>,
    pub(super) setup: Option<CompiledText<'a>>,
    pub(super) stop: Option<CompiledText<'a>>,
    /// Its place in a sweep.
    pub(super) swept: Option<SweepMember>,
    /// The controls that a sweep or a search sets, with their values.
    pub(super) controls: Vec<(&'a Text, Value)>,
    /// The values need not be ones that a student can choose.
    pub(super) freely: bool,
    /// The index of its lab in the list.
    pub(super) scene: usize,
}

impl<'a> BoundRun<'a> {
    /// A run without texts, for the lab at this index.
    pub(super) fn new(name: &'a str, spec: Option<&'a Run>, scene: usize) -> BoundRun<'a> {
        BoundRun {
            name,
            spec,
            setup: None,
            stop: None,
            swept: None,
            controls: Vec::new(),
            freely: false,
            scene,
        }
    }
}

impl BoundRun<'_> {
    /// The name of the run in conditions: `fall`, `fall[2]`.
    pub(super) fn title(&self) -> String {
        match &self.swept {
            Some(member) => format!("{}[{}]", self.name, member.index),
            None => self.name.to_string(),
        }
    }
}

impl BoundScene<'_> {
    /// The names that a measure, or an expression that is compared with it, can use.
    pub(super) fn names(&self, scope: Scope) -> ModelNames<'_> {
        ModelNames::new(&self.scene.model, scope)
            .with(&self.scene.programs.functions)
            .showing(&self.displayed)
    }
}
