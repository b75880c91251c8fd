//! An element of `actuator`, which overrides the defaults of its class.

use crate::mjcf::classes::Props;
use crate::mjcf::rules;
use crate::mjcf::text::diagnostic::{Diagnostics, ReportedFinding};
use crate::mjcf::text::tree::ElementNode;

/// An element that overrides the fields of an actuator.
pub(crate) struct ActuatorOverlay<'a> {
    pub(crate) node: &'a ElementNode,
    /// Its own attributes.
    pub(crate) p: Props,
    pub(crate) report: &'a mut Diagnostics,
}

impl ActuatorOverlay<'_> {
    /// Reports an error at an attribute, or at the element if the attribute is absent.
    pub(crate) fn error(&mut self, attribute: &str, message: impl Into<String>) -> ReportedFinding<'_> {
        let span = self.p.span(attribute).unwrap_or(self.node.span.clone());
        self.report.error(rules::ACTUATOR, span, message)
    }

    /// A number that must not be negative, or `None` if it is absent.
    pub(crate) fn zero_or_more(&mut self, attribute: &str) -> Option<f64> {
        let x = self.p.real(attribute)?;
        if x < 0.0 {
            let owner = self.node.describe();
            self.error(attribute, format!("`{attribute}` of {owner} is {x}, but it must be zero or more"));
        }
        Some(x)
    }
}
