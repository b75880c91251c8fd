//! Elements without mass: sites, cameras, lights, materials, custom data, keyframes.

pub(crate) mod fill_scene;
pub(crate) mod read_key;
pub(crate) mod read_scene;
