//! Geoms: shapes, what meshes are fitted to, reading.

pub(crate) mod read_form;
pub(crate) mod read_geom;
pub(crate) mod reshape;
pub(crate) mod shapes;
