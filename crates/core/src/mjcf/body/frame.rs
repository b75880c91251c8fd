//! Frames: poses that stand between a body and what it holds (XML reference, `frame`).

use crate::math::{IDENTITY, Quat, Vec3, add, quat_mul, quat_normalize, rotate};

/// A pose seen from a body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Pose {
    pub(crate) pos: Vec3,
    pub(crate) quat: Quat,
}

impl Pose {
    pub(crate) const NONE: Pose = Pose { pos: [0.0; 3], quat: IDENTITY };

    /// A pose that is given in this frame, seen from the body. What is not moved keeps its bits.
    pub(crate) fn in_parent(&self, pos: Vec3, quat: Quat) -> Pose {
        if *self == Pose::NONE {
            return Pose { pos, quat };
        }
        Pose { pos: self.point(pos), quat: quat_normalize(quat_mul(self.quat, quat)) }
    }

    /// Places what has a pose.
    pub(crate) fn place(&self, pos: &mut Vec3, quat: &mut Quat) {
        Pose { pos: *pos, quat: *quat } = self.in_parent(*pos, *quat);
    }

    /// A point in this frame, seen from the body.
    pub(crate) fn point(&self, pos: Vec3) -> Vec3 {
        if *self == Pose::NONE { pos } else { add(self.pos, self.direction(pos)) }
    }

    /// A direction in this frame, seen from the body.
    pub(crate) fn direction(&self, v: Vec3) -> Vec3 {
        if self.quat == IDENTITY { v } else { rotate(v, self.quat) }
    }
}
