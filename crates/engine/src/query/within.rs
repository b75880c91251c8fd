//! Points inside the volumes of sites.

use crate::geometry::{Shape, inside_shape};
use crate::math::Vec3;
use crate::model::{Fields, Model};

/// Whether a point (world frame, m) is inside the volume of a site (`mj_insideSite`).
pub fn inside_site(m: &Model, d: &Fields, site: usize, point: Vec3) -> bool {
    inside_shape(&Shape::site(m, d, site), point)
}
