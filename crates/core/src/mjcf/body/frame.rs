//! Frames: poses between a body and its members (XML reference, `frame`).

use crate::math::{IDENTITY, Quat, Vec3, add, quat_mul, quat_normalize, rotate};

/// A pose relative to a body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Pose {
    pub(crate) pos: Vec3,
    pub(crate) quat: Quat,
}

impl Pose {
    pub(crate) const NONE: Pose = Pose { pos: [0.0; 3], quat: IDENTITY };

    /// Converts a pose in this frame to one relative to the body. With the identity, all bits stay the same.
    pub(crate) fn in_parent(&self, pos: Vec3, quat: Quat) -> Pose {
        if *self == Pose::NONE {
            return Pose { pos, quat };
        }
        Pose { pos: self.point(pos), quat: quat_normalize(quat_mul(self.quat, quat)) }
    }

    /// Converts the pose of a member in place.
    pub(crate) fn transform_to_parent(&self, pos: &mut Vec3, quat: &mut Quat) {
        Pose { pos: *pos, quat: *quat } = self.in_parent(*pos, *quat);
    }

    /// Converts a point in this frame to one relative to the body.
    pub(crate) fn point(&self, pos: Vec3) -> Vec3 {
        if *self == Pose::NONE { pos } else { add(self.pos, self.direction(pos)) }
    }

    /// Converts a direction in this frame to one relative to the body.
    pub(crate) fn direction(&self, v: Vec3) -> Vec3 {
        if self.quat == IDENTITY { v } else { rotate(v, self.quat) }
    }
}
