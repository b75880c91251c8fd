//! `include`, `extension` and the configuration of plugins.

use super::{Element, TEXT, attributes};

pub(crate) static INCLUDE: Element = Element::new("include", &[attributes! { TEXT => file; }]);

pub(super) static EXTENSION: Element =
    Element::new("extension", &[]).children(&[&EXTENSION_PLUGIN]).refused();
static EXTENSION_PLUGIN: Element =
    Element::new("plugin", &[attributes! { TEXT => plugin; }]).children(&[&INSTANCE]);
static INSTANCE: Element = Element::new("instance", &[attributes! { TEXT => name; }]).children(&[&CONFIG]);
pub(super) static CONFIG: Element = Element::new("config", &[attributes! { TEXT => key value; }]);
pub(super) static PLUGIN: Element =
    Element::new("plugin", &[attributes! { TEXT => plugin instance; }]).children(&[&CONFIG]).refused();
