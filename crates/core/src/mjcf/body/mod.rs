//! Bodies and joints: reading, inertias, orientations, and the sleep policy of their trees.

pub(crate) mod frame;
pub(crate) mod inertia;
pub(crate) mod limits;
pub(crate) mod orientation;
pub(crate) mod read_body;
pub(crate) mod read_joint;
pub(crate) mod sleep_policy;
