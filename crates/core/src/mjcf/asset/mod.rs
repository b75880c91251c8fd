//! Meshes, height fields and skins: reading, convex hulls, inertias, and writing to the model.

pub(crate) mod fill_asset;
pub(crate) mod hfield;
pub(crate) mod mesh;
#[cfg(feature = "pictures")]
mod png;
pub(crate) mod read_asset;
pub(crate) mod read_texture;
pub(crate) mod skin;
