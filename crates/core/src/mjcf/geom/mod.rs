//! Geoms: shapes, meshes and the shapes that replace them, reading.

pub(crate) mod read_form;
pub(crate) mod read_geom;
pub(crate) mod reshape;
pub(crate) mod shapes;
