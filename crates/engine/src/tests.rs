//! Models for tests: MJCF is read by `labspec-core`, which is built with this crate, but not with its tests. Models pass as bytes.

use crate::model::Model;

/// A model from its text, or what `labspec-core` says of it.
pub(crate) fn compile(xml: &str) -> Result<Model, String> {
    let model = labspec_core::Model::from_xml(xml).map_err(|e| e.to_string())?;
    crate::step::store::read(&model.to_bytes()).ok_or_else(|| "the model was not read back".into())
}
