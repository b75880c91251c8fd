//! What reading an element needs to know.

use super::classes::{Classes, Props};
use super::expand::AttachedModel;
use super::settings::Compiler;
use crate::math::Quat;
use crate::mjcf::asset::read_asset::Assets;
use crate::mjcf::body::orientation;
use crate::mjcf::text::diagnostic::Report;
use crate::mjcf::text::tree::{Node, Tree};

/// What reading an element needs to know.
pub(crate) struct Context<'a> {
    pub(crate) tree: &'a Tree,
    pub(crate) classes: &'a Classes,
    /// The models that make up the whole.
    pub(crate) parts: &'a [AttachedModel],
    pub(crate) assets: &'a Assets,
    /// What the model of the current element says: see [`Context::enter`].
    pub(crate) compiler: &'a Compiler,
    pub(crate) report: &'a mut Report,
}

impl Context<'_> {
    /// Turns to an element: its angles mean what its own model says.
    pub(crate) fn enter(&mut self, node: &Node) {
        if let Some(part) = self.parts.get(node.model) {
            self.compiler = &part.compiler;
        }
    }

    /// The orientation of an element.
    pub(crate) fn orientation(&mut self, p: &Props, node: &Node) -> Quat {
        orientation::read(p, self.compiler, node, self.report)
    }
}
