//! The inputs for reading an element.

use super::classes::{Classes, Props};
use super::expand::AttachedModel;
use super::settings::CompilerSettings;
use crate::math::Quat;
use crate::mjcf::asset::read_asset::Assets;
use crate::mjcf::body::orientation;
use crate::mjcf::text::diagnostic::Diagnostics;
use crate::mjcf::text::tree::{ElementNode, ElementTree};

/// The inputs for reading an element.
pub(crate) struct Context<'a> {
    pub(crate) tree: &'a ElementTree,
    pub(crate) classes: &'a Classes,
    /// The models that form the whole.
    pub(crate) parts: &'a [AttachedModel],
    pub(crate) assets: &'a Assets,
    /// The compiler settings of the model that contains the current element: see [`Context::enter`].
    pub(crate) compiler: &'a CompilerSettings,
    pub(crate) report: &'a mut Diagnostics,
}

impl Context<'_> {
    /// Selects the compiler settings of the model that contains an element. They determine the unit of its angles.
    pub(crate) fn enter(&mut self, node: &ElementNode) {
        if let Some(part) = self.parts.get(node.model) {
            self.compiler = &part.compiler;
        }
    }

    /// The orientation of an element.
    pub(crate) fn orientation(&mut self, p: &Props, node: &ElementNode) -> Quat {
        orientation::read(p, self.compiler, node, self.report)
    }
}
