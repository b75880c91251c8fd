//! What the text of a model is read with: the files that it names, and patches that are applied before it is compiled.

pub(crate) mod files;
pub(crate) mod model_patch;
